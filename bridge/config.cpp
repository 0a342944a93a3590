#include "bridge/config.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "bridge/config_ethercat.hpp"
#include "bridge/config_ethernet_ip.hpp"
#include "bridge/config_reader.hpp"
#include "bridge/config_robots.hpp"
#include "bridge/config_values.hpp"
#include "bridge/topics.hpp"

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMaxFileSize = 1 << 20;  // bytes
constexpr std::string_view kSmallest = "robots: [{name: arm1, transport: {type: builtin}}]";

bool is_participant_name(std::string_view text) {
  return !text.empty() && text.size() <= 63 &&
         std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; });
}

// What all DDS vendors take in a topic name; the longest name behind the prefix has 24 characters.
bool is_topic_prefix(std::string_view text) {
  return text.size() <= 200 && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '/';
         });
}

void read_topic(const Section& topic, const TopicInfo& info, TopicConfig& out) {
  constexpr std::string_view kExpected =
      "every_cycle, on_change, off, a period from 500us to 1h (10ms) or a frequency (100Hz)";
  if (const yaml::Node* node = topic.find("rate")) {
    const auto rate = node->kind == yaml::Kind::kScalar ? config_values::rate(node->text) : std::nullopt;
    if (!info.rate_configurable) {
      topic.report().error(node->mark, topic.path("rate"), "the bridge decides when this topic has news; leave it out");
    } else if (!rate || (rate->kind == RateKind::kPeriod && (rate->period < 500us || rate->period > 1h))) {
      topic.report().unexpected(*node, topic.path("rate"), kExpected);
    } else {
      out.rate = rate->kind;
      out.period = rate->period;
    }
  }
  static constexpr std::array<std::string_view, 2> kReliabilities{"best_effort", "reliable"};
  static constexpr std::array<std::string_view, 2> kDurabilities{"volatile", "transient_local"};
  std::size_t index = 0;
  if (topic.choice("reliability", kReliabilities, index)) out.reliable = index == 1;
  const bool durability_given = topic.choice("durability", kDurabilities, index);
  if (durability_given) out.transient_local = index == 1;
  topic.integer("depth", 1, 10000, out.depth);
  if (!out.reliable && durability_given && out.transient_local) {
    topic.report().warning(topic.mark("durability"), topic.path("durability"),
                           "best_effort writers keep nothing for late joiners; make the topic reliable as well");
  }
}

// A period shorter than every cycle is not what happens: say so.
void warn_of_haste(const Section& topic, const TopicConfig& config, const std::vector<RobotConfig>& robots) {
  const auto fastest =
      std::min_element(robots.begin(), robots.end(), [](const auto& a, const auto& b) { return a.cycle < b.cycle; });
  if (fastest == robots.end() || config.rate != RateKind::kPeriod || config.period >= fastest->cycle) return;
  if (topic.find("rate") == nullptr) return;
  topic.report().warning(topic.mark("rate"), topic.path("rate"),
                         to_string(config.period) + " is shorter than the shortest cycle, " +
                             to_string(fastest->cycle) + " of '" + fastest->name +
                             "'; it will be published once a cycle");
}

void read_topics(const Section& dds, const std::vector<RobotConfig>& robots, std::map<std::string, TopicConfig>& out) {
  const Section topics = dds.child("topics", "dds.topics");
  std::vector<std::string_view> names;
  for (const TopicInfo& info : kTopics) {
    names.push_back(info.name);
    if (info.direction == Direction::kPublished) out[std::string(info.name)] = info.defaults;
  }
  const yaml::Node* node = dds.find("topics");
  if (node == nullptr || node->kind != yaml::Kind::kMap) return;
  for (const yaml::Node& key : node->keys) {
    if (key.kind != yaml::Kind::kScalar) continue;  // reported already
    const auto info = std::find_if(kTopics.begin(), kTopics.end(), [&](const auto& t) { return t.name == key.text; });
    if (info == kTopics.end()) {
      dds.report().error(key.mark, topics.path(key.text), unknown("topic", key.text, names));
    } else if (info->direction == Direction::kSubscribed) {
      dds.report().error(key.mark, topics.path(key.text),
                         "the bridge reads this topic and its QoS is part of the contract; leave it out");
    } else {
      const Section topic = topics.child(key.text, "dds.topics.*");
      read_topic(topic, *info, out[key.text]);
      warn_of_haste(topic, out[key.text], robots);
    }
  }
}

