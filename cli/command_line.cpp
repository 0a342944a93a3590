#include "cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <vector>

#include "transports/image/nearest.hpp"

namespace meca {
namespace {

// What was probably meant by an option that there is none of.
std::string suggestion(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) names.push_back("--" + option->get_single_name());
  const std::vector<std::string_view> known(names.begin(), names.end());
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const std::string_view name = argument.substr(0, argument.find('='));
    if (!name.starts_with("--") || std::ranges::find(known, name) != known.end()) continue;
    const std::string_view meant = image::nearest(name, known);
    if (!meant.empty()) return "; did you mean '" + std::string(meant) + "'?";
  }
  return {};
}

}  // namespace

int print(const Answer& answer) {
  (answer.code == ExitCode::kStopped ? std::cout : std::cerr) << answer.text;
  return static_cast<int>(answer.code);
}

Answer mistake(const std::string& program, const std::string& lines) {
  return {ExitCode::kArguments, lines + program + " --help shows the options and examples\n"};
}

std::optional<Answer> parse_command_line(CLI::App& app, std::string_view version, int argc, const char* const* argv,
                                         std::string_view hint) {
  const std::string program = app.get_name();
  app.set_version_flag("--version", program + " " + std::string(version), "say the version and leave");
  app.set_help_flag("-h,--help", "say this and leave");
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::CallForHelp&) {
    return Answer{ExitCode::kStopped, app.help()};
  } catch (const CLI::CallForVersion& said) {
    return Answer{ExitCode::kStopped, std::string(said.what()) + "\n"};
  } catch (const CLI::ParseError& error) {
    std::string meant = suggestion(app, argc, argv);
    if (meant.empty()) meant = hint;
    return mistake(program, program + ": " + error.what() + meant + "\n");
  }
}

}  // namespace meca
