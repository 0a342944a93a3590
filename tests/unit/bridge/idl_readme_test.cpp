// idl/README.md holds the table of topics, printed from bridge/topics.hpp: MECA_UPDATE=1 writes it anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "bridge/topics.hpp"

namespace meca::bridge {
namespace {

constexpr const char* kBegin = "<!-- topics: printed from bridge/topics.hpp, do not edit -->\n";
constexpr const char* kEnd = "<!-- end of topics -->\n";

std::string rate_of(const TopicInfo& topic) {
  if (topic.direction == Direction::kSubscribed) return "as clients send";
  if (topic.name == "CommandReceipt") return "every receipt";
  switch (topic.defaults.rate) {
    case RateKind::kOff:
      return "off";
    case RateKind::kEveryCycle:
      return "every cycle";
    case RateKind::kOnChange:
      return "on change";
    case RateKind::kPeriod:
      return "every " + std::to_string(topic.defaults.period / std::chrono::milliseconds(1)) + " ms";
  }
  return "";
}

std::string qos_of(const TopicConfig& config) {
  std::string text = config.reliable ? "reliable" : "best effort";
  text += config.transient_local ? ", transient local" : ", volatile";
  return text + (config.depth > 0 ? ", keep last " + std::to_string(config.depth) : ", keep all");
}

std::string table() {
  std::string text =
      "| Topic | Type | Direction | Default rate | QoS | What it says |\n"
      "|---|---|---|---|---|---|\n";
  for (const auto& topic : kTopics) {
    const std::string name(topic.name);
    text += "| `meca500/" + name + "` | `meca500::" + name + "` | ";
    text += topic.direction == Direction::kPublished ? "bridge -> clients" : "clients -> bridge";
    text +=
        " | " + rate_of(topic) + (topic.rate_configurable ? "" : " (fixed)") + " | " + qos_of(topic.defaults) + " | ";
    text += std::string(topic.about) + " |\n";
  }
  return text;
}

TEST(IdlReadme, ItsTableIsThatOfTheTopicList) {
  const std::string path = std::string(MECA_SOURCE_DIR) + "/idl/README.md";
  std::ifstream in(path);
  ASSERT_TRUE(in) << path;
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto begin = text.find(kBegin);
  const auto end = text.find(kEnd);
  ASSERT_NE(begin, std::string::npos) << "no mark: " << kBegin;
  ASSERT_NE(end, std::string::npos) << "no mark: " << kEnd;
  const auto start = begin + std::string(kBegin).size();
  if (std::getenv("MECA_UPDATE") != nullptr) {
    std::ofstream(path) << text.substr(0, start) << table() << text.substr(end);
    return;
  }
  EXPECT_EQ(text.substr(start, end - start), table()) << "MECA_UPDATE=1 writes it anew";
}

}  // namespace
}  // namespace meca::bridge
