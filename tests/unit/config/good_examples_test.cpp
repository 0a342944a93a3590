// The files of config/ are the manual: every one loads, and reference.yaml names every key with its default.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "bridge/config.hpp"
#include "bridge/config_keys.hpp"
#include "bridge/config_yaml.hpp"
#include "bridge/topics.hpp"

namespace {

using namespace meca::bridge;
namespace control = meca::control;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

const fs::path kConfig = fs::path(MECA_SOURCE_DIR) / "config";

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string letters(const std::vector<ConfigError>& errors) {
  std::string text;
  for (const ConfigError& error : errors) text += to_string(error) + "\n";
  return text;
}

// reference.yaml with the lines of the other transports, which it holds as "#:" comments.
std::string reference_with_all_transports() {
  std::istringstream in(contents(kConfig / "reference.yaml"));
  std::string text, line;
  while (std::getline(in, line)) text += (line.starts_with("#:") ? line.substr(2) : line) + "\n";
  return text;
}

// "robots[].transport" + "type" of every value in the tree, in the notation of config_keys.hpp.
void collect(const yaml::Node& node, const std::string& section, std::set<std::string>& keys) {
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    const std::string& name = node.keys[i].text;
    const bool topic = section == "dds.topics";
    if (!topic) keys.insert(section + "/" + name);
    std::string below = section.empty() ? name : section + "." + (topic ? "*" : name);
    const yaml::Node& value = node.values[i];
    if (value.kind == yaml::Kind::kSequence) {
      for (const yaml::Node& element : value.values) collect(element, below + "[]", keys);
    } else {
      collect(value, below, keys);
    }
  }
}

bool same(const TopicConfig& a, const TopicConfig& b) {
  return a.rate == b.rate && a.period == b.period && a.reliable == b.reliable &&
         a.transient_local == b.transient_local && a.depth == b.depth;
}

TEST(ConfigFolder, HasOnlyFilesThatLoadWithoutErrorOrWarning) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(kConfig)) {
    if (entry.path().extension() != ".yaml") continue;
    const ConfigResult result = load_config(entry.path());
    EXPECT_EQ(letters(result.errors), "");
    EXPECT_EQ(letters(result.warnings), "");
    EXPECT_TRUE(result.config.has_value()) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 4);
}

TEST(ConfigFolder, CellHasFourRobotsAtOneKilohertz) {
  const ConfigResult result = load_config(kConfig / "cell.yaml");
  ASSERT_TRUE(result.config.has_value());
  ASSERT_EQ(result.config->robots.size(), 4U);
  std::set<std::string> names;
  for (const RobotConfig& robot : result.config->robots) {
    names.insert(robot.name);
    EXPECT_EQ(robot.type, TransportType::kBuiltin);
    EXPECT_EQ(robot.cycle, 1ms);
  }
  EXPECT_EQ(names, (std::set<std::string>{"arm1", "arm2", "arm3", "arm4"}));
}

TEST(Reference, NamesEveryKeyTheReaderKnowsAndNoOther) {
  const yaml::Document document = yaml::parse(reference_with_all_transports());
  ASSERT_TRUE(document.root.has_value());
  std::set<std::string> written, known;
  collect(*document.root, "", written);
  for (const config_keys::Key& key : config_keys::kKeys) {
    known.insert(std::string(key.section) + "/" + std::string(key.name));
  }
  EXPECT_THAT(written, testing::ContainerEq(known));
}

TEST(Reference, NamesEveryPublishedTopic) {
  const yaml::Document document = yaml::parse(contents(kConfig / "reference.yaml"));
  ASSERT_TRUE(document.root.has_value());
  const yaml::Node& dds = document.root->values.at(0);
  std::vector<std::string> written, known;
  for (const yaml::Node& topic : dds.values.back().keys) written.push_back(topic.text);
  for (const TopicInfo& info : kTopics) {
    if (info.direction == Direction::kPublished) known.emplace_back(info.name);
  }
  EXPECT_EQ(written, known);
}

