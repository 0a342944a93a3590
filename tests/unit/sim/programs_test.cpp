// Offline programs, started by number (StartProgram, id 100) and shown by OfflineProgramID.
#include "sim/programs.hpp"

#include <stdexcept>

#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

Program program(std::uint16_t number, std::vector<ProgramCommand> commands) { return {number, std::move(commands)}; }
ProgramCommand joints(float q1) { return {image::kMoveJoints, {q1, 0, 0, 0, 0, 0}}; }
ProgramCommand checkpoint(float n) { return {image::kSetCheckpoint, {n}}; }
ProgramCommand start(float number) { return {image::kStartProgram, {number}}; }

RobotOptions with(std::vector<Program> programs) {
  RobotOptions o = Rig::quick();
  o.programs = std::move(programs);
  return o;
}

class OfflinePrograms : public testing::Test {
 protected:
  void use(std::vector<Program> programs) {
    rig = Rig(with(std::move(programs)));
    rig.make_ready();
  }
  // Entries of the journal that tell of commands the host sent, or of those that are part of a program.
  std::vector<JournalEntry> journal(bool of_programs) const {
    std::vector<JournalEntry> out;
    const Journal& all = rig.robot.journal();
    for (auto i = all.first(); i < all.size(); ++i) {
      if ((all[i].command.program != 0) == of_programs) out.push_back(all[i]);
    }
    return out;
  }
  std::uint16_t running() const { return rig.motion().offline_program_id; }
  Rig rig;
};

TEST_F(OfflinePrograms, RunBeforeWhatStandsBehindThem) {
  use({program(7, {checkpoint(1), joints(10), checkpoint(2)})});
  rig.send(image::kStartProgram, {7});
  rig.send(image::kSetCheckpoint, {3});
  rig.run(20ms);
  EXPECT_EQ(rig.motion().checkpoint_reached, 1);
  EXPECT_EQ(running(), 7);
  EXPECT_FALSE(rig.motion().eob);
  rig.run_until([](const auto& in) { return in.motion_status.checkpoint_reached == 3; });
  EXPECT_NEAR(rig.joint(1), 10, 1e-4);
  EXPECT_EQ(running(), 0);
  EXPECT_TRUE(rig.motion().eob);
}

TEST_F(OfflinePrograms, AreExecutedOnceForTheHostWhenTheyHaveEnded) {
  use({program(7, {joints(10), joints(20)})});
  rig.send(image::kSetJointVel, {50});
  rig.send(image::kStartProgram, {7});
  rig.send(image::kSetCheckpoint, {3});
  rig.run(100ms);
  EXPECT_EQ(journal(false).size(), 1u) << "only SetJointVel so far";
  rig.run(3s);
  const auto host = journal(false);
  ASSERT_EQ(host.size(), 3u);
  EXPECT_EQ(host[1].command.id, image::kStartProgram);
  EXPECT_EQ(host[1].command.arguments[0], 7);
  EXPECT_EQ(host[1].command.move_id, 2);
  EXPECT_EQ(host[1].outcome, Outcome::kExecuted);
  EXPECT_EQ(host[2].command.id, image::kSetCheckpoint);
}

TEST_F(OfflinePrograms, MarkTheirOwnCommandsInTheJournal) {
  use({program(7, {joints(10), joints(20)})});
  rig.send(image::kStartProgram, {7});
  rig.run(3s);
  const auto own = journal(true);
  ASSERT_EQ(own.size(), 2u);
  for (const JournalEntry& e : own) {
    EXPECT_EQ(e.command.program, 7);
    EXPECT_EQ(e.command.move_id, 1) << "of the StartProgram";
    EXPECT_EQ(e.command.id, image::kMoveJoints);
    EXPECT_EQ(e.outcome, Outcome::kExecuted);
  }
}

TEST_F(OfflinePrograms, TakeNoRoomInTheQueue) {
  use({program(7, {joints(10), joints(20), joints(30)})});
  rig.send(image::kStartProgram, {7});
  EXPECT_EQ(rig.motion().fifo_space, 13000);
}

