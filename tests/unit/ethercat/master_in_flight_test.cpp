// Replies find the frame they belong to, once.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "transports/ethercat/in_flight.hpp"

namespace meca::ethercat {
namespace {

using namespace std::chrono_literals;
using Verdict = InFlight::Verdict;

constexpr MacAddress kSource{std::byte{0x10}};

class InFlightTest : public testing::Test {
 protected:
  std::vector<std::byte> send(std::initializer_list<Request> requests, unsigned copies = 1) {
    EXPECT_TRUE(in_flight_.begin(InFlight::Use::kService, 0));
    for (const Request& request : requests) EXPECT_TRUE(in_flight_.add(request));
    const Bytes frame = in_flight_.finish({.count = copies}, 0ms);
    return {frame.begin(), frame.end()};
  }
  // As a device changes it: ADP + 1 of A and B commands, working counter, data.
  static void pass(std::vector<std::byte>& frame, std::uint8_t data) {
    DatagramWalk<std::byte> walk{std::span(frame)};
    while (auto datagram = walk.next()) {
      if (datagram->command() == Command::kBrd) datagram->set_adp(static_cast<std::uint16_t>(datagram->adp() + 1));
      datagram->set_working_counter(static_cast<std::uint16_t>(datagram->working_counter() + 1));
      for (std::byte& byte : datagram->data()) byte |= static_cast<std::byte>(data);
    }
  }
  static std::uint16_t counter(Bytes frame) { return DatagramWalk<const std::byte>(frame).next()->working_counter(); }

  static constexpr Request kStates{Command::kBrd, address_of(0, 0x0130), 2, {}, {}};
  static constexpr Request kOne{Command::kFprd, address_of(0x1001, 0x0130), 2, {}, {}};
  InFlight in_flight_{kSource};
};

TEST_F(InFlightTest, AReplyCompletesItsFrameAndTheSecondOneIsUnexpected) {
  auto frame = send({kStates, kOne});
  pass(frame, 1);
  const auto arrival = in_flight_.received(0, frame);
  ASSERT_EQ(arrival.verdict, Verdict::kComplete);
  EXPECT_EQ(counter(arrival.reply), 1);
  in_flight_.release(*arrival.frame);
  EXPECT_EQ(in_flight_.received(0, frame).verdict, Verdict::kUnexpected);
}

TEST_F(InFlightTest, AnotherCommandAddressLengthOrNumberOfDatagramsDoesNotMatch) {
  const auto frame = send({kOne, kOne});
  // Command; station address; register; data length; index of the second datagram; the "more" bit of the first.
  for (const std::size_t at : {16, 18, 20, 22, 31, 23}) {
    auto other = frame;
    other[at] ^= at == 23 ? std::byte{0x80} : at == 22 ? std::byte{0x01} : std::byte{0x03};
    EXPECT_NE(in_flight_.received(0, other).verdict, Verdict::kComplete) << at;
  }
  EXPECT_EQ(in_flight_.received(0, frame).verdict, Verdict::kComplete);
}

TEST_F(InFlightTest, BroadcastsMayComeBackWithAnotherPositionButNotAnotherRegister) {
  auto frame = send({kStates});
  auto other = frame;
  other[20] ^= std::byte{1};
  EXPECT_EQ(in_flight_.received(0, other).verdict, Verdict::kUnexpected);
  pass(frame, 0);
  EXPECT_EQ(in_flight_.received(0, frame).verdict, Verdict::kComplete);
}

TEST_F(InFlightTest, TwoCopiesAreMergedAndOnePortDoesNotCountTwice) {
  auto primary = send({kStates}, 2);
  auto secondary = primary;
  pass(primary, 0x08);
  pass(secondary, 0x04);
  pass(secondary, 0x04);
  EXPECT_EQ(in_flight_.received(0, primary).verdict, Verdict::kFirstCopy);
  EXPECT_EQ(in_flight_.received(0, primary).verdict, Verdict::kUnexpected);
  const auto arrival = in_flight_.received(1, secondary);
  ASSERT_EQ(arrival.verdict, Verdict::kComplete);
  EXPECT_EQ(counter(arrival.reply), 3);
  EXPECT_EQ(DatagramWalk<const std::byte>(arrival.reply).next()->data()[0], std::byte{0x0C});
}

TEST_F(InFlightTest, AnIndexIsNotUsedAgainWhileItsFrameIsUnderWay) {
  const auto stays = send({kOne});
  for (int i = 0; i < 600; ++i) {
    auto frame = send({kOne});
    EXPECT_NE(frame[17], stays[17]);
    const auto arrival = in_flight_.received(0, frame);
    ASSERT_EQ(arrival.verdict, Verdict::kComplete);
    in_flight_.release(*arrival.frame);
  }
}

TEST_F(InFlightTest, OverdueFramesAreGivenUpAndTheirPlacesFree) {
  for (std::size_t i = 0; i < InFlight::kMostFrames; ++i) send({kOne});
  EXPECT_FALSE(in_flight_.begin(InFlight::Use::kService, 0));
  const InFlight::Timeouts timeouts{.cyclic = 20ms, .service = 4ms};
  EXPECT_EQ(in_flight_.next_overdue(timeouts), 4ms);
  EXPECT_EQ(in_flight_.overdue(timeouts, 3ms), nullptr);
  while (InFlight::Frame* frame = in_flight_.overdue(timeouts, 4ms)) in_flight_.release(*frame);
  EXPECT_FALSE(in_flight_.next_overdue(timeouts));
  EXPECT_TRUE(in_flight_.begin(InFlight::Use::kService, 0));
}

TEST_F(InFlightTest, WhatDoesNotFitLeavesTheFrameAsItWas) {
  ASSERT_TRUE(in_flight_.begin(InFlight::Use::kCyclic, 0));
  Request big{Command::kLrw, 0, 1400, {}, {}};
  EXPECT_TRUE(in_flight_.add(big));
  EXPECT_FALSE(in_flight_.add(big));
  EXPECT_TRUE(in_flight_.add(kStates));
  DatagramWalk<const std::byte> walk(in_flight_.finish({}, 0ms));
  EXPECT_EQ(walk.next()->data().size(), 1400u);
  EXPECT_EQ(walk.next()->command(), Command::kBrd);
  EXPECT_FALSE(walk.next());
}

}  // namespace
}  // namespace meca::ethercat
