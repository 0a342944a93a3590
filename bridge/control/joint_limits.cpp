#include "bridge/control/joint_limits.hpp"

#include <cmath>

#include "transports/image/motion_commands.hpp"

namespace meca::control {
namespace {

constexpr std::uint32_t kLimitsEnabled = 11, kModel123 = 12, kModel456 = 13, kEffective123 = 14, kEffective456 = 15,
                        kConfigured123 = 61, kConfigured456 = 62;

constexpr double kWidest = 36000;  // joint 6: 100 turns either way

// Dynamic data follows 1-2 cycles after the request (spec 5.7). A robot that has not told by then will not: no harm
// done, the model's limits hold.
constexpr int kPatience = 30;

bool plausible(JointLimits::Range r) noexcept {
  return std::isfinite(r.minimum) && std::isfinite(r.maximum) && r.minimum < r.maximum && r.minimum >= -kWidest &&
         r.maximum <= kWidest;
}

}  // namespace

void JointLimits::read(const image::DynamicData& data, std::size_t first, bool interleaved, Table& table) noexcept {
  std::array<Range, 3> ranges{};
  for (std::size_t i = 0; i < 3; ++i) {
    ranges[i] = {data.values[interleaved ? 2 * i : i], data.values[interleaved ? 2 * i + 1 : i + 3]};
    if (!plausible(ranges[i])) return;  // one that cannot be makes the others doubtful
  }
  for (std::size_t i = 0; i < 3; ++i) table[first + i] = {true, ranges[i]};
}

void JointLimits::observe(const View& view) noexcept {
  if (!view.fresh) return;
  recovery_mode_ = view.in.robot_status.recovery_mode;
  if (view.in.robot_status.activated && !activated_) effective_ = configured_ = {};
  activated_ = view.in.robot_status.activated;
  // Firmware 9 gives the effective limits as min, max of one joint after the other (spec 2.2).
  const bool interleaved = view.layout == image::Layout::kFirmware9;
  for (const image::DynamicData& data : view.in.dynamic_data) {
    switch (data.type_id) {
      case kLimitsEnabled:
        configured_enabled_ = data.values[0] == 1.0f;
        break;
      case kModel123:
      case kModel456:
        read(data, data.type_id == kModel123 ? 0 : 3, false, model_);
        break;
      case kEffective123:
      case kEffective456:
        read(data, data.type_id == kEffective123 ? 0 : 3, interleaved, effective_);
        break;
      case kConfigured123:
      case kConfigured456:
        read(data, data.type_id == kConfigured123 ? 0 : 3, false, configured_);
        break;
    }
  }
}

JointLimits::Range JointLimits::model(std::size_t joint) const noexcept {
  if (model_[joint].known) return model_[joint].range;
  const image::Argument& argument = image::find_motion_command(image::kMoveJoints)->arguments[joint];
  return {argument.minimum, argument.maximum};
}

JointLimits::Range JointLimits::range(std::size_t joint) const noexcept {
  if (recovery_mode_) return model(joint);
  if (effective_[joint].known) return effective_[joint].range;
  if (configured_enabled_ && configured_[joint].known) return configured_[joint].range;
  return model(joint);
}

void LimitsProbe::observe(const View& view, bool may_ask) noexcept {
  if (!may_ask) {
    *this = LimitsProbe{};
    return;
  }
  if (!view.fresh) return;
  const bool activated = view.in.robot_status.activated;
  if (!connected_ || (activated && !activated_)) {
    asking_ = kEffective123;
    images_ = 0;
  } else if (asking_ != 0) {
    bool shown = ++images_ > kPatience;
    for (const image::DynamicData& data : view.in.dynamic_data) shown |= data.type_id == asking_;
    if (shown) {
      asking_ = asking_ == kEffective123 ? kEffective456 : 0;
      images_ = 0;
    }
  }
  connected_ = true;
  activated_ = activated;
}

std::array<std::uint32_t, image::kDynamicSlots> LimitsProbe::slots(
    std::array<std::uint32_t, image::kDynamicSlots> wanted) const noexcept {
  if (asking_ == 0) return wanted;
  std::size_t slot = wanted.size();
  while (slot > 0 && wanted[slot - 1] != 0) --slot;
  wanted[slot > 0 ? slot - 1 : wanted.size() - 1] = asking_;
  return wanted;
}

}  // namespace meca::control