TEST(Reference, HasItsOtherTransportsRightAndOnlyTheirAbsenceToComplainOf) {
  const ConfigResult result = parse_config(reference_with_all_transports(), "reference.yaml");
  std::vector<std::string> messages;
  for (const ConfigError& error : result.errors) messages.push_back(error.key + ": " + error.message);
  EXPECT_THAT(messages,
              testing::ElementsAre("robots[4].transport.type: 'profinet' is not in this version yet; it has 'builtin', "
                                   "'ethernet_ip', 'ethercat'"));
}

// The first of the other transports alone, and with nothing but its address.
TEST(Reference, HasTheDefaultsOfEthernetIp) {
  std::string text = reference_with_all_transports();
  text.resize(text.find("  - name: arm3"));
  const auto reference = parse_config(text, "reference.yaml").config;
  const auto smallest =
      parse_config("robots: [{name: arm1, transport: {type: ethernet_ip, address: 192.168.0.100}}]", "smallest.yaml");
  EXPECT_EQ(letters(smallest.warnings), "");
  ASSERT_TRUE(reference && smallest.config);
  ASSERT_EQ(reference->robots.size(), 2U);
  const RobotConfig &a = reference->robots[1], &b = smallest.config->robots[0];
  EXPECT_EQ(a.cycle, b.cycle);
  EXPECT_EQ(a.ethernet_ip.address, b.ethernet_ip.address);
  EXPECT_EQ(a.ethernet_ip.tcp_port, b.ethernet_ip.tcp_port);
  EXPECT_EQ(a.ethernet_ip.rpi, b.ethernet_ip.rpi);
  EXPECT_EQ(a.ethernet_ip.timeout_multiplier, b.ethernet_ip.timeout_multiplier);
  EXPECT_EQ(a.ethernet_ip.multicast, b.ethernet_ip.multicast);
  EXPECT_EQ(a.ethernet_ip.key, b.ethernet_ip.key);
  EXPECT_EQ(a.ethernet_ip.key_major, b.ethernet_ip.key_major);
  EXPECT_EQ(a.ethernet_ip.key_minor, b.ethernet_ip.key_minor);
  EXPECT_EQ(a.ethernet_ip.large_forward_open, b.ethernet_ip.large_forward_open);
  EXPECT_EQ(a.ethernet_ip.fast, b.ethernet_ip.fast);
}

// Robots alone on their interface, the first ones without a segment of its own in the file.
TEST(Reference, HasTheDefaultsOfEthercat) {
  std::string text = reference_with_all_transports();
  text.resize(text.find("  - name: arm5"));
  const auto reference = parse_config(text, "reference.yaml").config;
  const auto smallest =
      parse_config("robots: [{name: arm1, transport: {type: ethercat, interface: eth1}}]", "smallest.yaml").config;
  ASSERT_TRUE(reference && smallest);
  ASSERT_EQ(reference->robots.size(), 4U);
  const RobotConfig &a = reference->robots[2], &b = smallest->robots[0];
  EXPECT_EQ(a.cycle, b.cycle);
  EXPECT_EQ(a.ethercat.interface, b.ethercat.interface);
  EXPECT_EQ(a.ethercat.position, b.ethercat.position);
  EXPECT_EQ(a.ethercat.alias, b.ethercat.alias);
  EXPECT_EQ(reference->robots[3].ethercat.alias, 12);
  ASSERT_EQ(reference->ethercat.size(), 1U);
  ASSERT_EQ(smallest->ethercat.size(), 1U);
  const EthercatSegmentConfig &c = reference->ethercat[0], &d = smallest->ethercat[0];
  EXPECT_EQ(c.interface, d.interface);
  EXPECT_EQ(d.redundant_interface, "");  // the only one that is written away from its default
  EXPECT_EQ(c.redundant_interface, "eth2");
  EXPECT_EQ(c.dc, d.dc);
  EXPECT_EQ(c.dc_shift, d.dc_shift);
  EXPECT_EQ(c.watchdog, d.watchdog);
  EXPECT_EQ(c.separate, d.separate);
}

