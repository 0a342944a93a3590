// Table 12 of the robot manual as data: what the six values of a dynamic data slot mean, by type id.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "transports/image/image.hpp"

namespace meca::image {

struct ValueInfo {
  std::string_view name;     // "joint 1", "x", "major version"
  std::string_view unit;     // "deg", "mm", "%", ...; empty where it has none
  bool bit_pattern = false;  // the REAL slot holds the bits of a uint32 (type 3, value 1)
};

struct DynamicDataInfo {
  std::uint32_t id;
  std::string_view name;              // "joint position (actual)"
  std::span<const ValueInfo> values;  // the meaningful ones, at most six
  bool on_meca500;                    // false: defined for other robots only
};

std::span<const DynamicDataInfo> dynamic_data_types() noexcept;

// nullptr for types that no document names. 10000..19999 all give the entry "variable". Some types changed their value
// order between firmware generations (14 and 15), hence the layout.
const DynamicDataInfo* find_dynamic_data_type(std::uint32_t id, Layout layout = Layout::kFirmware11) noexcept;

// The value as a number people mean: bit patterns become integers.
double dynamic_value(const ValueInfo& info, float raw) noexcept;

inline constexpr std::uint32_t kDynAutomatic = 0, kDynFirmwareVersion = 1, kDynProductType = 2, kDynSerialNumber = 3;

}  // namespace meca::image
