// One round of the loop over scripted buses: no thread, no clock, no network.
#include "bridge/loop.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <variant>
#include <vector>

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;

// What the bus saw, for the test that outlives it.
struct Seen {
  int exchanges = 0;
  std::vector<bool> fresh;  // by robot; where it ends, true
  transports::Transport::Woke woke = transports::Transport::Woke::kCannotWait;
  bool closed = false;
  bool set_point_at_close = true;
  bool pause_at_close = false;
};

class ScriptedBus final : public transports::Transport {
 public:
  explicit ScriptedBus(Seen& seen) : seen_(seen) {
    inputs_.robot_status.activated = inputs_.robot_status.homed = true;  // a robot that could be moving
  }
  std::endian byte_order() const noexcept override { return std::endian::little; }
  void open(Time) override {}
  void exchange(Time, std::span<transports::Exchange> robots) noexcept override {
    ++seen_.exchanges;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      auto& robot = robots[i];
      last_ = image::decode_outputs(robot.output, {});
      robot.fresh = i >= seen_.fresh.size() || seen_.fresh[i];
      robot.link = transports::LinkState::kUp;
      robot.identity = {11, 3, 0, 1};
      image::encode_inputs(inputs_, {}, robot.input);
    }
  }
  Woke wait(transports::Time) noexcept override { return seen_.woke; }
  Time deadline_shift() const noexcept override { return 3us; }
  void close() noexcept override {
    seen_.closed = true;
    seen_.set_point_at_close = last_.motion_control.set_point;
    seen_.pause_at_close = last_.motion_control.pause_motion;
  }

 private:
  Seen& seen_;
  image::Inputs inputs_;
  image::Outputs last_;
};

class BusGroupTest : public testing::Test {
 protected:
  LoopBus bus(Seen& seen, std::vector<RobotChannel*> channels) {
    LoopBus bus;
    bus.transport = std::make_unique<ScriptedBus>(seen);
    for (auto* channel : channels) bus.robots.push_back({CycleSettings{}, channel});
    return bus;
  }
  BusGroup group(std::vector<RobotChannel*> channels) {
    std::vector<LoopBus> buses;
    buses.push_back(bus(seen_, std::move(channels)));
    return BusGroup(std::move(buses));
  }
  Stamp next() { return {.now = now_ += 1ms, .unix_ns = now_.count()}; }

  static control::CommandRequest take_control(std::uint64_t id) {
    control::CommandRequest request;
    request.client = std::string_view("plc");
    request.command_id = id;
    request.kind = control::CommandKind::kTakeControl;
    return request;
  }

  Time now_{};
  Seen seen_;
  RobotChannel arm1_{"arm1"}, arm2_{"arm2"};
};

TEST_F(BusGroupTest, EveryRobotOfEveryBusGetsOneRecordPerRound) {
  Seen other;
  std::vector<LoopBus> buses;
  buses.push_back(bus(seen_, {&arm1_}));
  buses.push_back(bus(other, {&arm2_}));
  BusGroup group(std::move(buses));
  for (int i = 0; i < 3; ++i) group.run(next(), BusGroup::Ending::kNone);
  EXPECT_EQ(seen_.exchanges, 3);
  EXPECT_EQ(other.exchanges, 3);
  EXPECT_EQ(arm1_.records.size(), 3U);
  EXPECT_EQ(arm2_.records.size(), 3U);
}

TEST_F(BusGroupTest, AnImageThatArrivesBetweenTwoRoundsHasItsStepAtOnceInPlaceOfTheNextRounds) {
  auto group = this->group({&arm1_, &arm2_});
  seen_.fresh = {true, false};  // the second robot's image is late
  group.run_arrived(next());
  EXPECT_EQ(arm1_.records.size(), 1U);
  EXPECT_EQ(arm2_.records.size(), 0U);
  seen_.fresh = {false, false};
  group.run(next(), BusGroup::Ending::kNone);
  EXPECT_EQ(arm1_.records.size(), 1U);
  EXPECT_EQ(arm2_.records.size(), 1U);  // a cycle without an image is a cycle
  group.run(next(), BusGroup::Ending::kNone);
  EXPECT_EQ(arm1_.records.size(), 2U);
}

TEST_F(BusGroupTest, ARoundHasNewsUnlessEveryRobotHadItsStepBetween) {
  auto group = this->group({&arm1_, &arm2_});
  EXPECT_TRUE(group.run(next(), BusGroup::Ending::kNone));
  seen_.fresh = {true, false};
  group.run_arrived(next());
  seen_.fresh = {false, false};
  EXPECT_TRUE(group.run(next(), BusGroup::Ending::kNone));  // of the second robot
  seen_.fresh = {true, true};
  group.run_arrived(next());
  seen_.fresh = {false, false};
  EXPECT_FALSE(group.run(next(), BusGroup::Ending::kNone));
}

