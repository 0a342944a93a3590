#include "sim/meca_sim/arguments.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <limits>

#include "transports/image/nearest.hpp"

namespace meca::sim {
namespace {

constexpr const char* kAbout =
    "meca-sim: a simulated Mecademic Meca500 on a network. Point a PLC, a scanner library or meca-bridge at it.";

constexpr const char* kExamples = R"(Examples:
  meca-sim                                            on 127.0.0.1: only programs of this machine reach it
  meca-sim --bind eth0                                at this interface's address, for a PLC
  meca-sim --bind 127.0.0.2 --name arm2               a second one beside the first
  meca-sim --bind 127.0.0.2 --instant-homing --for 60
  meca-sim --fault "late 50" --fault "api 20000"      a robot with faults from the beginning
  meca-sim --faults config/faults.txt                 faults at their times

While it runs, its buttons and faults are at hand:
  meca-ctl sim press p-stop2
  meca-ctl sim unplug
  meca-ctl sim help                                   all words; the same in --fault and in --faults files

A file for --faults has a line for every event, in the order of their times:
  at 2.5s unplug                                      since the program was ready
  after 500ms plug                                    since the line before

EtherNet/IP: TCP and UDP 44818, UDP 2222; connection points 150 (60 bytes out) and 100 (252 bytes in), RPI from 10 ms.

Exit codes: 0 asked to stop (SIGINT, SIGTERM, --for)   2 arguments   4 network could not be opened)";

// What CLI11 is told of an option; a text is turned into a value by `take`, which complains in a sentence.
using Complaint = std::optional<std::string>;

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

std::string guess(std::string_view word, std::span<const std::string_view> known) {
  const std::string_view meant = image::nearest(word, known);
  return meant.empty() ? "" : "; did you mean " + quoted(meant) + "?";
}

template <class Value>
struct Choice {
  std::string_view word;
  Value value;
};

template <class Value, std::size_t N>
Complaint choose(std::string_view word, const Choice<Value> (&choices)[N], Value& out) {
  std::vector<std::string_view> known;
  std::string all;
  for (const auto& choice : choices) {
    if (choice.word == word) {
      out = choice.value;
      return std::nullopt;
    }
    known.push_back(choice.word);
    all += (all.empty() ? "" : ", ") + std::string(choice.word);
  }
  return "found " + quoted(word) + "; expected one of " + all + guess(word, known);
}

constexpr Choice<Product> kProducts[] = {{"R3", Product::kMeca500R3}, {"R4", Product::kMeca500R4}};
constexpr Choice<ToolType> kTools[] = {{"none", ToolType::kNone},
                                       {"MEGP25E", ToolType::kMegp25e},
                                       {"MEGP25LS", ToolType::kMegp25ls},
                                       {"MPM500", ToolType::kMpm500}};
constexpr Choice<ethernet_ip::AdapterKeyPolicy> kKeyPolicies[] = {
    {"exact", ethernet_ip::AdapterKeyPolicy::kExact},
    {"same-major", ethernet_ip::AdapterKeyPolicy::kCompatibleSameMajor},
    {"any-older", ethernet_ip::AdapterKeyPolicy::kCompatibleAnyOlder},
    {"off", ethernet_ip::AdapterKeyPolicy::kOff}};
constexpr Choice<ethernet_ip::OwnershipPolicy> kOwnerships[] = {
    {"release", ethernet_ip::OwnershipPolicy::kReleaseOnTimeout}, {"keep", ethernet_ip::OwnershipPolicy::kKeep}};
constexpr Choice<ConnectionLoss> kLosses[] = {{"stop", ConnectionLoss::kStop}, {"continue", ConnectionLoss::kContinue}};
constexpr Choice<int> kLevels[] = {{"trace", 0}, {"debug", 0}, {"info", 0}, {"warn", 0}, {"error", 0}, {"off", 0}};

Complaint check_protocol(std::string_view word) {
  if (word == "ethernet_ip") return std::nullopt;
  constexpr std::string_view kKnown[] = {"ethernet_ip"};
  return "found " + quoted(word) + "; this version speaks ethernet_ip only" + guess(word, kKnown);
}

Complaint read_firmware(std::string_view text, Arguments& out) {
  unsigned major = 0, minor = 0;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, major);
  const bool dot = first.ec == std::errc{} && first.ptr != end && *first.ptr == '.';
  const auto second = dot ? std::from_chars(first.ptr + 1, end, minor) : first;
  const auto layout = image::layout_of(major);
  if (!dot || second.ec != std::errc{} || second.ptr != end || !layout || major > 11 || minor > 255) {
    return "found " + quoted(text) + "; expected a version of the firmware from 9.0 to 11.x, e.g. 11.3";
  }
  out.model.layout = *layout;
  out.model.firmware_minor = static_cast<std::uint16_t>(minor);
  // The EDS of firmware 9 has the revision 2.1; later ones are the firmware's (spec 4.2).
  const bool old = *layout == image::Layout::kFirmware9;
  out.adapter.identity.major = static_cast<std::uint8_t>(old ? 2 : major);
  out.adapter.identity.minor = static_cast<std::uint8_t>(old ? 1 : minor);
  return std::nullopt;
}

