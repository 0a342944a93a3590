// Random faults on the bench's direct link, and the referee who judges what comes after them.
#include "tests/unit/control/fault_theatre.hpp"

namespace meca::test {
namespace {

TEST(FaultAndRecoveryReferee, sees_every_way_to_set_a_robot_going) {
  const auto image = [](std::initializer_list<std::pair<std::size_t, unsigned>> bytes) {
    std::array<std::byte, 60> out{};
    for (const auto& [at, value] : bytes) out[at] = static_cast<std::byte>(value);
    return out;
  };
  const auto faults = [&](auto first, auto second, bool busy = false, Layout layout = Layout::kFirmware11) {
    Referee referee(layout);
    referee.judge(first, 0, busy);
    return referee.judge(second, 0, busy).size();
  };
  const auto still = image({});
  EXPECT_EQ(faults(still, still), 0u);
  EXPECT_EQ(faults(still, image({{4, 7}, {6, 1}, {8, 1}})), 1u);            // MoveID 7, SetPoint
  EXPECT_EQ(faults(still, image({{4, 7}, {8, 1}})), 0u);                    // without SetPoint nothing is taken
  EXPECT_EQ(faults(image({{4, 7}, {6, 1}}), image({{4, 7}, {6, 1}})), 0u);  // the same MoveID again
  EXPECT_EQ(faults(still, image({{6, 1}, {8, 21}, {15, 0x41}})), 1u);       // MoveJointsVel, 8 deg/s
  EXPECT_EQ(faults(still, image({{6, 1}, {8, 21}})), 0u);                   // zero velocity
  EXPECT_EQ(faults(still, image({{6, 8}})), 1u);                            // ResumeMotion
  EXPECT_EQ(faults(image({{6, 8}}), image({{6, 8}})), 0u);                  // no edge
  EXPECT_EQ(faults(still, image({{0, 2}})) + faults(still, image({{0, 4}})) + faults(still, image({{0, 8}})), 3u);
  EXPECT_EQ(faults(image({{6, 2}}), still, true, Layout::kFirmware9), 1u);  // Pause falls, something is queued
  EXPECT_EQ(faults(image({{6, 2}}), still, false, Layout::kFirmware9), 0u);
  EXPECT_EQ(faults(image({{6, 2}}), still, true, Layout::kFirmware11), 0u);
  Referee referee(Layout::kFirmware11);
  referee.grant(Right::kCommand);
  EXPECT_EQ(referee.judge(image({{4, 7}, {6, 1}, {8, 1}}), 0, false).size(), 0u);
  referee.revoke();
  EXPECT_EQ(referee.judge(image({{4, 8}, {6, 1}, {8, 1}}), 7, false).size(), 1u);
}

class FaultAndRecovery : public testing::TestWithParam<std::tuple<Layout, int>> {};

TEST_P(FaultAndRecovery, set_nothing_going_that_nobody_asked_for_after_the_fault) {
  const auto [layout, echo_cycles] = GetParam();
  Theatre(layout, echo_cycles, 7).play(fault_sequences(1000));
}

INSTANTIATE_TEST_SUITE_P(Firmware, FaultAndRecovery,
                         testing::Combine(testing::Values(Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11),
                                          testing::Values(0, 2)),
                         [](const auto& info) {
                           return "firmware_" + std::to_string(9 + static_cast<int>(std::get<0>(info.param))) +
                                  "_echo_after_" + std::to_string(std::get<1>(info.param)) + "_cycles";
                         });

}  // namespace
}  // namespace meca::test
