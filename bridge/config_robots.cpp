#include "bridge/config_robots.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "bridge/config_ethercat.hpp"
#include "bridge/config_ethernet_ip.hpp"
#include "bridge/config_values.hpp"
#include "transports/image/dynamic_data_types.hpp"

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr std::size_t kMaxRobots = 256;
constexpr int kCyclesPerLease = 3;  // fewer, and one late frame would take control away

struct TypeInfo {
  TransportType type;
  std::string_view name;
  bool available;  // this build can run it: THE place to switch a transport on
  nanoseconds shortest_cycle, default_cycle, longest_cycle;
};
// Shortest cycles: ethernet_ip as shortest_rpi() says; profinet and ethercat 1 ms as the manual says; builtin what a
// soft-real-time thread can keep.
constexpr std::array kTypes{
    TypeInfo{TransportType::kBuiltin, "builtin", true, 500us, 1ms, 1s},
    TypeInfo{TransportType::kEthernetIp, "ethernet_ip", true, 10ms, 10ms, 1s},
    TypeInfo{TransportType::kEthercat, "ethercat", true, 1ms, 1ms, kLongestEthercatCycle},
    TypeInfo{TransportType::kProfinet, "profinet", false, 1ms, 1ms, 1s},
};

constexpr const TypeInfo& info(TransportType type) { return kTypes[static_cast<std::size_t>(type)]; }

// A robot with the places that checks between robots point at.
struct Placed {
  RobotConfig robot;
  std::string path;  // "robots[0]"
  yaml::Mark name, cycle, address, place, control_socket;
};

bool is_speakable_firmware(std::string_view text) {
  const auto version = parse_firmware(text);
  return version && version->major >= 9 && version->major <= 11;
}
constexpr std::string_view kFirmwareExpected =
    "9.x, 10.x or 11.x (other generations have another image), e.g. \"11.3\"";

// The longest path that a Unix socket of Linux may have. A word without '/' is more likely a slip than a file.
constexpr std::size_t kLongestSocketPath = 107;
bool is_control_socket(std::string_view text) {
  const bool is_path = text.find('/') != std::string_view::npos && !text.ends_with('/');
  return text == "auto" || text == "off" || (is_path && text.size() <= kLongestSocketPath);
}

void read_builtin(const Section& transport, BuiltinConfig& out) {
  static constexpr std::array<std::string_view, 2> kProducts{"R3", "R4"};
  std::size_t product = 0;
  if (transport.choice("product", kProducts, product)) out.product = kProducts[product];
  transport.text("firmware", kFirmwareExpected, is_speakable_firmware, out.firmware);
  transport.integer("serial_number", 0, 4294967295, out.serial_number);
  transport.flag("instant_homing", out.instant_homing);
  transport.flag("noise", out.noise);
  static constexpr std::array<std::string_view, 4> kTools{"none", "MEGP25E", "MEGP25LS", "MPM500"};
  std::size_t tool = 0;
  if (transport.choice("tool", kTools, tool)) out.tool = kTools[tool];
  transport.text("control_socket", "auto, off, or a path of at most 107 bytes, e.g. /run/meca500/arm1.sock",
                 is_control_socket, out.control_socket);
}

void read_profinet(const Section& transport, ProfinetConfig& out) {
  transport.require("interface", "interface: eth1");
  transport.text("interface", "the name of a network interface as 'ip link' shows it, e.g. eth1",
                 config_values::is_interface_name, out.interface);
  transport.require("station_name", "station_name: meca500-1");
  transport.text("station_name", "a PROFINET station name: a-z 0-9 - in labels joined by dots, e.g. meca500-1",
                 config_values::is_station_name, out.station_name);
  static constexpr std::array<std::string_view, 2> kOrders{"big", "little"};
  std::size_t order = 0;
  if (transport.choice("byte_order", kOrders, order)) out.big_endian = order == 0;
}

