#include "tests/bench/table.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace meca::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(const Json& row, const std::string& column) {
  const auto value = row.find(column);
  if (value == row.end()) return "";
  if (!value->is_number_float()) return value->dump();
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value->get<double>());
  return text;
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string space(width - std::min(width, text.size()), ' ');
  return right ? space + text : text + space;
}

}  // namespace

std::string table(const std::string& title, const Json& figures) {
  std::vector<std::string> header{""};
  for (const auto& row : figures) {
    for (const auto& [column, value] : row.items()) {
      if (std::find(header.begin(), header.end(), column) == header.end()) header.push_back(column);
    }
  }
  std::vector<std::vector<std::string>> lines{header};
  for (const auto& [name, row] : figures.items()) {
    std::vector<std::string> line{figures.is_array() ? "" : name};
    for (std::size_t i = 1; i < header.size(); ++i) line.push_back(cell(row, header[i]));
    lines.push_back(line);
  }
  std::string text = "\n" + title + "\n";
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      std::size_t width = 0;
      for (const auto& other : lines) width = std::max(width, other[i].size());
      text += "  " + padded(line[i], width, i > 0);
    }
    text += "\n";
  }
  return text;
}

}  // namespace meca::bench
