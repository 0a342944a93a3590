// Enough of XML for an ESI (EtherCAT slave information file), where the tags in question do not nest in themselves.
#pragma once

#include <gtest/gtest.h>

#include <charconv>
#include <string>
#include <vector>

namespace meca::image::test {

// "17" or "#x11".
inline unsigned number_of(std::string text) {
  const bool hex = text.starts_with("#x");
  unsigned value = 0;
  const auto* begin = text.data() + (hex ? 2 : 0);
  const auto result = std::from_chars(begin, text.data() + text.size(), value, hex ? 16 : 10);
  EXPECT_EQ(result.ec, std::errc{}) << "no number in the ESI: " << text;
  return value;
}

// The texts between <tag ...> and </tag>.
inline std::vector<std::string> elements(const std::string& xml, const std::string& tag) {
  std::vector<std::string> found;
  for (auto at = xml.find("<" + tag); at != std::string::npos; at = xml.find("<" + tag, at + 1)) {
    const char after = xml[at + 1 + tag.size()];
    if (after != '>' && after != ' ') continue;
    const auto begin = xml.find('>', at) + 1;
    found.push_back(xml.substr(begin, xml.find("</" + tag + ">", begin) - begin));
  }
  return found;
}

// The first of them, "" for none.
inline std::string element(const std::string& xml, const std::string& tag) {
  const auto found = elements(xml, tag);
  return found.empty() ? "" : found.front();
}

}  // namespace meca::image::test