DdsConfig read_dds(const Section& root, const std::vector<RobotConfig>& robots) {
  DdsConfig config;
  const Section dds = root.child("dds", "dds");
  dds.integer("domain", 0, 232, config.domain);
  dds.text("participant_name", "1 to 63 characters, e.g. meca-bridge", is_participant_name, config.participant_name);
  dds.text("topic_prefix", "up to 200 of the characters A-Z a-z 0-9 _ /, e.g. meca500/", is_topic_prefix,
           config.topic_prefix);
  const auto interfaces = dds.list("interfaces", 64, "a list of up to 64 IPv4 addresses, e.g. [192.168.0.10]");
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    if (interfaces[i].kind == yaml::Kind::kScalar && config_values::is_ipv4(interfaces[i].text)) {
      config.interfaces.push_back(interfaces[i].text);
    } else {
      dds.report().unexpected(interfaces[i], dds.path("interfaces") + "[" + std::to_string(i) + "]",
                              "the IPv4 address of one of this machine's interfaces, e.g. 192.168.0.10");
    }
  }
  dds.flag("shared_memory", config.shared_memory);
  read_topics(dds, robots, config.topics);
  return config;
}

LogConfig read_log(const Section& root) {
  static constexpr std::array<std::string_view, 6> kLevels{"trace", "debug", "info", "warn", "error", "off"};
  LogConfig config;
  std::size_t level = 0;
  if (root.child("log", "log").choice("level", kLevels, level)) config.level = kLevels[level];
  return config;
}

RealtimeConfig read_realtime(const Section& root) {
  RealtimeConfig config;
  const Section realtime = root.child("realtime", "realtime");
  realtime.integer("priority", 0, 99, config.priority);
  realtime.flag("lock_memory", config.lock_memory);
  const auto cpus = realtime.list("cpus", 1024, "a list of CPU numbers, e.g. [2, 3]");
  for (std::size_t i = 0; i < cpus.size(); ++i) {
    const auto cpu = cpus[i].kind == yaml::Kind::kScalar ? config_values::integer(cpus[i].text) : std::nullopt;
    if (cpu && *cpu >= 0 && *cpu <= 1023) {
      config.cpus.push_back(static_cast<int>(*cpu));
    } else {
      realtime.report().unexpected(cpus[i], realtime.path("cpus") + "[" + std::to_string(i) + "]",
                                   "the number of a CPU from 0 to 1023");
    }
  }
  return config;
}

ConfigResult whole_file_error(const std::string& file, const std::string& message) {
  ConfigResult result;
  result.errors.push_back({file, 0, 0, "", message});
  return result;
}

}  // namespace

ConfigResult parse_config(std::string_view text, const std::string& file_name) {
  Report report(file_name);
  Config config;
  const yaml::Document document = yaml::parse(text);
  for (const yaml::Problem& problem : document.problems) report.error(problem.mark, "", problem.message);
  if (!document.problems.empty()) return std::move(report).result(std::move(config));
  if (!document.root || document.root->kind == yaml::Kind::kNull) {
    report.error({1, 1}, "", "the file is empty; the smallest configuration is: " + std::string(kSmallest));
    return std::move(report).result(std::move(config));
  }
  const Section root(&*document.root, {1, 1}, "", "", report);
  if (document.root->kind == yaml::Kind::kMap) {
    config.robots = read_robots(root);
    config.log = read_log(root);
    config.realtime = read_realtime(root);
    config.ethernet_ip = read_ethernet_ip_bus(root, config.robots);
    config.ethercat = read_ethercat_segments(root, config.robots);
    config.dds = read_dds(root, config.robots);
  }
  return std::move(report).result(std::move(config));
}

ConfigResult load_config(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    return whole_file_error(name, "is a folder; name the YAML file in it");
  }
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    return whole_file_error(name, std::string("cannot be read: ") + std::strerror(errno) +
                                      "; name an existing file with --config FILE, e.g. config/builtin.yaml");
  }
  std::string text(kMaxFileSize + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) return whole_file_error(name, "cannot be read to its end");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMaxFileSize) return whole_file_error(name, "is larger than 1 MiB; this is no configuration");
  return parse_config(text, name);
}

std::string to_string(const ConfigError& error) {
  std::string text = error.file;
  if (error.line > 0) text += ":" + std::to_string(error.line) + ":" + std::to_string(error.column);
  text += ": ";
  if (!error.key.empty()) text += error.key + ": ";
  return text + error.message;
}

std::string to_string(const TopicConfig& topic) {
  std::string text;
  switch (topic.rate) {
    case RateKind::kOff:
      text = "off";
      break;
    case RateKind::kEveryCycle:
      text = "every cycle";
      break;
    case RateKind::kOnChange:
      text = "on change";
      break;
    case RateKind::kPeriod:
      text = "every " + to_string(topic.period);
      break;
  }
  text += topic.reliable ? ", reliable" : ", best_effort";
  text += topic.transient_local ? ", transient_local" : ", volatile";
  return text + ", depth " + std::to_string(topic.depth);
}

}  // namespace meca::bridge
