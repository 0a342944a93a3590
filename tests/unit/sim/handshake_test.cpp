// MoveID, SetPoint and the motion queue (manual 9.2 page 64, manual 11 section 4.4.2).
#include "sim/journal.hpp"
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

class Handshake : public testing::Test {
 protected:
  Handshake() { rig.make_ready(); }
  std::size_t queued() const { return 13000u - rig.motion().fifo_space; }
  void offer(std::uint16_t move_id, std::uint32_t command, float argument) {
    rig.out.motion_control.move_id = move_id;
    rig.out.motion_command = {command, {argument}};
    rig.step();
  }
  Rig rig;
};

TEST_F(Handshake, WithoutSetPointNothingIsTakenAndNothingIsEchoed) {
  offer(7, image::kDelay, 1);
  EXPECT_EQ(rig.motion().move_id, 0);
  EXPECT_EQ(rig.robot.journal().size(), 0u);
  EXPECT_TRUE(rig.motion().eob);
}

TEST_F(Handshake, AChangedMoveIdQueuesOneCommandAndIsEchoed) {
  rig.out.motion_control.set_point = true;
  offer(7, image::kDelay, 10);
  EXPECT_EQ(rig.motion().move_id, 7);
  offer(8, image::kDelay, 10);
  EXPECT_EQ(rig.motion().move_id, 8);
  EXPECT_EQ(queued(), 1u);  // the first one runs
  rig.run(100ms);           // the same MoveID again and again: nothing new
  EXPECT_EQ(queued(), 1u);
}

TEST_F(Handshake, TheSameMoveIdWithAnotherCommandIsNotTaken) {
  rig.out.motion_control.set_point = true;
  offer(7, image::kDelay, 10);
  offer(7, image::kSetCheckpoint, 1);
  EXPECT_EQ(queued(), 0u);
  EXPECT_EQ(rig.robot.journal().size(), 0u);
}

TEST_F(Handshake, MoveIdsMayGoDownAndWrapAround) {
  rig.out.motion_control.set_point = true;
  offer(65535, image::kDelay, 10);
  offer(1, image::kDelay, 10);
  offer(300, image::kDelay, 10);
  offer(2, image::kDelay, 10);
  EXPECT_EQ(queued(), 3u);
  EXPECT_EQ(rig.motion().move_id, 2);
}

TEST_F(Handshake, APositionCommandWithMoveIdZeroIsQueuedInEveryCycle) {
  rig.send(image::kDelay, {10});
  rig.out.motion_control.move_id = 0;
  rig.run(50ms);
  EXPECT_EQ(queued(), 50u);
  EXPECT_EQ(rig.motion().move_id, 0);
}

TEST_F(Handshake, NoMovementIsAcknowledgedAndDoesNothing) {
  rig.send(0, {1, 2, 3, 4, 5, 6});
  EXPECT_EQ(rig.error(), 0);
  EXPECT_EQ(queued(), 0u);
  EXPECT_TRUE(rig.motion().eob);
}

TEST_F(Handshake, ThirteenThousandCommandsFitAndTheNextIsLostAndReported) {
  rig.out.motion_control.pause_motion = true;
  rig.step();
  for (int i = 0; i < 13000; ++i) rig.send(image::kSetCheckpoint, {1.0 + i % 8000});
  EXPECT_EQ(rig.motion().fifo_space, 0);
  EXPECT_EQ(rig.robot.violations().size(), 0u);
  rig.send(image::kSetCheckpoint, {4});
  EXPECT_EQ(rig.motion().fifo_space, 0);
  EXPECT_EQ(rig.error(), 0);
  EXPECT_EQ(rig.robot.violations().size(), 1u);
  EXPECT_EQ(rig.robot.journal().back().code, 1000);

  rig.out.motion_control.pause_motion = false;
  rig.resume();
  rig.run_until([](const auto& in) { return in.motion_status.eob; });
  EXPECT_EQ(rig.motion().fifo_space, 13000);
  EXPECT_EQ(rig.motion().checkpoint_reached, 5000u);  // number 1 + 12999 % 8000
}

