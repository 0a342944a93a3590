// An image as rows for people and JSON: every field its layout has, named and with its unit, in the order of the bytes.
// Not for the cycle thread: it allocates.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "transports/image/codec.hpp"
#include "transports/image/image.hpp"

namespace meca::image {

struct FieldText {
  std::string_view section;  // the manual's: "RobotStatus", "DynamicData 0"; all views are into static text
  std::string_view name;     // the manual's; of arguments and dynamic values the one their command or type gives them
  std::string_view unit;     // "deg", "mm", ...; empty where it has none
  std::string value;         // a JSON literal (true, 13000, -0.5), or one of NaN, Infinity, -Infinity
  std::string hint;          // what a number stands for, "collision error: ..."; mostly empty
  friend bool operator==(const FieldText&, const FieldText&) = default;
};

// Fields that the layout does not have are left out. An image without a safety section gets one row instead of it:
// SafetyStatus, known, false.
std::vector<FieldText> fields_of_inputs(std::span<const std::byte, kInputSize> bytes, Format format);
std::vector<FieldText> fields_of_outputs(std::span<const std::byte, kOutputSize> bytes, Format format);

}  // namespace meca::image