TEST(Reference, GivesTheSameConfigurationAsTheSmallestFile) {
  const auto reference = load_config(kConfig / "reference.yaml").config;
  const auto smallest = parse_config("robots: [{name: arm1, transport: {type: builtin}}]", "smallest.yaml").config;
  ASSERT_TRUE(reference && smallest);
  EXPECT_EQ(reference->dds.domain, smallest->dds.domain);
  EXPECT_EQ(reference->dds.participant_name, smallest->dds.participant_name);
  EXPECT_EQ(reference->dds.topic_prefix, smallest->dds.topic_prefix);
  EXPECT_EQ(reference->dds.interfaces, smallest->dds.interfaces);
  EXPECT_EQ(reference->dds.shared_memory, smallest->dds.shared_memory);
  ASSERT_EQ(reference->dds.topics.size(), smallest->dds.topics.size());
  for (const auto& [name, topic] : reference->dds.topics) {
    EXPECT_TRUE(same(topic, smallest->dds.topics.at(name))) << name << ": " << to_string(topic);
  }
  EXPECT_EQ(reference->log.level, smallest->log.level);
  EXPECT_EQ(reference->realtime.priority, smallest->realtime.priority);
  EXPECT_EQ(reference->realtime.lock_memory, smallest->realtime.lock_memory);
  EXPECT_EQ(reference->realtime.cpus, smallest->realtime.cpus);
  EXPECT_EQ(reference->ethernet_ip.bind, smallest->ethernet_ip.bind);
  EXPECT_EQ(reference->ethernet_ip.io_port, smallest->ethernet_ip.io_port);
  EXPECT_EQ(reference->ethernet_ip.vendor_id, smallest->ethernet_ip.vendor_id);
  EXPECT_EQ(reference->ethernet_ip.serial_number, smallest->ethernet_ip.serial_number);
  const RobotConfig &a = reference->robots.at(0), &b = smallest->robots.at(0);
  EXPECT_EQ(a.builtin.product, b.builtin.product);
  EXPECT_EQ(a.builtin.firmware, b.builtin.firmware);
  EXPECT_EQ(a.builtin.serial_number, b.builtin.serial_number);
  EXPECT_EQ(a.builtin.instant_homing, b.builtin.instant_homing);
  EXPECT_EQ(a.builtin.noise, b.builtin.noise);
  EXPECT_EQ(a.builtin.tool, b.builtin.tool);
  EXPECT_EQ(a.builtin.control_socket, b.builtin.control_socket);
  EXPECT_EQ(a.cycle, b.cycle);
  EXPECT_EQ(a.firmware, b.firmware);
  EXPECT_EQ(a.dynamic_data, b.dynamic_data);
  EXPECT_EQ(a.control.enabled, b.control.enabled);
  EXPECT_EQ(a.control.lease, b.control.lease);
  EXPECT_EQ(a.control.velocity_lease, b.control.velocity_lease);
  EXPECT_EQ(a.control.allow_brakes, b.control.allow_brakes);
  EXPECT_EQ(a.control.clients.on_loss, b.control.clients.on_loss);
  EXPECT_EQ(a.control.clients.take_over_grace, b.control.clients.take_over_grace);
  EXPECT_EQ(a.control.clients.count, b.control.clients.count);
}

TEST(SmallestFile, HasTheDefaultsOfTheTopicTable) {
  const auto config = parse_config("robots: [{name: arm1, transport: {type: builtin}}]", "smallest.yaml").config;
  ASSERT_TRUE(config.has_value());
  for (const TopicInfo& info : kTopics) {
    const auto topic = config->dds.topics.find(std::string(info.name));
    ASSERT_EQ(topic != config->dds.topics.end(), info.direction == Direction::kPublished) << info.name;
    if (info.direction == Direction::kPublished) {
      EXPECT_TRUE(same(topic->second, info.defaults)) << info.name;
    }
  }
}

