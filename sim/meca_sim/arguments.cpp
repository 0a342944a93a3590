#include "sim/meca_sim/arguments.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>

#include "sim/meca_sim/argument_values.hpp"
#include "sim/meca_sim/ethercat_segment.hpp"

namespace meca::sim {
namespace {

constexpr const char* kAbout =
    "meca-sim: simulated Mecademic Meca500 robots on a network. Point a PLC, a scanner library, an EtherCAT master or "
    "meca-bridge at them.";

constexpr const char* kExamples = R"(Examples:
  meca-sim                                            EtherNet/IP on 127.0.0.1: only programs of this machine reach it
  meca-sim --bind eth0                                at this interface's address, for a PLC
  meca-sim --bind 127.0.0.2 --name arm2               a second one beside the first
  meca-sim --bind 127.0.0.2 --instant-homing --for 60
  meca-sim --protocol ethercat --interface eth1       EtherCAT: the master's cable is in eth1
  meca-sim --protocol ethercat --interface eth1 --count 3
                                                      arm1, arm2 and arm3, one behind the other
  meca-sim --fault "late 50" --fault "api 20000"      a robot with faults from the beginning
  meca-sim --faults config/faults.txt                 faults at their times

While it runs, the buttons and faults of each robot are at hand:
  meca-ctl sim press p-stop2
  meca-ctl --robot arm2 sim unplug
  meca-ctl --robot arm2 sim "clock drift 100"
The words, the same in --fault and in --faults files, stand at the end; 'meca-ctl sim help' lists them too.

A file for --faults has a line for every event, in the order of their times:
  at 2.5s unplug                                      since the program was ready
  after 500ms plug                                    since the line before
  after 1s arm2: power cycle                          only this robot; the lines above are for all there are

EtherNet/IP: TCP and UDP 44818, UDP 2222; connection points 150 (60 bytes out) and 100 (252 bytes in), RPI from 10 ms.
EtherCAT: raw frames on an interface, which needs CAP_NET_RAW (root, or: setcap cap_net_raw+ep meca-sim). Interface and
master must be on the same cable, nothing else with them. Without hardware, a cable inside this machine (as root):
  ip link add meca0 type veth peer name meca1 && ip link set meca0 up && ip link set meca1 up
  meca-sim --protocol ethercat --interface meca1      and the master on meca0; './meca run ethercat' does all of it

Exit codes: 0 asked to stop (SIGINT, SIGTERM, --for)   2 arguments   4 network could not be opened)";

constexpr const char* kEthernetIpGroup = "Options of --protocol ethernet_ip";
constexpr const char* kEthercatGroup = "Options of --protocol ethercat";

constexpr Choice<Fieldbus> kBuses[] = {{"ethernet_ip", Fieldbus::kEthernetIp}, {"ethercat", Fieldbus::kEthercat}};
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

// All mistakes are said together.
class Reader {
 public:
  void say(std::string mistake) { mistakes_ += "meca-sim: " + std::move(mistake) + "\n"; }
  void option(std::string_view name, const Complaint& complaint) {
    if (complaint) say(std::string(name) + ": " + *complaint);
  }
  void fault(const std::string& words, const ScriptStage& stage, std::vector<ScriptLine>& script) {
    auto event = parse_event(words, stage);
    if (const auto* complaint = std::get_if<std::string>(&event)) return say("--fault: " + *complaint);
    script.push_back(std::move(std::get<ScriptLine>(event)));
  }
  void faults_file(const std::string& path, const ScriptStage& stage, std::vector<ScriptLine>& script) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file) return say("--faults: " + path + " cannot be read; name an existing file, e.g. config/faults.txt");
    Script parsed = parse_script(text, path, stage);
    for (std::string& mistake : parsed.mistakes) mistakes_ += mistake + "\n";
    script.insert(script.end(), parsed.lines.begin(), parsed.lines.end());
  }
  const std::string& mistakes() const { return mistakes_; }

 private:
  std::string mistakes_;
};

