// The command line of meca-ctl: words in, an Invocation or a text to print out. Reads the environment (MECA_DOMAIN
// ...).
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "cli/invocation.hpp"

namespace meca::cli {

// Nothing to run: help was asked for, or the command line was not understood.
struct Answer {
  ExitCode code = ExitCode::kDone;
  std::string text;
};

std::variant<Invocation, Answer> parse_arguments(std::vector<std::string> words);  // without the program's name

}  // namespace meca::cli
