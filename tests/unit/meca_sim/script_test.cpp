// Scripts of faults: what a good one becomes, and what is said of every bad line.
#include "sim/meca_sim/script.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

std::vector<std::pair<Time, std::string>> events(const Script& script) {
  std::vector<std::pair<Time, std::string>> out;
  for (const ScriptLine& line : script.lines) out.emplace_back(line.at, line.words);
  return out;
}

TEST(Script, HasItsEventsInTheOrderOfTheirTimes) {
  const Script script = parse_script(
      "# a loose cable\r\n"
      "at 2.5s unplug\r\n"
      "\r\n"
      "  after 500ms  plug   # back\n"
      "after 0s press  P-Stop2\n"
      "at 3s faults off",
      "faults.txt");
  EXPECT_THAT(script.mistakes, IsEmpty());
  EXPECT_THAT(events(script), ElementsAre(Pair(2500ms, "unplug"), Pair(3s, "plug"), Pair(3s, "press  P-Stop2"),
                                          Pair(3s, "faults off")));
}

TEST(Script, SaysEveryMistakeAtOnceWithItsLine) {
  const Script script = parse_script(
      "unplug\n"
      "at 1 unplug\n"
      "after -1s unplug\n"
      "at 5s unplgu\n"
      "at 5s\n"
      "at 5s plug\n"
      "at 4.5s unplug\n"
      "\xC3\xA4 1s unplug\n"
      "at 6s late soon\n",
      "f");
  EXPECT_THAT(script.mistakes,
              ElementsAre("f:1: found 'unplug'; a line begins with 'at TIME' or 'after TIME', e.g. 'at 2.5s unplug'",
                          "f:2: found '1' behind 'at'; expected a time in s or ms, e.g. 2.5s",
                          "f:3: found '-1s' behind 'after'; expected a time in s or ms, e.g. 2.5s",
                          "f:4: there is no word 'unplgu', did you mean 'unplug'?",
                          "f:5: nothing is said behind the time; add words, e.g. 'unplug'",
                          "f:7: at 4.5s is before the line above, at 5s; lines stand in the order of their times",
                          "f:8: found '\?\?'; a line begins with 'at TIME' or 'after TIME', e.g. 'at 2.5s unplug'",
                          "f:9: MS: found 'soon'; expected a number from 0 to 60000"));
  EXPECT_THAT(events(script), ElementsAre(Pair(5s, "plug")));
}

TEST(Script, MayNameTheRobotItIsFor) {
  const Script script = parse_script("at 1s arm2: unplug\nat 1s plug\n", "f", {Fieldbus::kEthercat, {"arm1", "arm2"}});
  EXPECT_THAT(script.mistakes, IsEmpty());
  ASSERT_THAT(events(script), ElementsAre(Pair(1s, "unplug"), Pair(1s, "plug")));
  EXPECT_EQ(script.lines[0].robot, "arm2");
  EXPECT_EQ(script.lines[1].robot, "");
}

TEST(Script, RefusesRobotsThatThereAreNotAndWordsOfAnotherBus) {
  const Script script =
      parse_script("at 1s arm3: unplug\nat 1s arm2:\nat 1s close tcp\n", "f", {Fieldbus::kEthercat, {"arm1", "arm2"}});
  EXPECT_THAT(
      script.mistakes,
      ElementsAre("f:1: there is no robot 'arm3'; there is arm1, arm2",
                  "f:2: the line is empty; 'help' lists the words",
                  "f:3: 'close tcp': that is a word for EtherNet/IP, and this robot is on EtherCAT; 'help' says "
                  "which words are for it"));
  EXPECT_THAT(script.lines, IsEmpty());
}

TEST(Script, TakesTimesInSecondsAndMilliseconds) {
  EXPECT_EQ(parse_script_time("2.5s"), 2500ms);
  EXPECT_EQ(parse_script_time("0s"), 0ms);
  EXPECT_EQ(parse_script_time("0.5ms"), 500us);
  for (const char* bad : {"", "s", "2", "2us", "2 s", "-2s", "nans", "infs", "1e300s", "40000000s"}) {
    EXPECT_EQ(parse_script_time(bad), std::nullopt) << bad;
  }
}

Script example(const std::string& name, const ScriptStage& stage) {
  std::ifstream file(MECA_SOURCE_DIR "/config/" + name);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return parse_script(text, name, stage);
}

TEST(Script, OfTheExampleIsGood) {
  const Script script = example("faults.txt", {Fieldbus::kEthernetIp, {"arm1"}});
  EXPECT_THAT(script.mistakes, IsEmpty());
  EXPECT_EQ(script.lines.size(), 19u);
}

TEST(Script, OfTheExampleForEthercatIsGood) {
  const Script script = example("faults_ethercat.txt", {Fieldbus::kEthercat, {"arm1", "arm2", "arm3"}});
  EXPECT_THAT(script.mistakes, IsEmpty());
  EXPECT_EQ(script.lines.size(), 27u);
}

}  // namespace
}  // namespace meca::sim