// As they stand on the command line.
struct Texts {
  std::string protocol = "ethernet_ip", name = "arm1", firmware = "11.3", product = "R4", serial = "1", tool = "none",
              seed = "1";
  std::string key_policy = "same-major", ownership = "release", on_loss = "stop", run_for, faults_file;
  std::string count = "1", alias = "0", reply_delay = "1", clock_ppm = "0";
  std::vector<std::string> faults;
  bool no_socket_items = false, no_lrw = false, instant_homing = false, no_noise = false;
};

using Add = void (*)(CLI::App&, Texts&, Arguments&);

CLI::Option* add(CLI::App& app, const char* name, auto& value, const char* about, const char* type) {
  return app.add_option(name, value, about)->type_name(type);
}

void add_options(CLI::App& app, Texts& t, Arguments& out) {
  add(app, "--protocol", t.protocol, "ethernet_ip (default) or ethercat", "NAME");
  add(app, "--name", t.name, "what meca-ctl --robot calls it; default arm1; of several the number counts on", "NAME");
  add(app, "--firmware", t.firmware, "11.3 (default), 10.2, 9.3, ...", "VERSION");
  add(app, "--product", t.product, "R3 or R4 (default)", "NAME");
  add(app, "--serial", t.serial, "the robot's serial number; default 1; of several it counts on", "N");
  add(app, "--tool", t.tool, "none (default), MEGP25E, MEGP25LS or MPM500", "NAME");
  add(app, "--on-connection-loss", t.on_loss,
      "stop (default): ramp down, 'connection dropped' until motion is resumed; continue: finish the queue", "NAME");
  app.add_flag("--instant-homing", t.instant_homing, "activation, homing and starting up take no time to speak of");
  app.add_flag("--no-noise", t.no_noise, "actual values without noise");
  add(app, "--seed", t.seed, "of the noise; default 1; of several it counts on", "N");
  add(app, "--control", out.control,
      "the control socket: a path (of several robots: a directory), auto (default: where meca-ctl sim looks) or off",
      "PATH");
  add(app, "--fault", t.faults, "words that act from the beginning; may be repeated", "WORDS")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add(app, "--faults", t.faults_file, "words with their times", "FILE");
  add(app, "--for", t.run_for, "leave after so long; default: never", "SECONDS");
  add(app, "--log-level", out.log_level, "trace, debug, info (default), warn, error or off", "LEVEL");
}

void add_ethernet_ip_options(CLI::App& app, Texts& t, Arguments& out) {
  const auto group = [](CLI::Option* option) { option->group(kEthernetIpGroup); };
  group(add(app, "--bind", out.bind, "the robot's address: one of this machine's, or an interface; default 127.0.0.1",
            "ADDR"));
  group(add(app, "--key-policy", t.key_policy,
            "which electronic keys open: exact, same-major (default), any-older or off (all of them)", "NAME"));
  group(add(app, "--ownership", t.ownership, "after a time-out: release (default), or keep for the same originator",
            "NAME"));
  group(app.add_flag("--lenient-rpi", out.adapter.lenient_rpi, "RPIs from 1 ms, where the robot's EDS says 10 ms"));
  group(app.add_flag("--no-socket-items", t.no_socket_items, "Forward Open replies do not say where to send"));
}

void add_ethercat_options(CLI::App& app, Texts& t, Arguments& out) {
  const auto group = [](CLI::Option* option) { return option->group(kEthercatGroup); };
  group(add(app, "--interface", out.interface, "the network interface that the master's cable is in", "NAME"));
  group(add(app, "--redundant-interface", out.redundant_interface,
            "the interface of a second cable, from the last robot to the master: a ring", "NAME"));
  group(add(app, "--count", t.count, "robots, one behind the other: 1 (default) to 32", "N"));
  group(
      add(app, "--alias", t.alias, "station alias of the first robot; of several it counts on; default 0: none", "N"));
  group(add(app, "--foreign", out.foreign, "this robot is another maker's device; may be repeated", "NAME"))
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  group(add(app, "--reply-delay", t.reply_delay, "milliseconds until a mail is answered; default 1", "MS"));
  group(add(app, "--clock-ppm", t.clock_ppm, "the robots' clocks run so much too fast and too slow, in turn", "PPM"));
  group(app.add_flag("--old-sync-manager-types", out.device.old_sync_manager_types,
                     "1C00h names mailbox and process data in the order of firmware 8"));
  group(app.add_flag("--no-lrw", t.no_lrw, "the devices cannot read and write with one datagram"));
}

