#include "transports/image/text.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <concepts>
#include <type_traits>
#include <variant>

#include "transports/image/dynamic_data_types.hpp"
#include "transports/image/error_codes.hpp"
#include "transports/image/field_table.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::image {
namespace {

std::string number_text(auto value) {
  char buffer[64];
  const auto end = std::to_chars(std::begin(buffer), std::end(buffer), value).ptr;
  return {buffer, end};
}

std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(std::integral auto value) { return number_text(static_cast<long long>(value)); }
std::string text_of(float value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  return number_text(value);  // the shortest text that gives the same float again
}

std::string error_hint(std::uint16_t code) {
  if (code == 0) return "no error";
  const auto* error = find_error_code(code);
  if (error == nullptr) return "a code that no document names";
  return std::string(error->name) + ": " + std::string(error->text) + " (" + std::string(error->cause) + "); " +
         remedy_text(*error, "ResetError") + (error->resettable ? "" : " (ResetError does not clear it)");
}

std::string dynamic_hint(std::uint32_t id, Layout layout) {
  const auto* type = find_dynamic_data_type(id, layout);
  if (type == nullptr) return "a type that no document names";
  return std::string(type->name) + (type->on_meca500 ? "" : " (other robots)");
}

std::string command_hint(std::uint32_t id) {
  const auto* command = find_motion_command(id);
  return command == nullptr ? "a command that no document names" : std::string(command->name);
}

template <class Image>
FieldText plain(const Field<Image>& field, const Image& image) {
  auto value = std::visit([&image](const auto& place) { return text_of(place.read(image)); }, field.place);
  return {field.section, field.name, field.unit, std::move(value), {}};
}

// The rows below speak of one member of the structs; whether a table row is that member is asked of its place.
template <class Image, class T>
bool is_at(const Field<Image>& field, const Image& image, const T& member) {
  const auto* place = std::get_if<Place<Image, T>>(&field.place);
  return place != nullptr && &place->read(image) == &member;
}

// Index of the float that the row is, of those in `values`; -1 when it is none of them.
template <class Image>
int index_in(const Field<Image>& field, const Image& image, std::span<const float> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (is_at(field, image, values[i])) return static_cast<int>(i);
  }
  return -1;
}

FieldText explain(const Field<Outputs>& field, const Outputs& outputs, Layout layout) {
  auto row = plain(field, outputs);
  const auto& command = outputs.motion_command;
  if (is_at(field, outputs, command.command_id)) row.hint = command_hint(command.command_id);
  for (const auto& type : outputs.dynamic_data_configuration.type_ids) {
    if (is_at(field, outputs, type)) row.hint = dynamic_hint(type, layout);
  }
  const auto index = index_in(field, outputs, command.arguments);
  const auto* info = find_motion_command(command.command_id);
  if (index < 0 || info == nullptr || static_cast<std::size_t>(index) >= info->arguments.size()) return row;
  row.name = info->arguments[static_cast<std::size_t>(index)].name;
  if (outputs.motion_control.use_variables) {
    row.hint = "cyclic id of a variable";
  } else {
    row.unit = info->arguments[static_cast<std::size_t>(index)].unit;
  }
  return row;
}

FieldText explain(const Field<Inputs>& field, const Inputs& inputs, Layout layout) {
  auto row = plain(field, inputs);
  if (is_at(field, inputs, inputs.robot_status.error_code)) row.hint = error_hint(inputs.robot_status.error_code);
  for (const auto& slot : inputs.dynamic_data) {
    if (is_at(field, inputs, slot.type_id)) row.hint = dynamic_hint(slot.type_id, layout);
    const auto index = index_in(field, inputs, slot.values);
    const auto* type = find_dynamic_data_type(slot.type_id, layout);
    if (index < 0 || type == nullptr || static_cast<std::size_t>(index) >= type->values.size()) continue;
    const auto& info = type->values[static_cast<std::size_t>(index)];
    row.name = info.name;
    row.unit = info.unit;
    if (info.bit_pattern) {
      row.value = text_of(std::bit_cast<std::uint32_t>(slot.values[static_cast<std::size_t>(index)]));
    }
  }
  return row;
}

template <class Image>
std::vector<FieldText> rows_of(const auto& fields, const Image& image, Layout layout) {
  std::vector<FieldText> rows;
  rows.reserve(fields.size());
  for (const auto& field : fields) {
    if (field.layouts.has(layout)) rows.push_back(explain(field, image, layout));
  }
  return rows;
}

}  // namespace

std::vector<FieldText> fields_of_inputs(std::span<const std::byte, kInputSize> bytes, Format format) {
  auto texts = rows_of(kInputFields, decode_inputs(bytes, format), format.layout);
  if (!has_safety_section(format.layout)) {
    const auto dynamic_data = std::ranges::find(texts, rows::kDynamic0, &FieldText::section);
    texts.insert(dynamic_data, {rows::kSafety, "known", "", "false",
                                "this firmware reports no safety status: stops are unknown, not absent"});
  }
  return texts;
}

std::vector<FieldText> fields_of_outputs(std::span<const std::byte, kOutputSize> bytes, Format format) {
  return rows_of(kOutputFields, decode_outputs(bytes, format), format.layout);
}

}  // namespace meca::image
