// A YAML text as a tree that remembers where each value stands. config_yaml.cpp is the only file that sees yaml-cpp.
// Scalars stay text: what `off` or `1.0` means is decided by the key it belongs to, not by YAML's own guesses.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meca::bridge::yaml {

struct Mark {
  int line = 0, column = 0;  // from 1, column in bytes; 0 = the file as a whole
  friend auto operator<=>(const Mark&, const Mark&) = default;
};

enum class Kind : std::uint8_t { kNull, kScalar, kSequence, kMap };

struct Node {
  Kind kind = Kind::kNull;
  Mark mark;
  std::string text;          // kScalar
  std::vector<Node> keys;    // kMap, in file order, repeated keys included; any kind of node may stand as a key
  std::vector<Node> values;  // kMap: one per key; kSequence: the elements
};

struct Problem {
  Mark mark;
  std::string message;
};

struct Document {
  std::optional<Node> root;       // empty when there are problems, or nothing but comments in the file
  std::vector<Problem> problems;  // in file order
};

// Never throws. Refuses what people do not mean: other encodings than UTF-8, control characters, tabs as indentation,
// anchors and aliases, a second document.
Document parse(std::string_view text);

}  // namespace meca::bridge::yaml