TEST_F(OfflinePrograms, WithoutCommandsEndAtOnce) {
  use({program(7, {})});
  rig.perform(image::kStartProgram, {7});
  EXPECT_EQ(running(), 0);
  ASSERT_EQ(journal(false).size(), 1u);
  EXPECT_EQ(journal(false)[0].outcome, Outcome::kExecuted);
}

TEST_F(OfflinePrograms, CallEachOtherAndShowTheInnermost) {
  use({program(7, {start(8), joints(20)}), program(8, {joints(10)})});
  rig.send(image::kStartProgram, {7});
  rig.run(20ms);
  EXPECT_EQ(running(), 8);
  rig.run_until([this](const auto&) { return running() != 8; });
  EXPECT_EQ(running(), 7);
  rig.run_until([](const auto& in) { return in.motion_status.eob; });
  EXPECT_NEAR(rig.joint(1), 20, 1e-4);
  std::vector<std::pair<std::uint32_t, std::uint16_t>> order;
  for (const JournalEntry& e : journal(true)) order.emplace_back(e.command.id, e.command.program);
  EXPECT_EQ(order, (decltype(order){{image::kMoveJoints, 8}, {image::kStartProgram, 7}, {image::kMoveJoints, 7}}));
}

TEST_F(OfflinePrograms, BlendTheirMovesWithEachOtherAndWithWhatComesBehind) {
  use({program(7, {joints(30), {image::kMoveJoints, {30, 20, 0, 0, 0, 0}}})});
  rig.send(image::kStartProgram, {7});
  rig.send(image::kMoveJoints, {0, 20, 0, 0, 0, 0});
  rig.run_until([this](const auto&) { return rig.joint(2) > 0; });
  EXPECT_LT(rig.joint(1), 29.9) << "rounds the corner inside of the program";
  rig.run_until([this](const auto&) { return rig.joint(1) < 29.9 && rig.joint(2) > 10; });
  EXPECT_LT(rig.joint(2), 19.99) << "rounds the corner at its end";
}

TEST_F(OfflinePrograms, ArePausedAndGoOn) {
  use({program(7, {joints(30), joints(60)})});
  rig.send(image::kStartProgram, {7});
  rig.run(300ms);
  rig.out.motion_control.pause_motion = true;
  rig.run(1s);
  const double stopped = rig.joint(1);
  rig.run(1s);
  EXPECT_EQ(rig.joint(1), stopped);
  EXPECT_EQ(running(), 7);
  rig.out.motion_control.pause_motion = false;
  rig.resume();
  rig.run(5s);
  EXPECT_NEAR(rig.joint(1), 60, 1e-4);
  EXPECT_EQ(running(), 0);
}

TEST_F(OfflinePrograms, DoNotStartWhilePaused) {
  use({program(7, {checkpoint(1)})});
  rig.out.motion_control.pause_motion = true;
  rig.step();
  rig.send(image::kStartProgram, {7});
  rig.run(50ms);
  EXPECT_EQ(running(), 0);
  EXPECT_EQ(rig.motion().checkpoint_reached, 0);
}

TEST_F(OfflinePrograms, AreDiscardedWithTheRestOfTheirCommandsByAClear) {
  use({program(7, {joints(90), checkpoint(5)})});
  rig.send(image::kStartProgram, {7});
  rig.send(image::kMoveJoints, {1, 0, 0, 0, 0, 0});
  rig.run(100ms);
  rig.out.motion_control.clear_motion = true;
  rig.run(500ms);
  EXPECT_EQ(running(), 0);
  EXPECT_EQ(rig.motion().checkpoint_discarded, 5);
  std::vector<std::uint32_t> host, own;
  for (const JournalEntry& e : journal(false)) {
    EXPECT_EQ(e.outcome, Outcome::kDiscarded);
    host.push_back(e.command.id);
  }
  for (const JournalEntry& e : journal(true)) {
    EXPECT_EQ(e.outcome, Outcome::kDiscarded);
    own.push_back(e.command.id);
  }
  EXPECT_EQ(host, (std::vector<std::uint32_t>{image::kStartProgram, image::kMoveJoints}));
  EXPECT_EQ(own, (std::vector<std::uint32_t>{image::kMoveJoints, image::kSetCheckpoint}));
  rig.out.motion_control.clear_motion = false;
  rig.step();
  rig.resume();
  rig.perform(image::kMoveJoints, {0, 0, 0, 0, 0, 0});
  EXPECT_NEAR(rig.joint(1), 0, 1e-4) << "nothing of it is left";
}

