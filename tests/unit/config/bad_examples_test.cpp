// Every tests/config/bad/NAME.yaml must give exactly the lines of NAME.expected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "bridge/config.hpp"

namespace {

using namespace meca::bridge;
namespace fs = std::filesystem;

const fs::path kBad = fs::path(MECA_SOURCE_DIR) / "tests/config/bad";

std::vector<std::string> names(const std::string& extension) {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(kBad)) {
    if (entry.path().extension() == extension) found.push_back(entry.path().stem().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string letters(const ConfigResult& result) {
  std::string text;
  for (const ConfigError& error : result.errors) text += to_string(error) + "\n";
  return text;
}

class BadExample : public testing::TestWithParam<std::string> {};

TEST_P(BadExample, GivesExactlyTheExpectedLetters) {
  const fs::path expected = kBad / (GetParam() + ".expected");
  ASSERT_TRUE(fs::exists(expected)) << "every bad example has its answer beside it";
  const ConfigResult result = parse_config(contents(kBad / (GetParam() + ".yaml")), GetParam() + ".yaml");
  EXPECT_EQ(letters(result), contents(expected));
  EXPECT_FALSE(result.config.has_value());
}

TEST_P(BadExample, IsReportedInFileOrderAndWithAPlace) {
  const ConfigResult result = parse_config(contents(kBad / (GetParam() + ".yaml")), "x.yaml");
  ASSERT_FALSE(result.errors.empty());
  EXPECT_TRUE(std::is_sorted(result.errors.begin(), result.errors.end(), [](const auto& a, const auto& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  }));
  for (const ConfigError& error : result.errors) {
    EXPECT_GE(error.line, 1);
    EXPECT_GE(error.column, 1);
    EXPECT_FALSE(error.message.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Config, BadExample, testing::ValuesIn(names(".yaml")),
                         [](const auto& each) { return each.param; });

TEST(BadExamples, AreAtLeastThirtyAndEveryAnswerHasItsQuestion) {
  EXPECT_GE(names(".yaml").size(), 30U);
  EXPECT_EQ(names(".expected"), names(".yaml"));
}

TEST(LoadConfig, NamesTheFileThatIsNotThere) {
  EXPECT_EQ(letters(load_config("/nowhere/cell.yaml")),
            "/nowhere/cell.yaml: cannot be read: No such file or directory; name an existing file with --config FILE, "
            "e.g. config/builtin.yaml\n");
}

TEST(LoadConfig, SaysThatAFolderIsNoFile) {
  EXPECT_EQ(letters(load_config(kBad)), kBad.string() + ": is a folder; name the YAML file in it\n");
}

TEST(LoadConfig, RefusesAFileWithoutEnd) {
  EXPECT_EQ(letters(load_config("/dev/zero")), "/dev/zero: is larger than 1 MiB; this is no configuration\n");
}

TEST(ParseConfig, SurvivesNestingWithoutEnd) {
  const ConfigResult result = parse_config(std::string(100'000, '['), "deep.yaml");
  EXPECT_THAT(result.errors, testing::Not(testing::IsEmpty()));
  EXPECT_FALSE(result.config.has_value());
}

TEST(ParseConfig, TakesAByteOrderMarkAndWindowsLineEnds) {
  const ConfigResult result =
      parse_config("\xEF\xBB\xBFrobots:\r\n  - name: arm1\r\n    transport: {type: builtin}\r\n", "windows.yaml");
  EXPECT_EQ(letters(result), "");
  ASSERT_TRUE(result.config.has_value());
  EXPECT_EQ(result.config->robots.at(0).name, "arm1");
}

}  // namespace
