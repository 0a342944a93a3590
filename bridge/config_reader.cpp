#include "bridge/config_reader.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>

#include "bridge/config_keys.hpp"
#include "bridge/config_values.hpp"

namespace meca::bridge {
namespace {

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string out = "'";
  for (const char c : text.substr(0, kLongest)) out += c == '\n' || c == '\t' || c == '\r' ? ' ' : c;
  // A character cut in half would make the letter unreadable for the terminal.
  if (text.size() > kLongest) {
    while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0x80U) != 0) out.pop_back();
    out += "...";
  }
  return out + "'";
}

std::string joined(std::span<const std::string_view> words) {
  std::string out;
  for (const std::string_view word : words) {
    if (!out.empty()) out += ", ";
    out += word;
  }
  return out;
}

std::vector<std::string_view> keys_of(std::string_view kind, std::string_view transport_type) {
  std::vector<std::string_view> names;
  for (const config_keys::Key& key : config_keys::kKeys) {
    const bool of_type = key.transport_type.empty() || transport_type.empty() || key.transport_type == transport_type;
    const bool repeated = std::find(names.begin(), names.end(), key.name) != names.end();
    if (key.section == kind && of_type && !repeated) names.push_back(key.name);
  }
  return names;
}

// Where a key that is wrong in `kind` is right. Empty when it is known nowhere.
std::string elsewhere(std::string_view name, std::string_view kind) {
  for (const config_keys::Key& key : config_keys::kKeys) {
    if (key.name != name) continue;
    if (key.section == kind) return "belongs to transports of type " + std::string(key.transport_type);
    return key.section.empty() ? "belongs to the top of the file" : "belongs under " + std::string(key.section);
  }
  return {};
}

// A slip in a key of this section, then a key of another section, then a slip in one of those, then the whole list.
std::string unknown_key(std::string_view name, std::string_view kind, std::span<const std::string_view> known) {
  std::vector<std::string_view> all;
  for (const config_keys::Key& key : config_keys::kKeys) all.push_back(key.name);
  const bool slip_here = !config_values::nearest(name, known).empty();
  const std::string other = elsewhere(name, kind);
  if (!other.empty() && !slip_here) return "unknown key here; it " + other;
  const std::string_view near = slip_here ? std::string_view{} : config_values::nearest(name, all);
  if (near.empty()) return unknown("key", name, known);
  return "unknown key; '" + std::string(near) + "' " + elsewhere(near, kind) + "; known here: " + joined(known);
}