// Only those of its own bus mean something to a robot; the others would be ignored in silence.
void take_buses(const CLI::App& app, const Texts& t, Reader& reader, Arguments& out) {
  reader.option("--protocol", choose(t.protocol, kBuses, out.bus));
  const bool ethercat = out.bus == Fieldbus::kEthercat;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0 || option->get_group() != (ethercat ? kEthernetIpGroup : kEthercatGroup)) continue;
    reader.say("--" + option->get_single_name() + " is an option of --protocol " +
               (ethercat ? "ethernet_ip, and this is ethercat" : "ethercat, and this is ethernet_ip"));
  }
  if (ethercat && out.interface.empty()) {
    reader.say("--interface is missing: the network interface that the master's cable is in, e.g. --interface eth1");
  }
  if (!out.interface.empty() && out.interface == out.redundant_interface) {
    reader.say("--redundant-interface: found " + in_quotes(out.interface) +
               ", which is --interface already; a ring has two ends");
  }
}

void take_firmware(std::string_view text, Reader& reader, Arguments& out) {
  Firmware firmware;
  reader.option("--firmware", read_firmware(text, firmware));
  out.model.layout = *image::layout_of(firmware.major);
  out.model.firmware_minor = static_cast<std::uint16_t>(firmware.minor);
  // The EDS of firmware 9 has the revision 2.1; later ones are the firmware's (spec 4.2).
  const bool old = out.model.layout == image::Layout::kFirmware9;
  out.adapter.identity.major = static_cast<std::uint8_t>(old ? 2 : firmware.major);
  out.adapter.identity.minor = static_cast<std::uint8_t>(old ? 1 : firmware.minor);
}

void take_robots(const Texts& t, Reader& reader, Arguments& out) {
  std::size_t count = 1;
  reader.option("--count",
                read_number<std::size_t>(t.count, 1, EthercatSegment::kMostRobots, "a number from 1 to 32", count));
  const auto more = static_cast<std::uint32_t>(count - 1);
  reader.option("--name", read_names(t.name, count, out.names));
  take_firmware(t.firmware, reader, out);
  reader.option("--product", choose(t.product, kProducts, out.model.product));
  const std::uint32_t last = std::numeric_limits<std::uint32_t>::max() - more;
  reader.option("--serial", read_number<std::uint32_t>(t.serial, 1, last, "a number from 1 to " + std::to_string(last),
                                                       out.model.serial_number));
  reader.option("--tool", choose(t.tool, kTools, out.model.tool));
  reader.option("--key-policy", choose(t.key_policy, kKeyPolicies, out.adapter.key_policy));
  reader.option("--ownership", choose(t.ownership, kOwnerships, out.adapter.ownership));
  reader.option("--on-connection-loss", choose(t.on_loss, kLosses, out.on_loss));
  reader.option("--seed", read_number<std::uint64_t>(t.seed, 0, std::numeric_limits<std::uint64_t>::max(),
                                                     "a whole number", out.model.seed));
}

