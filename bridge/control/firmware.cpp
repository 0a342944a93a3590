#include "bridge/control/firmware.hpp"

#include <bit>
#include <cmath>
#include <optional>

#include "transports/image/dynamic_data_types.hpp"

namespace meca::control {
namespace {

using image::Layout;
using image::layout_of;
using transports::FirmwareVersion;

constexpr Time kGiveUpAfter = std::chrono::seconds(2);  // not published: a robot that has not told by then will not

std::optional<std::uint16_t> whole16(float value) noexcept {
  if (!(value >= 0.0f && value <= 65535.0f) || value != std::trunc(value)) return std::nullopt;
  return static_cast<std::uint16_t>(value);
}

FirmwareVersion version_from(const image::DynamicData& data) noexcept {
  const auto major = whole16(data.values[0]), minor = whole16(data.values[1]);
  const auto patch = whole16(data.values[2]), build = whole16(data.values[3]);
  if (!major || !minor || !patch || !build) return {};
  return {*major, *minor, *patch, *build};
}

// Type 3: value 0 is the serial as a float (24 bits are exact), value 1 its bit pattern (spec 2.2).
std::uint32_t serial_from(const image::DynamicData& data) noexcept {
  const auto bits = std::bit_cast<std::uint32_t>(data.values[1]);
  if (bits != 0) return bits;
  return data.values[0] >= 1.0f && data.values[0] < 4294967040.0f ? static_cast<std::uint32_t>(data.values[0]) : 0;
}

}  // namespace

FirmwareProbe::FirmwareProbe(FirmwareVersion expected) noexcept
    : expected_(expected), layout_(layout_of(expected.major).value_or(Layout::kFirmware11)) {}

void FirmwareProbe::restart(Time now) noexcept {
  *this = FirmwareProbe(expected_);
  started_ = now;
}

void FirmwareProbe::learn(FirmwareVersion version, bool from_robot) noexcept {
  if (version.major == 0 || (version_known_ && !from_robot)) return;
  const auto layout = layout_of(version.major);
  if (!layout && !from_robot) return;  // 9.x identifies itself as 2.1 on EtherNet/IP: ask the robot instead
  version_ = version;
  version_known_ = version_known_ || from_robot;
  layout_known_ = layout.has_value();
  if (layout) layout_ = *layout;
  mismatch_ = !layout || (expected_.major != 0 && layout_of(expected_.major) != layout);
}

void FirmwareProbe::observe(const View& view, FirmwareVersion identity) noexcept {
  learn(identity, false);
  gave_up_ = view.now - started_ > kGiveUpAfter;
  if (!view.fresh) return;
  for (const image::DynamicData& data : view.in.dynamic_data) {
    if (data.type_id == image::kDynFirmwareVersion) learn(version_from(data), true);
    if (data.type_id == image::kDynProductType) product_type_ = whole16(data.values[0]).value_or(0);
    if (data.type_id == image::kDynSerialNumber) serial_number_ = serial_from(data);
  }
}

std::array<std::uint32_t, image::kDynamicSlots> FirmwareProbe::slots(
    const std::array<std::uint32_t, image::kDynamicSlots>& wanted) const noexcept {
  auto slots = wanted;
  if (!layout_known_ || (!version_known_ && !gave_up_)) slots[0] = image::kDynFirmwareVersion;
  if (product_type_ == 0 && !gave_up_) slots[1] = image::kDynProductType;
  if (serial_number_ == 0 && !gave_up_) slots[2] = image::kDynSerialNumber;
  return slots;
}

}  // namespace meca::control
