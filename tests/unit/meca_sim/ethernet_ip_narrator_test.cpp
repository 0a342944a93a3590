// What meca-sim tells of a connection over EtherNet/IP.
#include "sim/meca_sim/ethernet_ip_narrator.hpp"

#include <gmock/gmock.h>

#include "tests/unit/meca_sim/cell.hpp"

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using test::Cell;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Listener {
  std::vector<std::string> take() { return std::exchange(said, {}); }
  std::vector<std::string> said;
  Narrator::Say say = [this](Narrator::Level, const std::string& text) { said.push_back(text); };
};

TEST(EthernetIpNarrator, TellsTheLifeOfAConnection) {
  Cell cell;
  Listener listener;
  EthernetIpNarrator narrator(cell.robot, listener.say);
  ASSERT_TRUE(cell.connect());
  cell.run(50ms);
  narrator.look(cell.now);
  EXPECT_THAT(listener.take(), ElementsAre("the I/O connection was opened by 172.28.1.2", "the host says run"));
  cell.run_bit = false;
  cell.run(50ms);
  narrator.look(cell.now);
  EXPECT_THAT(listener.take(), ElementsAre("the host says idle: its outputs are not applied"));
  cell.host_lives = false;
  cell.run(1s);
  narrator.look(cell.now);
  EXPECT_THAT(listener.take(), ElementsAre("the I/O connection timed out: no O->T packets any more"));
  cell.host_lives = true;
  cell.robot.robot().power_cycle();
  cell.run(10ms);
  narrator.look(cell.now);
  EXPECT_THAT(listener.take(), ElementsAre("the robot is away, starting up"));
}

TEST(EthernetIpNarrator, TellsOnceOfPacketsThatAreDroppedWithoutAnAnswer) {
  Cell cell;
  Listener listener;
  EthernetIpNarrator narrator(cell.robot, listener.say);
  for (int i = 0; i < 3; ++i) {
    cell.robot.io_received({Cell::kHost, 2222}, std::array<std::byte, 5>{}, cell.now);
    narrator.look(cell.now);
  }
  EXPECT_THAT(listener.take(), ElementsAre(HasSubstr("of a wrong form or length and is ignored; expected are 66")));
  narrator.look(cell.now);
  EXPECT_THAT(listener.take(), IsEmpty());
  EXPECT_THAT(narrator.summary(), HasSubstr("3 malformed"));
}

TEST(EthernetIpNarrator, TellsOfRefusals) {
  Cell cell;
  Listener listener;
  EthernetIpNarrator narrator(cell.robot, listener.say);
  cell.robot.faults().refuse_open = 0x0106;
  ASSERT_TRUE(cell.until([&] { return cell.host.counters().refusals == 1; }));
  narrator.look(cell.now);
  EXPECT_THAT(listener.take(), ElementsAre(HasSubstr("was refused, 1 until now")));
}

TEST(EthernetIpNarrator, TellsOfRulesThatTheHostBreaksAtMostOnceASecond) {
  RobotOptions model = Cell::quick();
  model.homing_time = 1h;
  Cell cell(ConnectionLoss::kStop, model);
  Listener listener;
  EthernetIpNarrator narrator(cell.robot, listener.say);
  ASSERT_TRUE(cell.connect());
  cell.outputs.robot_control.activate = true;
  ASSERT_TRUE(cell.until([&] { return cell.inputs().robot_status.activated; }));
  narrator.look(cell.now);
  listener.take();
  const auto break_a_rule = [&] {
    cell.outputs.robot_control.home = true;
    cell.run(50ms);
    cell.outputs.robot_control.home = false;  // before Homed confirms it
    cell.run(50ms);
    narrator.look(cell.now);
  };
  break_a_rule();
  ASSERT_GT(cell.robot.robot().violations().size(), 0u);
  EXPECT_THAT(listener.take(), ElementsAre(HasSubstr("the host broke a rule: ")));
  break_a_rule();
  EXPECT_THAT(listener.take(), IsEmpty());
  cell.run(1s);
  narrator.look(cell.now);
  EXPECT_THAT(listener.take(), ElementsAre(HasSubstr("the host broke a rule: ")));
}

}  // namespace
}  // namespace meca::sim
