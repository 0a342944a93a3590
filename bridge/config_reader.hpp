// Reads one section (a YAML map) key by key, checks each value and collects every mistake with its place.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridge/config.hpp"
#include "bridge/config_yaml.hpp"

namespace meca::bridge {

class Report {
 public:
  explicit Report(std::string file) : file_(std::move(file)) {}
  void error(yaml::Mark mark, std::string key, std::string message);
  void warning(yaml::Mark mark, std::string key, std::string message);
  // What is not what it should be: "found 'abc'; expected <expected>".
  void unexpected(const yaml::Node& node, std::string key, std::string_view expected);
  // In file order; a result with errors holds no configuration.
  ConfigResult result(Config config) &&;

 private:
  std::string file_;
  std::vector<ConfigError> errors_, warnings_;
};

std::string describe(const yaml::Node& node);  // "'abc'", "a list", "a map", "nothing"

class Section {
 public:
  // `node` nullptr or null: an empty section. `kind` is the section's name in config_keys.hpp; unknown and repeated
  // keys are reported here. `transport_type` narrows the keys of "robots[].transport"; empty = those of all types.
  Section(const yaml::Node* node, yaml::Mark mark, std::string path, std::string_view kind, Report& report,
          std::string_view transport_type = {});

  const yaml::Node* find(std::string_view key) const;  // nullptr when it is not given
  // The place of the value, or of the section when the key is not given.
  yaml::Mark mark(std::string_view key) const;
  std::string path(std::string_view key) const;  // "robots[0].name"
  Report& report() const { return report_; }
  void require(std::string_view key, std::string_view example) const;  // reports when missing
  Section child(std::string_view key, std::string_view kind, std::string_view transport_type = {}) const;

  // Each leaves `out` alone when the key is not given or wrong; true when it was given and right.
  bool text(std::string_view key, std::string_view expected, bool (*valid)(std::string_view), std::string& out) const;
  bool flag(std::string_view key, bool& out) const;
  bool duration(std::string_view key, std::chrono::nanoseconds minimum, std::chrono::nanoseconds maximum,
                std::chrono::nanoseconds& out) const;
  template <typename Integer>
  bool integer(std::string_view key, std::int64_t minimum, std::int64_t maximum, Integer& out) const {
    std::int64_t value = 0;
    if (!integer_value(key, minimum, maximum, value)) return false;
    out = static_cast<Integer>(value);
    return true;
  }
  // One of `words`; `out` is its index.
  bool choice(std::string_view key, std::span<const std::string_view> words, std::size_t& out) const;
  // The elements of a list; reported and empty when it is none or has more than `longest`.
  std::span<const yaml::Node> list(std::string_view key, std::size_t longest, std::string_view expected) const;

 private:
  bool integer_value(std::string_view key, std::int64_t minimum, std::int64_t maximum, std::int64_t& out) const;
  void check_keys(std::string_view kind, std::string_view transport_type);

  const yaml::Node* node_;  // a map, or nullptr
  yaml::Mark mark_;
  std::string path_;
  Report& report_;
  std::vector<std::string_view> suggested_;  // keys that a misspelt one was probably meant to be
};

// "unknown key, did you mean 'x'?" and its relatives, for maps whose keys are not in config_keys.hpp.
std::string unknown(std::string_view what, std::string_view text, std::span<const std::string_view> known);

}  // namespace meca::bridge