TEST_F(BusGroupTest, ARobotThatHadItsStepStillHearsThatItIsToStop) {
  auto group = this->group({&arm1_});
  for (int i = 0; i < 5; ++i) group.run(next(), BusGroup::Ending::kNone);
  group.run_arrived(next());
  seen_.fresh = {false};
  group.run(next(), BusGroup::Ending::kStop);
  seen_.fresh = {true};
  group.run(next(), BusGroup::Ending::kStop);
  group.close(next());
  EXPECT_TRUE(seen_.pause_at_close);
}

TEST_F(BusGroupTest, OnlyABusOfItsOwnMayWaitInTheLoopsPlace) {
  using Woke = transports::Transport::Woke;
  seen_.woke = Woke::kArrival;
  auto alone = group({&arm1_});
  EXPECT_EQ(alone.wait(1ms), Woke::kArrival);
  std::vector<LoopBus> buses;
  buses.push_back(bus(seen_, {&arm1_}));
  buses.push_back(bus(seen_, {&arm2_}));
  BusGroup together(std::move(buses));
  EXPECT_EQ(together.wait(1ms), Woke::kCannotWait);
}

TEST_F(BusGroupTest, OnlyABusOfItsOwnMovesTheDeadlines) {
  EXPECT_EQ(group({&arm1_}).deadline_shift(), 3us);
  std::vector<LoopBus> buses;
  buses.push_back(bus(seen_, {&arm1_}));
  buses.push_back(bus(seen_, {&arm2_}));
  EXPECT_EQ(BusGroup(std::move(buses)).deadline_shift(), 0us);
}

TEST_F(BusGroupTest, AFullRecordQueueCostsRecordsAndNeverReceipts) {
  auto group = this->group({&arm1_});
  for (std::size_t i = 0; i < arm1_.records.capacity() + 5; ++i) group.run(next(), BusGroup::Ending::kNone);
  EXPECT_EQ(arm1_.records_dropped.load(), 5U);
  arm1_.inbox.push(take_control(1));
  group.run(next(), BusGroup::Ending::kNone);
  group.run(next(), BusGroup::Ending::kNone);
  ASSERT_NE(arm1_.receipts.front(), nullptr);
  EXPECT_EQ(arm1_.receipts.front()->receipt.command_id, 1U);
  EXPECT_EQ(arm1_.receipts_lost.load(), 0U);
}

TEST_F(BusGroupTest, WithoutRoomForReceiptsRequestsWaitInTheInbox) {
  auto group = this->group({&arm1_});
  group.run(next(), BusGroup::Ending::kNone);
  while (arm1_.receipts.push({})) {
  }
  arm1_.inbox.push(take_control(1));
  group.run(next(), BusGroup::Ending::kNone);
  EXPECT_EQ(arm1_.inbox.size(), 1U);
  while (arm1_.receipts.front() != nullptr) arm1_.receipts.pop();  // the publisher has caught up
  group.run(next(), BusGroup::Ending::kNone);
  EXPECT_EQ(arm1_.inbox.size(), 0U);
  EXPECT_EQ(arm1_.receipts_lost.load(), 0U);
}

TEST_F(BusGroupTest, AFloodIsTakenInPortionsThatOneCycleCanAnswer) {
  auto group = this->group({&arm1_});
  group.run(next(), BusGroup::Ending::kNone);
  for (std::uint64_t id = 1; id <= 100; ++id) arm1_.inbox.push(take_control(id));
  group.run(next(), BusGroup::Ending::kNone);
  EXPECT_EQ(arm1_.inbox.size(), 100U - Cycle::kMaxRequests);
}

TEST_F(BusGroupTest, TheStopImageIsOnTheBusBeforeTheGoodBye) {
  auto group = this->group({&arm1_});
  for (int i = 0; i < 5; ++i) group.run(next(), BusGroup::Ending::kNone);
  for (int i = 0; i < 3; ++i) group.run(next(), BusGroup::Ending::kStop);
  EXPECT_FALSE(seen_.closed);
  group.close(next());
  EXPECT_TRUE(seen_.closed);
  EXPECT_FALSE(seen_.set_point_at_close);
  EXPECT_TRUE(seen_.pause_at_close);
}

TEST_F(BusGroupTest, TheLastRecordSaysThatNobodyIsConnected) {
  auto group = this->group({&arm1_});
  arm1_.inbox.push(take_control(1));
  group.run(next(), BusGroup::Ending::kNone);
  group.run(next(), BusGroup::Ending::kNone);
  group.close(next());
  CycleRecord last;
  std::uint64_t cycle_before = 0;
  while (const CycleRecord* record = arm1_.records.front()) {
    cycle_before = last.cycle;
    last = *record;
    arm1_.records.pop();
  }
  EXPECT_EQ(last.quality, Quality::kDisconnected);
  EXPECT_EQ(last.link, transports::LinkState::kDown);
  EXPECT_EQ(last.link_detail.view(), "the bridge has stopped");
  EXPECT_TRUE(last.closing);
  EXPECT_FALSE(last.control.owned);
  EXPECT_EQ(last.cycle, cycle_before + 1);
}

}  // namespace
}  // namespace meca::bridge