// Every value away from its default, so that none is read into the wrong place or not at all.
TEST(ParseConfig, ReadsEveryKey) {
  const ConfigResult result = parse_config(R"(
dds:
  domain: 232
  participant_name: "Halle 3: Zelle 7"
  topic_prefix: hall3/cell7/
  interfaces: [192.168.0.10, 127.0.0.1]
  shared_memory: true
  topics:
    RobotStatus: {rate: every_cycle, reliability: best_effort, durability: volatile, depth: 7}
    MotionStatus: {rate: 250Hz}
    CyclicState: {rate: every_cycle}
    TargetWrf: {rate: off}
    TargetJointSet: {rate: on_change}
    BridgeStatus: {rate: 0.5 s}
    CommandReceipt: {depth: 10000}
log: {level: trace}
realtime: {priority: 80, lock_memory: true, cpus: [2, 3]}
ethernet_ip: {bind: 0.0.0.0, io_port: 2223, vendor_id: 4660, serial_number: 4294967295}
ethercat:
  segments:
    - {interface: eth1, dc: true, dc_shift: 250us, watchdog: 50ms, separate: true}
    - {interface: eth3, redundant_interface: eth2}
robots:
  - name: arm_1-A
    transport: {type: builtin, product: R3, firmware: 9.3, serial_number: 4294967295, instant_homing: true, noise: false,
                tool: MPM500, control_socket: /run/arm.sock}
    cycle: 500us
    firmware: 11.3.3.12637
    dynamic_data: [40, auto, 10000]
    control:
      enabled: false
      lease: 2s
      velocity_lease: 1500us
      allow_brakes: true
      on_loss: finish
      take_over_grace: 0s
      clients: [{name: "Zelle 7", priority: 100, on_loss: stop}, {name: meca-ctl@*, priority: 1}, {name: "*"}]
  - {name: "2", transport: {type: builtin}, cycle: 10 ms, firmware: auto}
  - name: "3"
    transport: {type: ethernet_ip, address: robot3.cell, tcp_port: 44819, rpi: 7.5ms, timeout_multiplier: 64,
                multicast: true, key: exact, key_revision: "10.2", large_forward_open: true, fast: true}
    cycle: 5ms
  - {name: "4", transport: {type: ethercat, interface: eth3, position: 63}, cycle: 20ms}
  - {name: "5", transport: {type: ethercat, interface: eth1, alias: 65535}, cycle: 2ms}
)",
                                           "all.yaml");
  ASSERT_EQ(letters(result.errors), "");
  EXPECT_EQ(letters(result.warnings), "");
  const Config& c = *result.config;
  EXPECT_EQ(c.dds.domain, 232);
  EXPECT_EQ(c.dds.participant_name, "Halle 3: Zelle 7");
  EXPECT_EQ(c.dds.topic_prefix, "hall3/cell7/");
  EXPECT_EQ(c.dds.interfaces, (std::vector<std::string>{"192.168.0.10", "127.0.0.1"}));
  EXPECT_TRUE(c.dds.shared_memory);
  EXPECT_EQ(to_string(c.dds.topics.at("RobotStatus")), "every cycle, best_effort, volatile, depth 7");
  EXPECT_EQ(to_string(c.dds.topics.at("MotionStatus")), "every 4ms, reliable, transient_local, depth 1");
  EXPECT_EQ(to_string(c.dds.topics.at("CyclicState")), "every cycle, reliable, transient_local, depth 1");
  EXPECT_EQ(to_string(c.dds.topics.at("TargetWrf")), "off, reliable, transient_local, depth 1");
  EXPECT_EQ(to_string(c.dds.topics.at("TargetJointSet")), "on change, reliable, transient_local, depth 1");
  EXPECT_EQ(c.dds.topics.at("BridgeStatus").period, 500ms);
  EXPECT_EQ(c.dds.topics.at("CommandReceipt").depth, 10000);
  EXPECT_EQ(c.log.level, "trace");
  EXPECT_EQ(c.realtime.priority, 80);
  EXPECT_TRUE(c.realtime.lock_memory);
  EXPECT_EQ(c.realtime.cpus, (std::vector<int>{2, 3}));
  EXPECT_EQ(c.ethernet_ip.bind, "0.0.0.0");
  EXPECT_EQ(c.ethernet_ip.io_port, 2223);
  EXPECT_EQ(c.ethernet_ip.vendor_id, 4660);
  EXPECT_EQ(c.ethernet_ip.serial_number, 4294967295U);
  ASSERT_EQ(c.robots.size(), 5U);
  const EthernetIpConfig& e = c.robots[2].ethernet_ip;
  EXPECT_EQ(c.robots[2].type, TransportType::kEthernetIp);
  EXPECT_EQ(e.address, "robot3.cell");
  EXPECT_EQ(e.tcp_port, 44819);
  EXPECT_EQ(e.rpi, 7500us);
  EXPECT_EQ(e.timeout_multiplier, 64U);
  EXPECT_TRUE(e.multicast);
  EXPECT_EQ(e.key, meca::ethernet_ip::KeyPolicy::kExact);
  EXPECT_EQ(e.key_major, 10);
  EXPECT_EQ(e.key_minor, 2);
  EXPECT_TRUE(e.large_forward_open);
  EXPECT_TRUE(e.fast);
  EXPECT_EQ(c.robots[3].type, TransportType::kEthercat);
  EXPECT_EQ(c.robots[3].cycle, 20ms);
  EXPECT_EQ(c.robots[3].ethercat.interface, "eth3");
  EXPECT_EQ(c.robots[3].ethercat.position, 63);
  EXPECT_EQ(c.robots[3].ethercat.alias, std::nullopt);
  EXPECT_EQ(c.robots[4].ethercat.alias, 65535);
  ASSERT_EQ(c.ethercat.size(), 2U);
  EXPECT_EQ(c.ethercat[0].interface, "eth3");  // as the robots name them
  EXPECT_EQ(c.ethercat[0].watchdog, 100ms);
  EXPECT_EQ(c.ethercat[0].redundant_interface, "eth2");
  EXPECT_EQ(c.ethercat[1].interface, "eth1");
  EXPECT_TRUE(c.ethercat[1].dc);
  EXPECT_EQ(c.ethercat[1].dc_shift, 250us);
  EXPECT_EQ(c.ethercat[1].watchdog, 50ms);
  EXPECT_TRUE(c.ethercat[1].separate);
  const RobotConfig& r = c.robots[0];
  EXPECT_EQ(r.name, "arm_1-A");
  EXPECT_EQ(r.builtin.product, "R3");
  EXPECT_EQ(r.builtin.firmware, "9.3");
  EXPECT_EQ(r.builtin.serial_number, 4294967295U);
  EXPECT_TRUE(r.builtin.instant_homing);
  EXPECT_FALSE(r.builtin.noise);
  EXPECT_EQ(r.builtin.tool, "MPM500");
  EXPECT_EQ(r.builtin.control_socket, "/run/arm.sock");
  EXPECT_EQ(r.cycle, 500us);
  EXPECT_EQ(r.firmware, (meca::transports::FirmwareVersion{11, 3, 3, 12637}));
  EXPECT_EQ(r.dynamic_data, (std::array<std::uint32_t, 4>{40, 0, 10000, 0}));
  EXPECT_FALSE(r.control.enabled);
  EXPECT_EQ(r.control.lease, 2s);
  EXPECT_EQ(r.control.velocity_lease, 1500us);
  EXPECT_TRUE(r.control.allow_brakes);
  const control::ClientRules& rules = r.control.clients;
  EXPECT_EQ(rules.on_loss, control::LossRule::kFinish);
  EXPECT_EQ(rules.take_over_grace, 0ns);
  ASSERT_EQ(rules.count, 3U);
  EXPECT_EQ(rules.clients[0].name.view(), "Zelle 7");
  EXPECT_FALSE(rules.clients[0].beginning);
  EXPECT_EQ(rules.clients[0].priority, 100U);
  EXPECT_EQ(rules.clients[0].on_loss, control::LossRule::kStop);
  EXPECT_EQ(rules.clients[1].name.view(), "meca-ctl@");
  EXPECT_TRUE(rules.clients[1].beginning);
  EXPECT_EQ(rules.clients[1].priority, 1U);
  EXPECT_FALSE(rules.clients[1].on_loss.has_value());
  EXPECT_TRUE(rules.clients[2].beginning);
  EXPECT_EQ(c.robots[1].name, "2");
  EXPECT_EQ(c.robots[1].cycle, 10ms);
  EXPECT_EQ(c.robots[1].firmware, meca::transports::FirmwareVersion{});
}

