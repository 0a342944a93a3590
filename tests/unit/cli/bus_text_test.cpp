// Counters as the fieldbuses name them -> words.
#include "cli/bus_text.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/cli/samples.hpp"

namespace meca::cli {
namespace {

meca500::BridgeStatus with(std::vector<meca500::TransportCounter> counters) {
  meca500::BridgeStatus status;
  status.transport_counters(std::move(counters));
  return status;
}

TEST(BusText, SaysNothingOfWhatNeverHappened) {
  const auto status = with({counter("al_state", 0), counter("lost_frames", 0), counter("ring_open", 0),
                            counter("round_trip_p50", 0, "us"), counter("round_trip_max", 0, "us")});
  EXPECT_EQ(bus_counts_text(status), "");
  EXPECT_EQ(bus_timing_text(status), "");
}

TEST(BusText, NamesStatesBeforeItCounts) {
  EXPECT_EQ(bus_counts_text(
                with({counter("al_state", 8), counter("al_status_code", 0), counter("images", 81234),
                      counter("port0_rx_errors", 3), counter("dc_difference", -12, "ns"), counter("ring_open", 1)})),
            "OP; ring open; images 81234, port0 rx errors 3, DC difference -12 ns");
}

TEST(BusText, SaysWhatAnAlStatusCodeMeans) {
  EXPECT_EQ(bus_counts_text(with({counter("al_state", 0x14), counter("al_status_code", 0x1F), counter("emergencies", 1),
                                  counter("emergency_code", 0xA000)})),
            "SAFEOP with an error; AL status 0x001F, invalid watchdog configuration: the watchdog of the outputs is "
            "off or too short; last emergency 0xA000; emergencies 1");
}

TEST(BusText, TellsFiguresOfOneKindInOnePhraseWithOneUnit) {
  const auto status =
      with({counter("images", 5), counter("round_trip_p50", 55, "us"), counter("round_trip_p99", 120, "us"),
            counter("round_trip_p999", 390, "us"), counter("round_trip_max", 812, "us"),
            counter("wake_up_p50", 0, "us"), counter("wake_up_max", 90, "us"), counter("lost_frames", 1)});
  EXPECT_EQ(bus_timing_text(status),
            "round trip 55 us (p50), 120 (p99), 390 (p99.9), 812 (max); wake-up 0 us (p50), 90 (max)");
  EXPECT_EQ(bus_counts_text(status), "images 5, lost frames 1");
}

TEST(BusText, KeepsMeasurementsOfDifferentUnitsApart) {
  EXPECT_EQ(bus_timing_text(with({counter("send_period_mean", 10000, "us"), counter("send_period_max", 11000, "us"),
                                  counter("send_period_deviation", 12345, "ns")})),
            "send period 10000 us (mean), 11000 (max); send period 12345 ns (deviation)");
}

TEST(BusText, KnowsTheIntervalsOfEthernetIpByTheirName) {
  EXPECT_EQ(bus_counts_text(with({counter("sent_packets", 812), counter("api_o_to_t", 10000, "us"),
                                  counter("api_t_to_o", 10000, "us")})),
            "sent packets 812, API O->T 10000 us, API T->O 10000 us");
}

}  // namespace
}  // namespace meca::cli