TEST_F(Handshake, TheJournalListsWhatWasExecutedInOrder) {
  rig.send(image::kSetJointVel, {50});
  rig.send(image::kMoveJoints, {5, 0, 0, 0, 0, 0});
  rig.send(image::kSetCheckpoint, {9});
  rig.run_until([](const auto& in) { return in.motion_status.eob; });
  const Journal& journal = rig.robot.journal();
  ASSERT_EQ(journal.size(), 3u);
  const std::uint32_t ids[] = {image::kSetJointVel, image::kMoveJoints, image::kSetCheckpoint};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(journal[i].command.id, ids[i]);
    EXPECT_EQ(journal[i].command.move_id, i + 1);
    EXPECT_EQ(journal[i].outcome, Outcome::kExecuted);
  }
  EXPECT_EQ(journal[1].command.arguments[0], 5.0f);
}

TEST_F(Handshake, CheckpointsAreReachedInTheirTurnAndTheSameNumberMayComeAgain) {
  rig.send(image::kSetCheckpoint, {8000});
  rig.send(image::kMoveJoints, {20, 0, 0, 0, 0, 0});
  rig.send(image::kSetCheckpoint, {1});
  rig.step();
  EXPECT_EQ(rig.motion().checkpoint_reached, 8000u);
  rig.run_until([](const auto& in) { return in.motion_status.checkpoint_reached == 1; });
  EXPECT_NEAR(rig.joint(1), 20, 1e-4);
}

TEST_F(Handshake, ClearMotionDiscardsCheckpointsAndTakesNoCommandWhileItIsSet) {
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.send(image::kSetCheckpoint, {11});
  rig.send(image::kSetCheckpoint, {12});
  rig.run(300ms);
  rig.out.motion_control.clear_motion = true;
  rig.step();
  EXPECT_FALSE(rig.motion().cleared);  // still slowing down: "when set, the robot is not moving"
  rig.run_until([](const auto& in) { return in.motion_status.cleared; });
  EXPECT_TRUE(rig.motion().eob);
  EXPECT_TRUE(rig.motion().paused);
  EXPECT_EQ(rig.motion().checkpoint_discarded, 12);
  EXPECT_EQ(rig.motion().checkpoint_reached, 0u);

  rig.send(image::kSetCheckpoint, {13});  // echoed, refused
  EXPECT_EQ(rig.motion().fifo_space, 13000);
  EXPECT_EQ(rig.robot.journal().back().outcome, Outcome::kRefused);
  EXPECT_EQ(rig.error(), 0);

  rig.out.motion_control.clear_motion = false;
  rig.send(image::kSetCheckpoint, {14});  // taken, runs after the resume
  rig.run(20ms);
  EXPECT_FALSE(rig.motion().cleared);
  EXPECT_TRUE(rig.motion().paused);
  EXPECT_EQ(rig.motion().checkpoint_reached, 0u);
  rig.resume();
  EXPECT_EQ(rig.step().motion_status.checkpoint_reached, 14u);
  EXPECT_EQ(rig.robot.violations().size(), 0u);
}

TEST_F(Handshake, WhatClearMotionCutOffIsDiscardedInTheJournalOnce) {
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.send(image::kMoveJoints, {0, 0, 0, 0, 0, 0});
  rig.run(100ms);
  rig.out.motion_control.clear_motion = true;
  rig.run(1s);
  const Journal& journal = rig.robot.journal();
  ASSERT_EQ(journal.size(), 2u);
  EXPECT_EQ(journal[0].outcome, Outcome::kDiscarded);
  EXPECT_EQ(journal[0].command.move_id, 1);
  EXPECT_EQ(journal[1].outcome, Outcome::kDiscarded);
  EXPECT_EQ(journal[1].command.move_id, 2);
}

TEST(Checkpoints, AreThirtyTwoBitsWithoutDiscardedOnesBeforeFirmware11) {
  Rig rig(Rig::quick(image::Layout::kFirmware10));
  rig.make_ready();
  rig.send(image::kDelay, {5});
  rig.send(image::kSetCheckpoint, {3});
  rig.out.motion_control.clear_motion = true;
  rig.run(10ms);
  EXPECT_EQ(rig.motion().checkpoint_discarded, 0);
}

}  // namespace
}  // namespace meca::sim
