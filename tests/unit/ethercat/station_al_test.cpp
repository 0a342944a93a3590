// One step of the AL state machine, by what register 0130 says from look to look.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "transports/ethercat/al_request.hpp"

namespace meca::ethercat::station_test {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using Outcome = AccessMachine::Outcome;

struct Seen {
  std::uint8_t status;
  std::uint16_t code = 0;
};

struct AlRig {
  StationCounters counters;
  AlRequest request{counters};
  std::vector<int> written;  // low bytes of 0120

  // `seen`: one after the other; the last stays.
  Outcome ask(AlState target, std::vector<Seen> seen) {
    Time now = 1s;
    std::size_t look = 0;
    request.start(target, 2s, now);
    for (; request.running(); now += 100us) {
      request.tick(now);
      const auto access = request.next(now);
      if (!access) continue;
      if (access->write) {
        written.push_back(std::to_integer<int>(access->data[0]));
        request.answered(1, {}, now);
        continue;
      }
      const Seen& s = seen[std::min(look++, seen.size() - 1)];
      const std::array<std::byte, 6> data{std::byte{s.status},
                                          std::byte{0},
                                          std::byte{0},
                                          std::byte{0},
                                          static_cast<std::byte>(s.code & 0xFF),
                                          static_cast<std::byte>(s.code >> 8)};
      request.answered(1, data, now);
    }
    return request.outcome();
  }
  std::string trouble() const { return std::string(request.trouble().view()); }
};

TEST(StationAl, AsksAndWaits) {
  AlRig rig;
  EXPECT_EQ(rig.ask(AlState::kPreop, {{1}, {1}, {1}, {2}}), Outcome::kDone);
  EXPECT_THAT(rig.written, ElementsAre(0x02));
}

TEST(StationAl, AcknowledgesOnceAndWaitsUntilTheErrorIsGone) {
  AlRig rig;
  EXPECT_EQ(rig.ask(AlState::kOp, {{0x14, 0x1B}, {0x14, 0x1B}, {0x14, 0x1B}, {4}, {4}, {8}}), Outcome::kDone);
  EXPECT_THAT(rig.written, ElementsAre(0x14, 0x08));
}

TEST(StationAl, SaysThatAnErrorCannotBeAcknowledged) {
  AlRig rig;
  EXPECT_EQ(rig.ask(AlState::kOp, {{0x14, 0x20}}), Outcome::kFailed);
  EXPECT_THAT(rig.trouble(),
              StartsWith("stays in SAFEOP with an error that cannot be acknowledged: AL status code 0x0020"));
}

TEST(StationAl, IsDoneWhereTheDeviceIsFurtherAlready) {
  AlRig rig;
  EXPECT_EQ(rig.ask(AlState::kSafeop, {{8}}), Outcome::kDone);
  EXPECT_TRUE(rig.written.empty());
}

TEST(StationAl, AsksForInitWhateverStandsAndIsPatientWithAnOldError) {
  AlRig rig;
  EXPECT_EQ(rig.ask(AlState::kInit, {{0x14, 0x1B}, {0x14, 0x1B}, {0x11, 0x1B}, {1}}), Outcome::kDone);
  EXPECT_THAT(rig.written, ElementsAre(0x11));
}

TEST(StationAl, DoesNotTakeAHigherStateForInit) {
  AlRig rig;
  EXPECT_EQ(rig.ask(AlState::kInit, {{8}, {8}, {1}}), Outcome::kDone);
  AlRig stuck;
  EXPECT_EQ(stuck.ask(AlState::kInit, {{8}}), Outcome::kFailed);
  EXPECT_EQ(stuck.trouble(), "stays in OP, INIT was not reached within 2000 ms; restart it if it stays so");
}

TEST(StationAl, AsksNothingOfADeviceThatFellBelow) {
  for (const auto& [target, status] :
       {std::pair{AlState::kOp, 2}, {AlState::kSafeop, 1}, {AlState::kPreop, 3}, {AlState::kSafeop, 3}}) {
    AlRig rig;
    EXPECT_EQ(rig.ask(target, {{static_cast<std::uint8_t>(status)}}), Outcome::kFailed);
    EXPECT_TRUE(rig.written.empty());
    EXPECT_THAT(rig.trouble(), HasSubstr("it was restarted, or another master is at work"));
  }
}

TEST(StationAl, TellsARefusalWithItsCode) {
  AlRig rig;
  EXPECT_EQ(rig.ask(AlState::kOp, {{4}, {4}, {0x14, 0x1B}}), Outcome::kFailed);
  EXPECT_THAT(rig.trouble(), StartsWith("refuses OP: AL status code 0x001B, sync manager watchdog"));
}

}  // namespace
}  // namespace meca::ethercat::station_test