template <class Number>
Complaint read_number(std::string_view text, Number minimum, Number maximum, std::string_view expected, Number& out) {
  Number value{};
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size() || !(value >= minimum && value <= maximum)) {
    return "found " + quoted(text) + "; expected " + std::string(expected);
  }
  out = value;
  return std::nullopt;
}

// The name is part of the control socket's file name.
Complaint check_name(std::string_view name) {
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (!name.empty() && name.size() <= 32 && std::ranges::all_of(name, good)) return std::nullopt;
  return "found " + quoted(name) + "; expected 1 to 32 letters, digits, '-' or '_'";
}

// All mistakes are said together.
class Reader {
 public:
  void say(std::string mistake) { mistakes_ += "meca-sim: " + std::move(mistake) + "\n"; }
  void option(std::string_view name, const Complaint& complaint) {
    if (complaint) say(std::string(name) + ": " + *complaint);
  }
  void fault(const std::string& words, std::vector<ScriptLine>& script) {
    const auto request = parse_panel_line(words);
    if (const auto* complaint = std::get_if<std::string>(&request)) return say("--fault: " + *complaint);
    script.push_back({Time{}, words, std::get<PanelRequest>(request)});
  }
  void faults_file(const std::string& path, std::vector<ScriptLine>& script) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file) return say("--faults: " + path + " cannot be read; name an existing file, e.g. config/faults.txt");
    Script parsed = parse_script(text, path);
    for (std::string& mistake : parsed.mistakes) mistakes_ += mistake + "\n";
    script.insert(script.end(), parsed.lines.begin(), parsed.lines.end());
  }
  const std::string& mistakes() const { return mistakes_; }

 private:
  std::string mistakes_;
};

// As they stand on the command line.
struct Texts {
  std::string protocol = "ethernet_ip", firmware = "11.3", product = "R4", serial = "1", tool = "none", seed = "1";
  std::string key_policy = "same-major", ownership = "release", on_loss = "stop", run_for, faults_file;
  std::vector<std::string> faults;
  bool no_socket_items = false, instant_homing = false, no_noise = false;
};

