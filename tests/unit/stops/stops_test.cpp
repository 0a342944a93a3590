// Why is it not moving? In every situation of the table the person who reads `meca-ctl status` learns the cause and the
// remedy, does what the remedy says, word by word, and has a robot that moves.
#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <set>

#include "tests/unit/stops/situation.hpp"

namespace meca::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<Situation> all_situations() {
  std::vector<Situation> all;
  for (const auto& part :
       {safety_situations(), error_situations(), motion_situations(), link_situations(), watch_situations()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

// Does what a remedy says and knows nothing else.
class Technician {
 public:
  Technician(Cell& cell, const Situation& situation) : cell_(cell), situation_(situation) {}

  // Reads the line "Ready" and follows it from left to right, as far as it takes.
  void follow() {
    const std::string line = cell_.why_not_ready();
    read_ += "  " + line + '\n';
    owner_commands_ = line.find("'cell-plc' has control: command from there") != std::string::npos;
    if (owner_commands_ && situation_.owner_lets_go) {
      cell_.owner_does("release");
      owner_commands_ = false;
    }
    for (const Step& step : steps_of(line)) {
      if (step.deed) {
        used_.insert(step.deed->words);
        step.deed->done(cell_);
        cell_.steps(50);
      } else {
        type(step.verb);
      }
      if (cell_.ready()) return;
    }
  }

  const std::string& read() const { return read_; }
  bool used(const Deed& deed) const { return used_.contains(deed.words); }

 private:
  struct Step {
    std::size_t place;
    const Deed* deed;  // or
    std::string verb;
  };

  std::vector<Step> steps_of(const std::string& line) const {
    static const Deed kWait{"wait", [](Cell& c) { c.steps(500); }};
    std::vector<Step> steps;
    bool waits = false;
    for (const Deed& deed : situation_.deeds) {
      const auto place = line.find(deed.words);
      if (place == std::string::npos) continue;
      steps.push_back({place, &deed, ""});
      waits |= deed.words.starts_with("wait");
    }
    // "waits for its reset" is a cause.
    const auto wait = line.find("; wait");
    if (!waits && wait != std::string::npos) steps.push_back({wait, &kWait, ""});
    static const std::string kCommand = "'meca-ctl ";
    for (auto at = line.find(kCommand); at != std::string::npos; at = line.find(kCommand, at + 1)) {
      const auto begin = at + kCommand.size();
      steps.push_back({at, nullptr, line.substr(begin, line.find('\'', begin) - begin)});
    }
    std::ranges::sort(steps, {}, &Step::place);
    return steps;
  }

  void type(const std::string& verb) {
    const Receipt receipt = owner_commands_ ? cell_.owner_does(verb) : cell_.meca_ctl(verb);
    read_ += "    meca-ctl " + verb + ": " + describe(receipt) + '\n';
    EXPECT_EQ(static_cast<int>(receipt.state), static_cast<int>(ReceiptState::kCompleted))
        << "the remedy names a command that does not help:\n"
        << read_;
    cell_.steps(50);
  }

  Cell& cell_;
  const Situation& situation_;
  bool owner_commands_ = false;
  std::set<std::string> used_;
  std::string read_;
};

class WhenTheRobotDoesNotMove : public testing::TestWithParam<Situation> {};

TEST_P(WhenTheRobotDoesNotMove, StatusSaysWhyAndWhatItSaysHelps) {
  const Situation& situation = GetParam();
  Cell cell(situation.settings, situation.robot);
  ASSERT_NO_FATAL_FAILURE(situation.enter(cell));
  ASSERT_THAT(cell.why_not_ready(), StartsWith("no: " + situation.cause)) << cell.status();
  ASSERT_THAT(cell.why_not_ready(), HasSubstr("; " + situation.remedy)) << cell.status();

  Technician technician(cell, situation);
  constexpr int kRounds = 6;  // causes that lie behind each other show one by one
  for (int round = 0; round < kRounds && !cell.ready(); ++round) technician.follow();
  EXPECT_TRUE(cell.ready()) << "what was read and done:\n" << technician.read() << cell.status();
  EXPECT_TRUE(cell.a_command_moves_the_arm()) << technician.read() << cell.status();
  for (const Deed& deed : situation.deeds) {
    EXPECT_TRUE(technician.used(deed)) << "no remedy says '" << deed.words << "':\n" << technician.read();
  }
}

INSTANTIATE_TEST_SUITE_P(Stops, WhenTheRobotDoesNotMove, testing::ValuesIn(all_situations()),
                         [](const auto& each) { return each.param.name; });

TEST(Stops, AreMoreThanThirtySituations) { EXPECT_GE(all_situations().size(), 30U); }

}  // namespace
}  // namespace meca::test