void take_ethercat(const Texts& t, Reader& reader, Arguments& out) {
  const auto last = static_cast<std::uint16_t>(0x10000 - out.names.size());
  reader.option("--alias", read_number<std::uint16_t>(t.alias, 0, last, "a number from 0 to " + std::to_string(last),
                                                      out.device.alias));
  for (const std::string& name : out.foreign) {
    if (std::ranges::find(out.names, name) != out.names.end()) continue;
    reader.say("--foreign: there is no robot " + in_quotes(name) + "; the first is " + out.names.front() +
               ", the last " + out.names.back());
  }
  double milliseconds = 1;
  reader.option("--reply-delay",
                read_number<double>(t.reply_delay, 0, 60'000, "milliseconds from 0 to 60000", milliseconds));
  out.device.mailbox_reply = std::chrono::duration_cast<Time>(std::chrono::duration<double, std::milli>(milliseconds));
  reader.option("--clock-ppm", read_number<std::int32_t>(t.clock_ppm, -1000, 1000, "a number from -1000 to 1000",
                                                         out.device.esc.clock_ppm));
}

void take(const CLI::App& app, const Texts& t, Reader& reader, Arguments& out) {
  int unused = 0;
  take_buses(app, t, reader, out);
  take_robots(t, reader, out);
  take_ethercat(t, reader, out);
  reader.option("--log-level", choose(out.log_level, kLevels, unused));
  double seconds = 0;
  if (!t.run_for.empty()) {
    const auto complaint =
        read_number<double>(t.run_for, 0, 31'536'000, "seconds, from 0 to a year of 31536000", seconds);
    reader.option("--for", complaint);
    out.run_for = std::chrono::duration_cast<Time>(std::chrono::duration<double>(seconds));
  }
  const ScriptStage stage{out.bus, out.names};
  for (const std::string& words : t.faults) reader.fault(words, stage, out.script);
  if (!t.faults_file.empty()) reader.faults_file(t.faults_file, stage, out.script);
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
  if (t.no_lrw) out.device.esc.features |= ethercat::kFeatureNoLrw;
}

}  // namespace

Arguments parse_arguments(int argc, const char* const* argv) {
  CLI::App app(kAbout, "meca-sim");
  app.footer(kExamples + ("\n\nWords of a robot:\n" + panel_help()));
  Arguments arguments;
  Texts texts;
  add_options(app, texts, arguments);
  add_ethernet_ip_options(app, texts, arguments);
  add_ethercat_options(app, texts, arguments);
  arguments.answer = parse_command_line(app, MECA_VERSION, argc, argv);
  if (arguments.answer) return arguments;
  Reader reader;
  take(app, texts, reader, arguments);
  if (!reader.mistakes().empty()) arguments.answer = mistake("meca-sim", reader.mistakes());
  complete(texts, arguments);
  return arguments;
}

namespace {

unsigned firmware_major(image::Layout layout) noexcept {
  switch (layout) {
    case image::Layout::kFirmware9:
      return 9;
    case image::Layout::kFirmware10:
      return 10;
    case image::Layout::kFirmware11:
      return 11;
  }
  return 0;
}

std::string firmware_of(const RobotOptions& model) {
  return std::to_string(firmware_major(model.layout)) + "." + std::to_string(model.firmware_minor);
}

}  // namespace

RobotOptions model_of(const Arguments& arguments, std::size_t index) {
  RobotOptions model = arguments.model;
  model.serial_number += static_cast<std::uint32_t>(index);
  model.seed += index;
  return model;
}

ethercat::DeviceSettings device_of(const Arguments& arguments, std::size_t index) {
  ethercat::DeviceSettings device = arguments.device;
  const RobotOptions model = model_of(arguments, index);
  device.layout = model.layout;
  device.firmware =
      firmware_of(model) + "." + std::to_string(model.firmware_patch) + "." + std::to_string(model.firmware_build);
  device.serial = model.serial_number;
  if (device.alias != 0) device.alias = static_cast<std::uint16_t>(device.alias + index);
  if (index % 2 == 1) device.esc.clock_ppm = -device.esc.clock_ppm;
  device.esc.clock_start = std::chrono::nanoseconds(std::chrono::milliseconds(1234)).count() * (index + 1);
  return device;
}

std::string describe(const Arguments& arguments, std::size_t index) {
  const RobotOptions model = model_of(arguments, index);
  return arguments.names[index] + ": simulated Meca500 " + (model.product == Product::kMeca500R3 ? "R3" : "R4") +
         ", firmware " + firmware_of(model) + ", serial number " + std::to_string(model.serial_number);
}

}  // namespace meca::sim
