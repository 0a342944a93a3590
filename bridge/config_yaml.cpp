#include "bridge/config_yaml.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <sstream>

namespace meca::bridge::yaml {
namespace {

constexpr std::size_t kMaxNodes = 50'000;  // far above any cell; keeps a hostile file from eating the memory

std::string hex(unsigned value) {
  std::array<char, 8> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "0x%02X", value);
  return buffer.data();
}

// Bytes of the UTF-8 sequence at the start of `rest`; 0 when it is none (RFC 3629: no overlong forms, no surrogates).
std::size_t utf8_length(std::string_view rest) {
  const auto byte = [&](std::size_t i) -> unsigned {
    return i < rest.size() ? static_cast<unsigned char>(rest[i]) : 0U;
  };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    if (!follows(1) || !follows(2)) return 0;
    return (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ? 0 : 3;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    if (!follows(1) || !follows(2) || !follows(3)) return 0;
    return (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F) ? 0 : 4;
  }
  return 0;
}

// What YAML would take or stumble over, in words that help more than YAML's own. The first bad byte ends the search:
// behind it nothing can be trusted.
std::vector<Problem> check_bytes(std::string_view text) {
  std::vector<Problem> problems;
  Mark mark{1, 1};
  bool indentation = true, tab_seen = false;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    const auto byte = static_cast<unsigned char>(text[i]);
    if (length == 0) {
      problems.push_back({mark, "byte " + hex(byte) + " is not UTF-8; save the file as UTF-8"});
      return problems;
    }
    if ((byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t') || byte == 0x7F) {
      problems.push_back({mark, "control character " + hex(byte) + " has no place here; delete it"});
      return problems;
    }
    if (indentation && byte == '\t' && !tab_seen) {
      problems.push_back({mark, "a tab as indentation, which YAML does not know; use spaces"});
      tab_seen = true;  // one letter per line
    }
    if (byte == '\n') {
      mark = {mark.line + 1, 1};
      indentation = true;
      tab_seen = false;
    } else {
      if (byte != ' ' && byte != '\t') indentation = false;
      mark.column += static_cast<int>(length);
    }
    i += length;
  }
  return problems;
}

Mark from(const YAML::Mark& mark) {
  if (mark.line < 0) return {1, 1};
  return {mark.line + 1, mark.column + 1};
}

// yaml-cpp's words for what people do most often, explained.
std::string explained(const std::string& message) {
  struct Explanation {
    std::string_view message, meaning;
  };
  static constexpr std::array kExplanations{
      Explanation{"illegal map value", "a ':' too many here, or one missing in the line above"},
      Explanation{"end of map not found", "the indentation does not fit the lines above, or a ':' is missing"},
      Explanation{"end of sequence not found", "the indentation does not fit the lines above"},
      Explanation{"end of map flow not found", "a '{' before this is not closed, or a ',' is missing"},
      Explanation{"end of sequence flow not found", "a '[' before this is not closed, or a ',' is missing"},
      Explanation{"unknown token", "this character has a meaning in YAML; put the text in quotes"},
      Explanation{"illegal EOF in scalar", "a quote is not closed"},
  };
  for (const Explanation& known : kExplanations) {
    if (known.message == message) return "not YAML: " + std::string(known.meaning);
  }
  return "not YAML: " + message;
}

struct Refused {
  Problem problem;
};

class Builder final : public YAML::EventHandler {
 public:
  std::optional<Node> take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(Kind::kNull, mark, anchor, {}); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { refuse_anchor(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string& value) override {
    add(Kind::kScalar, mark, anchor, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    add(Kind::kSequence, mark, anchor, {});
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    add(Kind::kMap, mark, anchor, {});
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  [[noreturn]] static void refuse_anchor(const YAML::Mark& mark) {
    throw Refused{{from(mark), "anchors and aliases (&name, *name) are not supported; write the value out"}};
  }

  // A value whose container grows may move, so containers are remembered as a path of indices from the root.
  struct Open {
    bool in_keys;
    std::size_t index;
  };

  Node& innermost() {
    Node* node = &*root_;
    for (std::size_t i = 1; i < open_.size(); ++i)
      node = &(open_[i].in_keys ? node->keys : node->values)[open_[i].index];
    return *node;
  }

  void add(Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor, const std::string& text) {
    if (anchor != 0) refuse_anchor(mark);
    if (++nodes_ > kMaxNodes) throw Refused{{from(mark), "more than 50000 values; this is no configuration"}};
    Node node{kind, from(mark), text, {}, {}};
    const bool container = kind == Kind::kSequence || kind == Kind::kMap;
    if (!root_) {
      root_ = std::move(node);
      if (container) open_.push_back({false, 0});
      return;
    }
    Node& parent = innermost();
    const bool as_key = parent.kind == Kind::kMap && parent.keys.size() == parent.values.size();
    std::vector<Node>& list = as_key ? parent.keys : parent.values;
    // yaml-cpp places a value that is not there at whatever comes next; people look at the key.
    if (kind == Kind::kNull && !parent.keys.empty() && !as_key) node.mark = parent.keys.back().mark;
    list.push_back(std::move(node));
    if (container) open_.push_back({as_key, list.size() - 1});
  }

  std::optional<Node> root_;
  std::vector<Open> open_;
  std::size_t nodes_ = 0;
};

}  // namespace

Document parse(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark of UTF-8: harmless
  Document document;
  document.problems = check_bytes(text);
  if (!document.problems.empty()) return document;
  Builder builder;
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    Builder second;
    if (parser.HandleNextDocument(second)) {
      const std::optional<Node> node = second.take();
      document.problems.push_back(
          {node ? node->mark : Mark{1, 1}, "a second YAML document ('---'); one file is one configuration"});
    }
  } catch (const Refused& refused) {
    document.problems.push_back(refused.problem);
  } catch (const YAML::Exception& error) {
    document.problems.push_back({from(error.mark), explained(error.msg)});
  } catch (const std::exception& error) {  // out of memory and the like
    document.problems.push_back({{1, 1}, std::string("cannot be read as YAML: ") + error.what()});
  }
  if (document.problems.empty()) document.root = builder.take();
  return document;
}

}  // namespace meca::bridge::yaml