// Empty when the type is missing or unknown: then nothing that depends on it can be checked.
std::optional<Section> read_transport(const Section& robot, Placed& placed) {
  robot.require("transport", "transport: {type: builtin}");
  const yaml::Node* node = robot.find("transport");
  if (node == nullptr) return std::nullopt;
  if (node->kind == yaml::Kind::kNull) {
    robot.report().unexpected(*node, robot.path("transport"), "a map with at least the type, e.g. {type: builtin}");
    return std::nullopt;
  }
  if (node->kind != yaml::Kind::kMap) {
    robot.child("transport", "robots[].transport");  // says so
    return std::nullopt;
  }
  std::array<std::string_view, kTypes.size()> names{};
  std::transform(kTypes.begin(), kTypes.end(), names.begin(), [](const TypeInfo& type) { return type.name; });
  const auto given =
      std::find_if(node->keys.begin(), node->keys.end(), [](const auto& key) { return key.text == "type"; });
  std::string_view type_name;
  if (given != node->keys.end()) {
    const yaml::Node& value = node->values[static_cast<std::size_t>(given - node->keys.begin())];
    if (std::find(names.begin(), names.end(), value.text) != names.end()) type_name = value.text;
  }
  const Section transport = robot.child("transport", "robots[].transport", type_name);
  transport.require("type", "type: builtin");
  std::size_t index = 0;
  if (!transport.choice("type", names, index)) return std::nullopt;
  RobotConfig& config = placed.robot;
  config.type = kTypes[index].type;
  placed.address = transport.mark("address");
  placed.place = transport.mark(transport.find("alias") != nullptr ? "alias" : "position");
  placed.control_socket = transport.mark("control_socket");
  switch (config.type) {
    case TransportType::kBuiltin:
      read_builtin(transport, config.builtin);
      break;
    case TransportType::kEthernetIp:
      read_ethernet_ip(transport, config.ethernet_ip);
      break;
    case TransportType::kEthercat:
      read_ethercat(transport, config.ethercat);
      break;
    case TransportType::kProfinet:
      read_profinet(transport, config.profinet);
      break;
  }
  if (!is_available(config.type)) {
    std::string built;
    for (const TypeInfo& type : kTypes) {
      if (type.available) built += (built.empty() ? "'" : ", '") + std::string(type.name) + "'";
    }
    robot.report().error(transport.mark("type"), transport.path("type"),
                         "'" + std::string(names[index]) + "' is not in this version yet; it has " + built);
  }
  return transport;
}

void read_firmware(const Section& robot, transports::FirmwareVersion& out) {
  const auto valid = [](std::string_view text) { return text == "auto" || is_speakable_firmware(text); };
  std::string text;
  const std::string expected = "auto, or " + std::string(kFirmwareExpected);
  if (robot.text("firmware", expected, valid, text) && text != "auto") out = *parse_firmware(text);
}

void read_dynamic_data(const Section& robot, std::array<std::uint32_t, 4>& out) {
  constexpr std::string_view kExpected = "a list of up to 4 dynamic data types, e.g. [auto, auto, auto, 40]";
  const std::span<const yaml::Node> slots = robot.list("dynamic_data", out.size(), kExpected);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const yaml::Node& slot = slots[i];
    const bool automatic = slot.kind == yaml::Kind::kScalar && slot.text == "auto";
    const auto id = slot.kind == yaml::Kind::kScalar ? config_values::integer(slot.text) : std::nullopt;
    const bool in_range = id && *id >= 0 && *id <= 19999;
    const image::DynamicDataInfo* known =
        in_range ? image::find_dynamic_data_type(static_cast<std::uint32_t>(*id)) : nullptr;
    if (automatic || (in_range && *id == 0)) {
      out[i] = image::kDynAutomatic;
    } else if (known != nullptr && known->on_meca500) {
      out[i] = static_cast<std::uint32_t>(*id);
    } else {
      robot.report().unexpected(slot, robot.path("dynamic_data") + "[" + std::to_string(i) + "]",
                                "auto, a dynamic data type of the Meca500 (40 = actual joint angles), or a variable "
                                "10000..19999");
    }
  }
}

