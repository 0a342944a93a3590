#include "cli/report.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

namespace meca::cli {

void Report::text(std::string_view text) const {
  if (json_) return;
  std::cout << text << (text.ends_with('\n') ? "" : "\n") << std::flush;
}

void Report::object(const Json& object) const {
  if (json_) std::cout << one_line(object) << '\n' << std::flush;
}

ExitCode Report::error(ExitCode code, const std::string& sentence) const {
  if (json_) {
    object({{"error", sentence}, {"exit_code", static_cast<int>(code)}});
  } else {
    std::cerr << "meca-ctl: " << sentence << '\n';
  }
  return code;
}

}  // namespace meca::cli
