// What meca-sim tells of robots on EtherCAT.
#include "sim/meca_sim/ethercat_narrator.hpp"

#include <gmock/gmock.h>

#include <utility>

#include "tests/unit/meca_sim/ethercat_cell.hpp"

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using test::EthercatCell;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class NarratorOfEthercat : public testing::Test {
 protected:
  // What has been said since the last call.
  std::vector<std::string> said() {
    narrator_.look(cell_.now);
    return std::exchange(said_, {});
  }

  EthercatCell cell_;
  std::vector<std::string> said_;
  EthercatNarrator narrator_{cell_.segment.robot(0),
                             [this](Narrator::Level, const std::string& text) { said_.push_back(text); }};
};

TEST_F(NarratorOfEthercat, TellsTheLifeOfAConnection) {
  EXPECT_THAT(said(), IsEmpty());
  ASSERT_TRUE(cell_.connect());
  EXPECT_THAT(said(), ElementsAre("the master brought it to OP: outputs are applied"));
  cell_.master_lives = false;
  cell_.run(1s);
  EXPECT_THAT(said(), ElementsAre(StartsWith("in SAFEOP with error 0x001B: ")));
  cell_.master_lives = true;
  ASSERT_TRUE(cell_.until([&] { return cell_.segment.robot(0).device().operational(); }));
  EXPECT_THAT(said(), ElementsAre("the master brought it to OP: outputs are applied"));
  cell_.master.close(cell_.now);
  ASSERT_TRUE(cell_.until([&] { return cell_.master.closed(); }, 1s));
  EXPECT_THAT(said(), ElementsAre("it left OP and is in INIT"));
  EXPECT_THAT(narrator_.summary(), StartsWith("OP reached: 2; "));
  EXPECT_THAT(narrator_.summary(), HasSubstr("; expired watchdogs: 1; "));
}

TEST_F(NarratorOfEthercat, TellsOfARobotThatGoesAway) {
  ASSERT_TRUE(cell_.connect());
  said();
  cell_.segment.robot(0).robot().power_cycle();
  cell_.run(10ms);
  EXPECT_THAT(said(), ElementsAre("the robot is away, starting up"));
  cell_.run(550ms);
  EXPECT_THAT(said().front(), "the robot is back");
}

}  // namespace
}  // namespace meca::sim