// A default is never a mistake: where the file says nothing, the lease grows with a long cycle.
void read_lease(const Section& control, std::string_view key, std::optional<nanoseconds> cycle, nanoseconds& out) {
  const nanoseconds least = kCyclesPerLease * cycle.value_or(0ns);
  if (control.find(key) == nullptr) {
    out = std::max(out, least);
  } else if (control.duration(key, 1ms, 60s, out) && out < least) {
    control.report().error(control.mark(key), control.path(key),
                           to_string(out) + " is less than " + std::to_string(kCyclesPerLease) + " cycles of " +
                               to_string(*cycle) + "; write " + to_string(least) + " or more");
  }
}

bool read_loss_rule(const Section& section, control::LossRule& out) {
  static constexpr std::array<std::string_view, 3> kRules{"client", "stop", "finish"};
  std::size_t rule = 0;
  if (!section.choice("on_loss", kRules, rule)) return false;
  out = static_cast<control::LossRule>(rule);
  return true;
}

void read_client(const Section& client, control::ClientRule& out) {
  client.require("name", "name: cell-plc");
  std::string name;
  const bool right =
      client.text("name", "a client's name of 1 to 63 characters, e.g. cell-plc, or its beginning and a *",
                  config_values::is_client_pattern, name);
  if (right) {
    out.beginning = name.ends_with('*');
    if (out.beginning) name.pop_back();
    out.name = std::string_view(name);
  }
  client.integer("priority", 0, control::ClientRules::kHighestPriority, out.priority);
  control::LossRule rule{};
  if (read_loss_rule(client, rule)) out.on_loss = rule;
}

void read_clients(const Section& control, control::ClientRules& out) {
  read_loss_rule(control, out.on_loss);
  control.duration("take_over_grace", 0ns, 60s, out.take_over_grace);
  constexpr std::string_view kExpected = "a list of up to 32 clients, e.g. [{name: cell-plc, priority: 10}]";
  const auto elements = control.list("clients", control::ClientRules::kMost, kExpected);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string path = control.path("clients") + "[" + std::to_string(i) + "]";
    if (elements[i].kind != yaml::Kind::kMap) {
      control.report().unexpected(elements[i], path, "a client, e.g. {name: cell-plc, priority: 10}");
      continue;
    }
    const Section client(&elements[i], elements[i].mark, path, "robots[].control.clients[]", control.report());
    control::ClientRule& rule = out.clients[out.count];
    read_client(client, rule);
    const auto same = [&rule](const control::ClientRule& other) {
      return other.name == rule.name && other.beginning == rule.beginning;
    };
    if (std::any_of(out.clients.begin(), out.clients.begin() + out.count, same) && client.find("name") != nullptr) {
      control.report().error(client.mark("name"), path + ".name",
                             "a rule for this name is given above; keep one of them");
    }
    ++out.count;
  }
}

// `cycle`: nothing when it is wrong itself.
void read_control(const Section& robot, std::optional<nanoseconds> cycle, ControlConfig& out) {
  const Section control = robot.child("control", "robots[].control");
  control.flag("enabled", out.enabled);
  control.flag("allow_brakes", out.allow_brakes);
  read_clients(control, out.clients);
  read_lease(control, "lease", cycle, out.lease);
  read_lease(control, "velocity_lease", cycle, out.velocity_lease);
}

nanoseconds shortest_cycle(const RobotConfig& config) {
  return config.type == TransportType::kEthernetIp ? shortest_rpi(config.ethernet_ip)
                                                   : info(config.type).shortest_cycle;
}

Placed read_robot(const Section& robot, std::string path) {
  Placed placed{{}, std::move(path), {}, {}, {}, {}, {}};
  RobotConfig& config = placed.robot;
  robot.require("name", "name: arm1");
  robot.text("name", "1 to 63 of the characters A-Z a-z 0-9 _ -, e.g. arm1", config_values::is_robot_name, config.name);
  placed.name = robot.mark("name");
  placed.cycle = robot.mark("cycle");
  const std::optional<Section> transport = read_transport(robot, placed);
  if (transport) config.cycle = info(config.type).default_cycle;
  const bool cycle_right =
      robot.duration("cycle", shortest_cycle(config), info(config.type).longest_cycle, config.cycle) ||
      robot.find("cycle") == nullptr;
  if (transport && cycle_right && config.type == TransportType::kEthernetIp) {
    settle_ethernet_ip(*transport, config.cycle, config.ethernet_ip);
  }
  read_firmware(robot, config.firmware);
  read_dynamic_data(robot, config.dynamic_data);
  read_control(robot, cycle_right ? std::optional(config.cycle) : std::nullopt, config.control);
  return placed;
}