TEST_F(OfflinePrograms, EndWithTheErrorOfTheirCommand) {
  use({program(7, {{image::kMoveLin, {900, 0, 0, 0, 0, 0}}, joints(10)})});
  rig.perform(image::kStartProgram, {7});
  EXPECT_EQ(rig.error(), 1016);
  EXPECT_EQ(running(), 0);
  EXPECT_EQ(journal(true).at(0).outcome, Outcome::kRefused);
  ASSERT_EQ(journal(false).size(), 1u);
  EXPECT_EQ(journal(false)[0].outcome, Outcome::kDiscarded);
}

TEST_F(OfflinePrograms, OfUnknownNumberAre3017) {
  use({program(7, {joints(1)}), program(8, {start(9)})});
  rig.perform(image::kStartProgram, {6});
  EXPECT_EQ(rig.error(), 3017);
  rig.reset_error();
  rig.resume();
  rig.perform(image::kStartProgram, {8});
  EXPECT_EQ(rig.error(), 3017) << "called by another program";
}

TEST_F(OfflinePrograms, ThatStartThemselvesAre3023) {
  use({program(7, {start(7)}), program(8, {start(9)}), program(9, {joints(1), start(8)})});
  rig.perform(image::kStartProgram, {7});
  EXPECT_EQ(rig.error(), 3023);
  rig.reset_error();
  rig.resume();
  rig.perform(image::kStartProgram, {8});
  EXPECT_EQ(rig.error(), 3023) << "in a circle of two";
  EXPECT_NEAR(rig.joint(1), 1, 1e-4) << "only when the turn of that comes";
}

TEST_F(OfflinePrograms, ThatARobotCannotPlayAre3020) {
  for (const ProgramCommand& bad :
       {ProgramCommand{image::kSetJointVel, {0}}, ProgramCommand{52, {}}, ProgramCommand{image::kClearHoming, {}},
        ProgramCommand{image::kSetJointLimitsCfg, {1}}, ProgramCommand{10000, {1}}}) {
    use({program(7, {joints(5), bad})});
    rig.perform(image::kStartProgram, {7});
    EXPECT_EQ(rig.error(), 3020) << bad.id;
    EXPECT_EQ(rig.joint(1), 0) << "nothing of it is played";
  }
}

TEST_F(OfflinePrograms, NeedAHomedRobot) {
  rig.activate();
  rig.perform(image::kStartProgram, {1});
  EXPECT_EQ(rig.error(), 1006);
}

TEST_F(OfflinePrograms, OfEveryRobotAreTheDocumentedOnes) {
  rig.make_ready();
  for (const double number : {1.0, 2.0, 3.0}) {
    rig.perform(image::kStartProgram, {number});
    EXPECT_EQ(rig.error(), 0) << number;
    EXPECT_EQ(rig.joint(1), 0);
  }
  rig.perform(image::kStartProgram, {4});
  EXPECT_EQ(rig.error(), 3023);
}

TEST(ProgramsOfNoRobot, AreAnErrorAtTheDoor) {
  EXPECT_THROW(Robot{with({program(0, {})})}, std::invalid_argument);
  EXPECT_THROW(Robot{with({program(65535, {})})}, std::invalid_argument);
  EXPECT_THROW(Robot{with({program(7, {}), program(7, {})})}, std::invalid_argument);
}

}  // namespace
}  // namespace meca::sim
