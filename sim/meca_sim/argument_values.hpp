// Values of meca-sim's options out of their texts: each taken, or a complaint in a sentence.
#pragma once

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meca::sim {

// What is wrong and what instead, without full stop; nothing when the value was taken.
using Complaint = std::optional<std::string>;

inline std::string in_quotes(std::string_view text) { return "'" + std::string(text) + "'"; }

// "; did you mean '--name'?", or nothing.
std::string guess(std::string_view word, std::span<const std::string_view> known);

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
  return "found " + in_quotes(word) + "; expected one of " + all + guess(word, known);
}

template <class Number>
Complaint read_number(std::string_view text, Number minimum, Number maximum, std::string_view expected, Number& out) {
  Number value{};
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size() || !(value >= minimum && value <= maximum)) {
    return "found " + in_quotes(text) + "; expected " + std::string(expected);
  }
  out = value;
  return std::nullopt;
}

// "11.3": a generation of the firmware that there is, and its minor version.
struct Firmware {
  unsigned major = 11, minor = 3;
};
Complaint read_firmware(std::string_view text, Firmware& out);

// A robot's name, and the names of `count` robots: with several of them the number at its end counts on from there, or
// from 1. "arm1", 3: arm1, arm2, arm3; "left", 2: left1, left2.
Complaint read_names(std::string_view name, std::size_t count, std::vector<std::string>& out);

}  // namespace meca::sim
