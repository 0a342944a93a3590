#include "cli/errors.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <nlohmann/json.hpp>

#include "cli/format.hpp"
#include "cli/plan.hpp"
#include "cli/suggest.hpp"

namespace meca::cli {
namespace {

using image::ErrorInfo;
using image::ResetBy;
using image::StopInfo;

// The same of both, in the words of people.
struct Entry {
  std::string code, name, text, cause, remedy, reset;
};

Entry entry_of(const ErrorInfo& e) {
  return {std::to_string(e.code),
          std::string(e.name),
          std::string(e.text),
          std::string(e.cause),
          image::remedy_text(e, "'meca-ctl reset-error' and, with the motors on, 'meca-ctl resume'"),
          e.resettable ? "yes" : "no"};
}

Entry entry_of(const StopInfo& s) {
  const bool button = s.reset_by == ResetBy::kResetButton;
  const std::string reset =
      button ? ", then press Reset on the power supply, then 'meca-ctl activate'" : ", then 'meca-ctl resume'";
  return {std::to_string(s.status_code), std::string(s.name),           std::string(s.text),
          std::string(s.cause),          std::string(s.remedy) + reset, button ? "Reset button" : "resume"};
}

Entry entry_of(const Trouble& trouble) {
  return std::visit([](const auto* info) { return entry_of(*info); }, trouble);
}

bool on_meca500(const StopInfo& stop) { return image::field_of(stop).robots == image::Robots::kMeca500; }

std::string bit_of(const StopInfo& stop) {
  const auto& field = image::field_of(stop);
  return std::to_string(field.byte) + ":" + std::to_string(field.bit);
}

bool same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::string_view table_name(const Trouble& trouble) {
  if (const auto* error = std::get_if<const ErrorInfo*>(&trouble)) return (*error)->name;
  return std::get<const StopInfo*>(trouble)->field;
}

std::string row(std::initializer_list<std::string> cells) {
  std::string text = "|";
  for (const auto& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

constexpr const char* kPageHead = R"(<!-- printed by `meca-ctl errors --markdown` from transports/image, do not edit -->
# Errors and stops of the robot

`meca-ctl status` says which one is there and what to do now; `meca-ctl errors 1007` says what is in these tables of one.
The remedies are in the order in which a person does them. Causes and remedies are inferred from public descriptions of the
robot; none was tried on one.

)";

constexpr const char* kStopsHead = R"(## Stops

The bits of SafetyStatus (firmware 10 and later). A bit stays set until the stop is reset, which is possible when the bit of
the same name with `Resettable`, four bytes behind it, is set too. The code is that of the robot's log. Firmware 9 has E-Stop
in RobotStatus and P-Stop 2 in MotionStatus only; a Meca500 R3 never reports its E-Stop.

| Byte:bit | Name | Code | Stop | What it is | Likely cause | Remedy | Meca500 |
|---|---|---|---|---|---|---|---|
)";

constexpr const char* kErrorsHead = R"(
## Errors

`ErrorCode` of RobotStatus. The robot stops, empties its queue and takes no command until the error is reset. Where a stop is
there as well, it comes first. "Reset" tells whether ResetError clears the error.

| Code | Name | What happened | Likely cause | Remedy | Reset |
|---|---|---|---|---|---|
)";

}  // namespace

std::vector<Trouble> all_troubles() {
  std::vector<Trouble> all;
  for (const StopInfo& stop : image::stop_signals()) all.emplace_back(&stop);
  for (const ErrorInfo& error : image::error_codes()) all.emplace_back(&error);
  return all;
}

Trouble find_trouble(std::string_view word) {
  const auto all = all_troubles();
  for (const Trouble& trouble : all) {
    const Entry entry = entry_of(trouble);
    if (word == entry.code || same_word(word, entry.name) || same_word(word, table_name(trouble))) return trouble;
  }
  if (word == "0") throw UsageError("error code 0 means that there is no error");
  const bool is_number = std::ranges::all_of(word, [](unsigned char c) { return std::isdigit(c) != 0; });
  std::vector<std::string> names;
  for (const Trouble& trouble : all) names.emplace_back(table_name(trouble));
  const std::string guess = is_number ? "" : did_you_mean(word, names);
  throw UsageError("no document names an error or stop '" + std::string(word) + "'" +
                   (guess.empty() ? "; 'meca-ctl errors' lists those that are known" : guess));
}

std::string explain(const Trouble& trouble) {
  const Entry entry = entry_of(trouble);
  std::string text = entry.code + "  " + entry.name + "\n  What     " + entry.text +
                     "\n  Cause    likely: " + entry.cause + "\n  Remedy   " + entry.remedy + "\n  Reset    ";
  if (const auto* error = std::get_if<const ErrorInfo*>(&trouble)) {
    return text + ((*error)->resettable ? "ResetError clears it; the robot stays paused until it is resumed\n"
                                        : "ResetError does not clear it\n");
  }
  const StopInfo& stop = *std::get<const StopInfo*>(trouble);
  text += stop.reset_by == ResetBy::kResume ? "ResumeMotion, once the cause is gone"
                                            : "the Reset button of the power supply, once the cause is gone";
  text += "\n  Where    SafetyStatus." + std::string(stop.field) + ", byte " + bit_of(stop);
  return text + (on_meca500(stop) ? "\n" : "; other robots: a Meca500 leaves it 0\n");
}

Json to_json(const Trouble& trouble) {
  const Entry entry = entry_of(trouble);
  Json json{{"code", std::stoi(entry.code)}, {"kind", ""},
            {"name", table_name(trouble)},   {"text", entry.text},
            {"cause", entry.cause},          {"remedy", entry.remedy}};
  if (const auto* error = std::get_if<const ErrorInfo*>(&trouble)) {
    json["kind"] = "error";
    json["resettable"] = (*error)->resettable;
  } else {
    const StopInfo& stop = *std::get<const StopInfo*>(trouble);
    json["kind"] = "stop";
    json["reset_by"] = stop.reset_by == ResetBy::kResume ? "ResumeMotion" : "Reset button";
    json["on_meca500"] = on_meca500(stop);
  }
  return json;
}

std::string troubles_list() {
  std::vector<std::vector<std::string>> rows{{"Code", "Reset", "Name", "What it is"}};
  for (const Trouble& trouble : all_troubles()) {
    const Entry entry = entry_of(trouble);
    rows.push_back({entry.code, entry.reset, std::string(table_name(trouble)), entry.text});
  }
  return table(rows) + "\n'meca-ctl errors CODE' tells cause and remedy.\n";
}

std::string troubles_page() {
  std::string text = std::string(kPageHead) + kStopsHead;
  for (const StopInfo& stop : image::stop_signals()) {
    const Entry e = entry_of(stop);
    text += row({bit_of(stop), "`" + std::string(stop.field) + "`", e.code, e.name, e.text, e.cause, e.remedy,
                 on_meca500(stop) ? "yes" : "no"});
  }
  text += kErrorsHead;
  for (const ErrorInfo& error : image::error_codes()) {
    const Entry e = entry_of(error);
    text += row({e.code, "`" + e.name + "`", e.text, e.cause, e.remedy, e.reset});
  }
  return text;
}

}  // namespace meca::cli
