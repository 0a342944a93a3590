// The same scenario gives the same sequence in every topic, whatever bus is between the bridge and the robot; and what
// it is stands in a text.
#include <fstream>
#include <sstream>

#include "tests/unit/buses/scenario.hpp"

namespace meca::test {
namespace {

const std::string kFolder = std::string(MECA_SOURCE_DIR) + "/tests/unit/buses/scenarios/";

std::string read(const std::string& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  std::ostringstream out;
  out << file.rdbuf();
  return out.str();
}

// The first lines that differ, with the lines before them; empty: none do.
std::string difference(const std::string& wanted, const std::string& seen) {
  std::istringstream a(wanted), b(seen);
  std::string context;
  for (int number = 1;; ++number) {
    std::string left, right;
    const bool more_left = !!std::getline(a, left), more_right = !!std::getline(b, right);
    if (!more_left && !more_right) return "";
    if (more_left == more_right && left == right) {
      if (left.starts_with(">")) context = left;
      continue;
    }
    return "line " + std::to_string(number) + ", after '" + context + "'\n  wanted: " + left + "\n  seen:   " + right;
  }
}

class SameScenario : public testing::TestWithParam<std::tuple<Layout, Bus>> {};

// MECA_WRITE_SCENARIOS=1 writes the texts anew, from the built-in robot: to be read before they are kept.
TEST_P(SameScenario, gives_the_same_topics_on_every_bus) {
  const auto [layout, bus] = GetParam();
  const std::string golden = kFolder + "working_day." + name_of(layout) + ".topics";
  const std::string seen = Scenario(bus, layout).play(read(kFolder + "working_day.txt"));
  if (std::getenv("MECA_WRITE_SCENARIOS") != nullptr && bus == Bus::kBuiltin) std::ofstream(golden) << seen;
  EXPECT_EQ(difference(read(golden), seen), "");
}

TEST(ScenarioPlayer, refuses_a_line_that_it_does_not_know) {
  EXPECT_THROW(Scenario(Bus::kBuiltin, Layout::kFirmware11).play("dance"), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Buses, SameScenario,
                         testing::Combine(testing::Values(Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11),
                                          testing::ValuesIn(kAllBuses)),
                         [](const auto& info) {
                           return name_of(std::get<Layout>(info.param)) + "_" + name_of(std::get<Bus>(info.param));
                         });

}  // namespace
}  // namespace meca::test