TEST(ParseConfig, TakesALongCycleWithoutAWordAboutLeases) {
  const ConfigResult result = parse_config(R"(robots:
  - {name: shortest, transport: {type: ethercat, interface: eth1}}
  - {name: ethercat, transport: {type: ethercat, interface: eth2}, cycle: 20ms}
  - {name: ethernet_ip, transport: {type: ethernet_ip, address: robot3}, cycle: 50ms}
  - {name: longest, transport: {type: builtin}, cycle: 1s}
  - {name: one_key, transport: {type: builtin}, cycle: 50ms, control: {lease: 2s}}
)",
                                           "long.yaml");
  ASSERT_EQ(letters(result.errors), "");
  std::string leases;
  for (const RobotConfig& robot : result.config->robots) {
    leases += robot.name + " " + to_string(robot.control.lease) + " " + to_string(robot.control.velocity_lease) + "\n";
  }
  EXPECT_EQ(leases,
            "shortest 100ms 50ms\n"
            "ethercat 100ms 60ms\n"
            "ethernet_ip 150ms 150ms\n"
            "longest 3s 3s\n"
            "one_key 2s 150ms\n");
}

TEST(ParseConfig, WarnsOfWhatRunsButNotAsMeant) {
  const ConfigResult result = parse_config(R"(dds:
  topics:
    TargetJointSet: {rate: 1ms}
    DynamicData: {reliability: best_effort, durability: transient_local}
    RobotStatus: {reliability: best_effort, durability: volatile}
robots: [{name: arm1, transport: {type: builtin}, cycle: 4ms}]
)",
                                           "odd.yaml");
  ASSERT_TRUE(result.config.has_value());
  EXPECT_EQ(letters(result.warnings),
            "odd.yaml:3:28: dds.topics.TargetJointSet.rate: 1ms is shorter than the shortest cycle, 4ms of 'arm1'; it "
            "will be published once a cycle\n"
            "odd.yaml:4:57: dds.topics.DynamicData.durability: best_effort writers keep nothing for late joiners; make "
            "the topic reliable as well\n");
}

