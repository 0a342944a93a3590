// What the command lines of the programs that run until they are asked to stop have in common: exit codes, --help,
// --version, and mistakes in sentences.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace meca {

enum class ExitCode : int { kStopped = 0, kArguments = 2, kConfiguration = 3, kNetwork = 4 };

// What to print instead of running.
struct Answer {
  ExitCode code;
  std::string text;
};
// To stdout, or to stderr when it is about a mistake; the exit code of the program.
int print(const Answer& answer);

// `lines`: each with its end.
Answer mistake(const std::string& program, const std::string& lines);

// Adds --help and --version, and fills what the options of the app are bound to. Nothing: go on. `hint`: said behind a
// mistake when no option is near to what was written.
std::optional<Answer> parse_command_line(CLI::App& app, std::string_view version, int argc, const char* const* argv,
                                         std::string_view hint = {});

}  // namespace meca