std::vector<ConfigError> sorted(std::vector<ConfigError> list) {
  std::stable_sort(list.begin(), list.end(), [](const ConfigError& a, const ConfigError& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
  const auto same = [](const ConfigError& a, const ConfigError& b) {
    return a.line == b.line && a.column == b.column && a.key == b.key;
  };
  list.erase(std::unique(list.begin(), list.end(), same), list.end());  // one letter per value
  return list;
}

}  // namespace

void Report::error(yaml::Mark mark, std::string key, std::string message) {
  errors_.push_back({file_, mark.line, mark.column, std::move(key), std::move(message)});
}

void Report::warning(yaml::Mark mark, std::string key, std::string message) {
  warnings_.push_back({file_, mark.line, mark.column, std::move(key), std::move(message)});
}

void Report::unexpected(const yaml::Node& node, std::string key, std::string_view expected) {
  error(node.mark, std::move(key), "found " + describe(node) + "; expected " + std::string(expected));
}

ConfigResult Report::result(Config config) && {
  ConfigResult result;
  result.errors = sorted(std::move(errors_));
  result.warnings = sorted(std::move(warnings_));
  if (result.errors.empty()) result.config = std::move(config);
  return result;
}

std::string describe(const yaml::Node& node) {
  switch (node.kind) {
    case yaml::Kind::kNull:
      return "nothing";
    case yaml::Kind::kScalar:
      return in_quotes(node.text);
    case yaml::Kind::kSequence:
      return "a list";
    case yaml::Kind::kMap:
      return "a map (key: value)";
  }
  return {};
}

std::string unknown(std::string_view what, std::string_view text, std::span<const std::string_view> known) {
  const std::string_view best = config_values::nearest(text, known);
  if (!best.empty()) return "unknown " + std::string(what) + ", did you mean '" + std::string(best) + "'?";
  return "unknown " + std::string(what) + "; known here: " + joined(known);
}

Section::Section(const yaml::Node* node, yaml::Mark mark, std::string path, std::string_view kind, Report& report,
                 std::string_view transport_type)
    : node_(nullptr), mark_(mark), path_(std::move(path)), report_(report) {
  if (node == nullptr) return;
  mark_ = node->mark;
  if (node->kind == yaml::Kind::kMap) {
    node_ = node;
    check_keys(kind, transport_type);
  } else if (node->kind != yaml::Kind::kNull) {
    const std::vector<std::string_view> keys = keys_of(kind, transport_type);
    report_.unexpected(*node, path_, keys.empty() ? "a map (key: value)" : "a map with the keys " + joined(keys));
  }
}

void Section::check_keys(std::string_view kind, std::string_view transport_type) {
  const std::vector<std::string_view> known = keys_of(kind, transport_type);
  std::unordered_map<std::string_view, int> first_line;
  for (const yaml::Node& key : node_->keys) {
    if (key.kind != yaml::Kind::kScalar) {
      report_.error(key.mark, path_, "found " + describe(key) + " as a key; expected one of " + joined(known));
      continue;
    }
    const auto [first, is_first] = first_line.try_emplace(key.text, key.mark.line);
    if (!is_first) {
      report_.error(key.mark, path(key.text),
                    "given twice, first in line " + std::to_string(first->second) + "; keep one of them");
    } else if (kind != "dds.topics" && std::find(known.begin(), known.end(), key.text) == known.end()) {
      const std::string_view best = config_values::nearest(key.text, known);
      if (!best.empty()) suggested_.push_back(best);
      report_.error(key.mark, path(key.text), unknown_key(key.text, kind, known));
    }
  }
}

const yaml::Node* Section::find(std::string_view key) const {
  if (node_ == nullptr) return nullptr;
  for (std::size_t i = 0; i < node_->keys.size() && i < node_->values.size(); ++i) {
    if (node_->keys[i].kind == yaml::Kind::kScalar && node_->keys[i].text == key) return &node_->values[i];
  }
  return nullptr;
}

yaml::Mark Section::mark(std::string_view key) const {
  const yaml::Node* node = find(key);
  return node == nullptr ? mark_ : node->mark;
}

std::string Section::path(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void Section::require(std::string_view key, std::string_view example) const {
  const bool misspelt = std::find(suggested_.begin(), suggested_.end(), key) != suggested_.end();
  if (find(key) != nullptr || misspelt) return;
  report_.error(mark_, path(key), "missing; write for example '" + std::string(example) + "'");
}

Section Section::child(std::string_view key, std::string_view kind, std::string_view transport_type) const {
  return Section(find(key), mark_, path(key), kind, report_, transport_type);
}

bool Section::text(std::string_view key, std::string_view expected, bool (*valid)(std::string_view),
                   std::string& out) const {
  const yaml::Node* node = find(key);
  if (node == nullptr) return false;
  if (node->kind != yaml::Kind::kScalar || !valid(node->text)) {
    report_.unexpected(*node, path(key), expected);
    return false;
  }
  out = node->text;
  return true;
}

bool Section::flag(std::string_view key, bool& out) const {
  const yaml::Node* node = find(key);
  if (node == nullptr) return false;
  const bool yes = node->kind == yaml::Kind::kScalar && node->text == "true";
  const bool no = node->kind == yaml::Kind::kScalar && node->text == "false";
  if (yes || no)
    out = yes;
  else
    report_.unexpected(*node, path(key), "true or false");
  return yes || no;
}

bool Section::duration(std::string_view key, std::chrono::nanoseconds minimum, std::chrono::nanoseconds maximum,
                       std::chrono::nanoseconds& out) const {
  const yaml::Node* node = find(key);
  if (node == nullptr) return false;
  const auto value = node->kind == yaml::Kind::kScalar ? config_values::duration(node->text) : std::nullopt;
  if (!value || *value < minimum || *value > maximum) {
    std::string expected = "a duration from " + to_string(minimum) + " to " + to_string(maximum);
    if (!value && node->kind == yaml::Kind::kScalar && config_values::duration(node->text + "ms")) {
      expected += " with its unit, for example " + node->text + "ms";
    }
    report_.unexpected(*node, path(key), expected);
    return false;
  }
  out = *value;
  return true;
}

bool Section::integer_value(std::string_view key, std::int64_t minimum, std::int64_t maximum, std::int64_t& out) const {
  const yaml::Node* node = find(key);
  if (node == nullptr) return false;
  const auto value = node->kind == yaml::Kind::kScalar ? config_values::integer(node->text) : std::nullopt;
  if (!value || *value < minimum || *value > maximum) {
    report_.unexpected(*node, path(key),
                       "a whole number from " + std::to_string(minimum) + " to " + std::to_string(maximum));
    return false;
  }
  out = *value;
  return true;
}

bool Section::choice(std::string_view key, std::span<const std::string_view> words, std::size_t& out) const {
  const yaml::Node* node = find(key);
  if (node == nullptr) return false;
  const auto word = std::find(words.begin(), words.end(), node->text);
  if (node->kind != yaml::Kind::kScalar || word == words.end()) {
    std::string expected = "one of " + joined(words);
    const std::string_view best = config_values::nearest(node->text, words);
    if (!best.empty()) expected += "; did you mean '" + std::string(best) + "'?";
    report_.unexpected(*node, path(key), expected);
    return false;
  }
  out = static_cast<std::size_t>(word - words.begin());
  return true;
}

std::span<const yaml::Node> Section::list(std::string_view key, std::size_t longest, std::string_view expected) const {
  const yaml::Node* node = find(key);
  if (node == nullptr) return {};
  if (node->kind != yaml::Kind::kSequence) {
    report_.unexpected(*node, path(key), expected);
    return {};
  }
  if (node->values.size() > longest) {
    report_.error(node->mark, path(key),
                  "found " + std::to_string(node->values.size()) + " elements; expected " + std::string(expected));
    return {};
  }
  return node->values;
}

}  // namespace meca::bridge
