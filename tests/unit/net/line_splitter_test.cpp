// Bytes to lines: whatever the pieces are they arrive in, and never more than one line of memory.
#include "transports/net/line_splitter.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace meca::net {
namespace {

std::vector<std::string> split(const std::vector<std::string>& pieces, std::size_t longest = 8) {
  LineSplitter splitter(longest);
  std::vector<std::string> lines;
  const auto keep = [&lines](const LineSplitter::Line& line) { lines.push_back(line.too_long ? "(long)" : line.text); };
  for (const auto& piece : pieces) {
    splitter.add(piece);
    while (const auto line = splitter.next()) keep(*line);
  }
  if (const auto line = splitter.rest()) keep(*line);
  return lines;
}
using Lines = std::vector<std::string>;

TEST(LineSplitter, CutsAtLineFeedsHoweverTheBytesArrive) {
  EXPECT_EQ(split({"one\ntwo\n\nfour\n"}), (Lines{"one", "two", "", "four"}));
  EXPECT_EQ(split({"o", "n", "e", "\n", "two\nth", "ree\n"}), (Lines{"one", "two", "three"}));
}

TEST(LineSplitter, TakesTheRestForALineAtTheEnd) {
  EXPECT_EQ(split({"one\ntw", "o"}), (Lines{"one", "two"}));
  EXPECT_EQ(split({"one\n"}), (Lines{"one"}));
  EXPECT_EQ(split({""}), (Lines{}));
}

TEST(LineSplitter, SaysOnceThatALineIsTooLongAndGoesOnWithTheNext) {
  EXPECT_EQ(split({"12345678\n123456789\nok\n"}), (Lines{"12345678", "(long)", "ok"}));
  EXPECT_EQ(split({"1234567", "89", "0123456789", "0123456789\nok\n"}), (Lines{"(long)", "ok"}));
  EXPECT_EQ(split({"123456789"}), (Lines{"(long)"}));
}

TEST(LineSplitter, KeepsBytesThatAreNoText) {
  EXPECT_EQ(split({std::string("a\0b\xFF\r\n", 6)}), (Lines{std::string("a\0b\xFF\r", 5)}));
}

}  // namespace
}  // namespace meca::net
