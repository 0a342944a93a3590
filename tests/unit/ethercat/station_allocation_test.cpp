// Stations run in the cycle thread: after construction they must not allocate, whatever happens.

#include <gtest/gtest.h>

#include "tests/allocations.hpp"
#include "tests/unit/ethercat/station_rig.hpp"

namespace meca::ethercat::station_test {
namespace {

// The fake device allocates; the calls into the station are counted alone.
class Counted {
 public:
  explicit Counted(Station& station) : station_(station) {}
  std::uint64_t allocations = 0;
  template <class Call>
  auto operator()(Call call) {
    struct Sum {
      std::uint64_t& total;
      std::uint64_t before = test::allocations;
      ~Sum() { total += test::allocations - before; }
    } sum{allocations};
    return call(station_);
  }

 private:
  Station& station_;
};

struct CountedRig {
  FakeDevice device;
  Station station{usual_settings()};
  Counted call{station};
  Time now = 1s;
  std::size_t accesses = 0;

  void run(Time time, std::size_t lose_every = 0) {
    for (const Time end = now + time; now < end; now += 250us) {
      call([&](Station& s) { s.tick(now); });
      const auto access = call([&](Station& s) { return s.next(now); });
      if (access) answer(*access, lose_every);
      call([&](Station& s) {
        if (s.wants_process_data()) s.process_data_exchanged(now);
        return s.trouble().size() + static_cast<std::size_t>(s.next_event().count() != 0);
      });
    }
  }
  void answer(const Access& access, std::size_t lose_every) {
    const auto answer = device.access(access);
    ++accesses;
    call([&](Station& s) {
      if (lose_every != 0 && accesses % lose_every == 0) return s.lost(now);
      s.answered(answer.working_counter, answer.data, now);
    });
  }
  void see(std::uint16_t status, std::uint16_t code) {
    device.set_status(status, code);
    call([&](Station& s) { s.al_status(status, code, now); });
  }
};

TEST(StationAllocation, NeverHappensAfterConstruction) {
  CountedRig rig;
  rig.call([&](Station& s) { s.found(0x1001, StationRig::kIdentity, rig.now); });
  rig.run(2s, 7);
  ASSERT_TRUE(rig.station.operational()) << rig.station.trouble();
  rig.see(0x14, 0x001B);  // acknowledged
  rig.run(1s);
  ASSERT_TRUE(rig.station.operational());
  rig.device.refuse[AlState::kSafeop] = 0x0025;
  rig.see(0x01, 0);  // configured again, and refused with a sentence
  rig.run(2s);
  ASSERT_FALSE(rig.station.operational());
  rig.device.refuse.clear();
  rig.call([&](Station& s) { s.absent("not in the chain", rig.now); });
  rig.call([&](Station& s) { s.found(0x1001, StationRig::kIdentity, rig.now); });
  rig.run(2s);
  ASSERT_TRUE(rig.station.operational());
  rig.call([&](Station& s) { s.close(rig.now); });
  rig.run(1s);
  EXPECT_EQ(rig.station.phase(), Phase::kClosed);
  EXPECT_EQ(rig.call.allocations, 0u);
}

}  // namespace
}  // namespace meca::ethercat::station_test
