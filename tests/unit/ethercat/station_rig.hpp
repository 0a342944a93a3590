// A station and a fake device with a wire between them that can lose frames; time is moved by hand.
#pragma once

#include <gtest/gtest.h>

#include "tests/unit/ethercat/station_fake.hpp"
#include "transports/ethercat/station.hpp"

namespace meca::ethercat::station_test {

using Phase = Station::Phase;

struct Wire {
  enum class Loss : std::uint8_t { kNothing, kRequest, kReply };
  std::function<Loss(std::size_t n, const Access&)> loses;  // n: accesses so far
  std::vector<Access> log;                                  // without the data
  std::size_t count = 0;

  Loss passes(const Access& access) {
    log.push_back(access);
    log.back().data = {};
    const std::size_t n = count++;
    return loses ? loses(n, access) : Loss::kNothing;
  }
};

inline StationSettings usual_settings() {
  StationSettings settings;
  settings.logical_output = 0x00010000;
  settings.logical_input = 0x00020000;
  return settings;
}

class StationRig {
 public:
  explicit StationRig(StationSettings settings = usual_settings(), image::Layout layout = image::Layout::kFirmware11)
      : device(layout), station(settings) {}

  FakeDevice device;
  Station station;
  Wire wire;
  Time now = 1s;
  bool process_data = true;
  bool rounds = true;  // the master looks at the AL status now and then
  struct Spoil {       // what comes back of one access
    std::size_t access, byte;
    bool cut;
  };
  std::optional<Spoil> spoil;
  static constexpr SiiIdentity kIdentity{0, kMecademicVendor, kMeca500Product, 1, 7, 0x1000, 128, 0x1080, 128, 4, true};

  void find() { station.found(0x1001, kIdentity, now); }
  // One access there and back, and what else happens meanwhile.
  void step() {
    now += 100us;
    station.tick(now);
    if (const auto access = station.next(now)) exchange(*access);
    if (process_data && station.wants_process_data() && (device.status() & 0x0F) >= 4 && device.powered) {
      station.process_data_exchanged(now);
    }
    if (rounds && ++steps_ % 100 == 0 && device.powered) {
      const auto status = device.memory(reg::kAlStatus, 6);
      station.al_status(number(status, 0), number(status, 4), now);
    }
  }
  void exchange(const Access& access) {
    const ByteVector data(access.data.begin(), access.data.end());
    Access kept = access;
    kept.data = data;
    const auto loss = wire.passes(kept);
    if (loss == Wire::Loss::kRequest) return lost();
    auto answer = device.access(kept);
    if (loss == Wire::Loss::kReply) return lost();
    if (spoil && wire.count - 1 == spoil->access) {
      if (spoil->cut) answer.data.resize(spoil->byte);
      if (!spoil->cut) answer.data[spoil->byte] ^= std::byte{0xFF};
    }
    station.answered(answer.working_counter, answer.data, now);
  }
  bool run_until(Phase phase, Time limit = 20s) {
    for (const Time end = now + limit; now < end && station.phase() != phase;) step();
    return station.phase() == phase;
  }
  void run(Time time) {
    for (const Time end = now + time; now < end;) step();
  }
  testing::AssertionResult climbs(Time limit = 20s) {
    find();
    if (run_until(Phase::kOperational, limit)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << station.trouble();
  }
  std::string trouble() const { return std::string(station.trouble()); }

 private:
  static std::uint16_t number(const ByteVector& bytes, std::size_t at) {
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[at]) | std::to_integer<unsigned>(bytes[at + 1])
                                                                                 << 8);
  }
  void lost() {
    now += 4ms;
    station.lost(now);
  }
  std::size_t steps_ = 0;
};

}  // namespace meca::ethercat::station_test