void add_options(CLI::App& app, Texts& t, Arguments& out) {
  const auto add = [&app](const char* name, auto& value, const char* about, const char* type) {
    app.add_option(name, value, about)->type_name(type);
  };
  add("--protocol", t.protocol, "ethernet_ip (default)", "NAME");
  add("--bind", out.bind, "the robot's address: one of this machine's, or an interface; default 127.0.0.1", "ADDR");
  add("--name", out.name, "what meca-ctl --robot calls it; default arm1", "NAME");
  add("--firmware", t.firmware, "11.3 (default), 10.2, 9.3, ...", "VERSION");
  add("--product", t.product, "R3 or R4 (default)", "NAME");
  add("--serial", t.serial, "the robot's serial number; default 1", "N");
  add("--tool", t.tool, "none (default), MEGP25E, MEGP25LS or MPM500", "NAME");
  add("--key-policy", t.key_policy,
      "which electronic keys open: exact, same-major (default), any-older or off (all of them)", "NAME");
  add("--ownership", t.ownership, "after a time-out: release (default), or keep for the same originator", "NAME");
  add("--on-connection-loss", t.on_loss,
      "stop (default): ramp down, 'connection dropped' until motion is resumed; continue: finish the queue", "NAME");
  app.add_flag("--lenient-rpi", out.adapter.lenient_rpi, "RPIs from 1 ms, where the robot's EDS says 10 ms");
  app.add_flag("--no-socket-items", t.no_socket_items, "Forward Open replies do not say where to send");
  app.add_flag("--instant-homing", t.instant_homing, "activation, homing and starting up take no time to speak of");
  app.add_flag("--no-noise", t.no_noise, "actual values without noise");
  add("--seed", t.seed, "of the noise; default 1", "N");
  add("--control", out.control, "the control socket: a path, auto (default: where meca-ctl sim looks) or off", "PATH");
  add("--fault", t.faults, "words that act from the beginning; may be repeated", "WORDS");
  add("--faults", t.faults_file, "words with their times", "FILE");
  add("--for", t.run_for, "leave after so long; default: never", "SECONDS");
  add("--log-level", out.log_level, "trace, debug, info (default), warn, error or off", "LEVEL");
  app.get_option("--fault")->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void take(const Texts& t, Reader& reader, Arguments& out) {
  int unused = 0;
  reader.option("--protocol", check_protocol(t.protocol));
  reader.option("--name", check_name(out.name));
  reader.option("--firmware", read_firmware(t.firmware, out));
  reader.option("--product", choose(t.product, kProducts, out.model.product));
  reader.option("--serial", read_number<std::uint32_t>(t.serial, 1, std::numeric_limits<std::uint32_t>::max(),
                                                       "a number from 1 to 4294967295", out.model.serial_number));
  reader.option("--tool", choose(t.tool, kTools, out.model.tool));
  reader.option("--key-policy", choose(t.key_policy, kKeyPolicies, out.adapter.key_policy));
  reader.option("--ownership", choose(t.ownership, kOwnerships, out.adapter.ownership));
  reader.option("--on-connection-loss", choose(t.on_loss, kLosses, out.on_loss));
  reader.option("--seed", read_number<std::uint64_t>(t.seed, 0, std::numeric_limits<std::uint64_t>::max(),
                                                     "a whole number", out.model.seed));
  reader.option("--log-level", choose(out.log_level, kLevels, unused));
  double seconds = 0;
  if (!t.run_for.empty()) {
    const auto complaint =
        read_number<double>(t.run_for, 0, 31'536'000, "seconds, from 0 to a year of 31536000", seconds);
    reader.option("--for", complaint);
    out.run_for = std::chrono::duration_cast<Time>(std::chrono::duration<double>(seconds));
  }
  for (const std::string& words : t.faults) reader.fault(words, out.script);
  if (!t.faults_file.empty()) reader.faults_file(t.faults_file, out.script);
}

void complete(const Texts& t, Arguments& out) {
  out.model.noise = !t.no_noise;
  out.model.variables = example_variables();
  // One millisecond, not none: what takes no time at all shows no Busy, and hosts wait for its end.
  if (t.instant_homing) {
    out.model.activation_time = out.model.homing_time = out.model.deactivation_time = std::chrono::milliseconds(1);
    out.model.boot_time = std::chrono::milliseconds(500);  // long enough for a host to miss it
  }
  out.adapter.socket_items = !t.no_socket_items;
  ethernet_ip::Identity& identity = out.adapter.identity;
  identity.vendor_id = ethernet_ip::kMecademicVendor;
  identity.device_type = ethernet_ip::kRobotDeviceType;
  identity.product_code = ethernet_ip::kMeca500ProductCode;
  identity.serial_number = out.model.serial_number;
  identity.set_name("Meca500");
}

// What was probably meant by an option that there is none of.
std::string suggestion(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) names.push_back("--" + option->get_single_name());
  const std::vector<std::string_view> known(names.begin(), names.end());
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const std::string_view name = argument.substr(0, argument.find('='));
    if (name.starts_with("--") && std::ranges::find(known, name) == known.end()) return guess(name, known);
  }
  return {};
}

Arguments answer(ExitCode code, std::string text) {
  Arguments arguments;
  arguments.answer = {code, std::move(text)};
  return arguments;
}

Arguments mistake(const std::string& text) {
  return answer(ExitCode::kArguments, text + "meca-sim --help shows the options and examples\n");
}

}  // namespace

Arguments parse_arguments(int argc, const char* const* argv) {
  CLI::App app(kAbout, "meca-sim");
  app.footer(kExamples);
  app.set_version_flag("--version", "meca-sim " MECA_VERSION, "say the version and leave");
  app.set_help_flag("-h,--help", "say this and leave");
  Arguments arguments;
  Texts texts;
  add_options(app, texts, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return answer(ExitCode::kStopped, app.help());
  } catch (const CLI::CallForVersion& version) {
    return answer(ExitCode::kStopped, std::string(version.what()) + "\n");
  } catch (const CLI::ParseError& error) {
    return mistake("meca-sim: " + std::string(error.what()) + suggestion(app, argc, argv) + "\n");
  }
  Reader reader;
  take(texts, reader, arguments);
  if (!reader.mistakes().empty()) return mistake(reader.mistakes());
  complete(texts, arguments);
  return arguments;
}

std::string describe(const Arguments& arguments) {
  const RobotOptions& model = arguments.model;
  const int major = model.layout == image::Layout::kFirmware9    ? 9
                    : model.layout == image::Layout::kFirmware10 ? 10
                                                                 : 11;
  return arguments.name + ": simulated Meca500 " + (model.product == Product::kMeca500R3 ? "R3" : "R4") +
         ", firmware " + std::to_string(major) + "." + std::to_string(model.firmware_minor) + ", serial number " +
         std::to_string(model.serial_number);
}

}  // namespace meca::sim
