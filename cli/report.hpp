// Where results go: sentences or one JSON object a line on standard output; with --json errors too, so that a program
// has one stream to read. Errors for people go to standard error.
#pragma once

#include <string>
#include <string_view>

#include "cli/invocation.hpp"
#include "cli/json.hpp"

namespace meca::cli {

class Report {
 public:
  explicit Report(bool json) : json_(json) {}
  bool json() const { return json_; }

  void text(std::string_view text) const;                            // nothing with --json
  void object(const Json& object) const;                             // nothing without
  ExitCode error(ExitCode code, const std::string& sentence) const;  // returns `code`

 private:
  bool json_;
};

}  // namespace meca::cli