TEST(ParseConfig, WarnsOfWatchdogsThatAreTooNervousOrTooLazyAndOfAKeyWithoutUse) {
  const ConfigResult result = parse_config(R"(robots:
  - {name: arm1, transport: {type: ethernet_ip, address: robot1, timeout_multiplier: 4}}
  - {name: arm2, transport: {type: ethernet_ip, address: robot2, rpi: 1s}}
  - {name: arm3, transport: {type: ethernet_ip, address: robot3, key_revision: "11.3"}}
)",
                                           "odd.yaml");
  ASSERT_TRUE(result.config.has_value());
  EXPECT_EQ(letters(result.warnings),
            "odd.yaml:2:86: robots[0].transport.timeout_multiplier: 4 x 10ms = 40ms: a few late packets end the "
            "connection; from 80ms on it suits a system that is not real-time\n"
            "odd.yaml:3:71: robots[1].transport.rpi: 16 x 1s = 16s: the robot notices only then that the bridge is "
            "gone; 5s or less is better\n"
            "odd.yaml:4:80: robots[2].transport.key_revision: is not used without a key; write 'key: compatible' or "
            "'key: exact' as well\n");
}

TEST(ParseConfig, WarnsOfEthercatSegmentsThatNobodyUsesAndOfWhatDoesNothing) {
  const ConfigResult result = parse_config(R"(ethercat:
  segments:
    - {interface: eth1, watchdog: 10ms, dc_shift: 1us}
    - {interface: eth2}
    - {interface: eth3, watchdog: 6s}
robots:
  - {name: arm1, transport: {type: ethercat, interface: eth1}}
  - {name: arm3, transport: {type: ethercat, interface: eth3}}
)",
                                           "odd.yaml");
  ASSERT_TRUE(result.config.has_value());
  EXPECT_EQ(
      letters(result.warnings),
      "odd.yaml:3:35: ethercat.segments[0].watchdog: 10ms: one hiccup of this machine stops the robots; from 40ms "
      "on it suits a system that is not real-time\n"
      "odd.yaml:3:51: ethercat.segments[0].dc_shift: is not used without distributed clocks; write 'dc: true' as "
      "well\n"
      "odd.yaml:4:19: ethercat.segments[1].interface: no robot names 'eth2'; the segment is not opened\n"
      "odd.yaml:5:35: ethercat.segments[2].watchdog: 6s: the robot notices only then that the bridge is gone; 5s "
      "or less is better\n");
}

}  // namespace