void check_control_sockets(const Placed& first, const Placed& second, Report& report) {
  const std::string& path = second.robot.builtin.control_socket;
  if (path == "auto" || path == "off" || first.robot.builtin.control_socket != path) return;
  report.error(second.control_socket, second.path + ".transport.control_socket",
               "'" + path + "' is already the control socket of " + first.path + " in line " +
                   std::to_string(first.control_socket.line) + "; each robot has its own");
}

void check_pair(const Placed& first, const Placed& second, Report& report) {
  check_control_sockets(first, second, report);
  const RobotConfig &a = first.robot, &b = second.robot;
  if (!a.name.empty() && a.name == b.name) {
    report.error(second.name, second.path + ".name",
                 "'" + b.name + "' is already the name of " + first.path + " in line " +
                     std::to_string(first.name.line) + "; names must differ");
  }
  const bool same_address = a.type == TransportType::kEthernetIp && b.type == TransportType::kEthernetIp &&
                            !a.ethernet_ip.address.empty() && a.ethernet_ip.address == b.ethernet_ip.address;
  if (same_address) {
    report.error(second.address, second.path + ".transport.address",
                 "'" + b.ethernet_ip.address + "' is already the address of " + first.path + " in line " +
                     std::to_string(first.address.line) + "; a robot has one connection");
  }
  const bool same_segment = a.type == TransportType::kEthercat && b.type == TransportType::kEthercat &&
                            !a.ethercat.interface.empty() && a.ethercat.interface == b.ethercat.interface;
  if (!same_segment) return;
  if (a.ethercat.alias && a.ethercat.alias == b.ethercat.alias) {
    report.error(second.place, second.path + ".transport.alias",
                 std::to_string(*b.ethercat.alias) + " is already the alias of " + first.path + " on '" +
                     b.ethercat.interface + "'; aliases on one segment must differ");
  }
  if (!a.ethercat.alias && !b.ethercat.alias && a.ethercat.position == b.ethercat.position) {
    report.error(second.place, second.path + ".transport.position",
                 std::to_string(b.ethercat.position) + " is already the position of " + first.path + " on '" +
                     b.ethercat.interface + "'; positions on one segment must differ");
  }
  if (a.cycle != b.cycle) {
    report.error(second.cycle, second.path + ".cycle",
                 to_string(b.cycle) + " differs from the " + to_string(a.cycle) + " of " + first.path + " on '" +
                     b.ethercat.interface + "'; one segment has one frame and one cycle");
  }
}

}  // namespace

std::vector<RobotConfig> read_robots(const Section& root) {
  constexpr std::string_view kExpected =
      "a list of 1 to 256 robots, the smallest: [{name: arm1, transport: {type: builtin}}]";
  Report& report = root.report();
  root.require("robots", "robots: [{name: arm1, transport: {type: builtin}}]");
  const yaml::Node* node = root.find("robots");
  if (node == nullptr) return {};
  if (node->kind == yaml::Kind::kSequence && node->values.empty()) {
    report.error(node->mark, "robots", "found an empty list; expected " + std::string(kExpected));
  }
  const std::span<const yaml::Node> elements = root.list("robots", kMaxRobots, kExpected);
  std::vector<Placed> placed;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string path = "robots[" + std::to_string(i) + "]";
    if (elements[i].kind != yaml::Kind::kMap) {
      report.unexpected(elements[i], path, "a robot, e.g. {name: arm1, transport: {type: builtin}}");
      continue;
    }
    placed.push_back(read_robot(Section(&elements[i], elements[i].mark, path, "robots[]", report), path));
  }
  for (std::size_t b = 0; b < placed.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) check_pair(placed[a], placed[b], report);
  }
  std::vector<RobotConfig> robots;
  for (Placed& each : placed) robots.push_back(std::move(each.robot));
  return robots;
}

std::string_view to_string(TransportType type) { return info(type).name; }

bool is_available(TransportType type) { return info(type).available; }

}  // namespace meca::bridge
