// Reading the SII: words over registers, busy, refused, lost, and by 4 or 8 bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "transports/ethercat/sii_reader.hpp"

namespace meca::ethercat::station_test {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::StartsWith;
using ByteVector = std::vector<std::byte>;

// Registers 0500 to 050F with an EEPROM behind them.
class FakeSii {
 public:
  ByteVector image = make_meca500_sii(0x0102, 4711);
  bool eight_bytes = false;
  int busy_reads = 0;                                      // so many readings of the status see it busy after a command
  int refusals = 0;                                        // so many commands are refused
  bool deaf = false;                                       // commands are not taken
  std::size_t gone_from = 1'000'000, uncounted_every = 0;  // accesses that nobody counts
  std::vector<int> owners;
  int commands = 0, clears = 0;

  std::pair<std::uint16_t, ByteVector> access(const Access& access) {
    const std::size_t n = accesses_++;
    if (n >= gone_from || (uncounted_every != 0 && n % uncounted_every == 0)) return {0, ByteVector(access.size)};
    if (access.address == reg::kSiiOwner) owners.push_back(std::to_integer<int>(access.data[0]));
    if (access.address != reg::kSiiControl) return {1, ByteVector(access.size)};
    return access.write ? write(access.data) : std::pair<std::uint16_t, ByteVector>{1, status(access.size)};
  }

 private:
  std::pair<std::uint16_t, ByteVector> write(Bytes data) {
    const int command = std::to_integer<int>(data[1]);
    if (command == 0) {
      ++clears;
      error_ = false;
    } else if (!deaf) {
      ++commands;
      busy_ = busy_reads;
      error_ = refusals > 0 && refusals-- > 0;
      if (!error_) address_ = std::to_integer<std::size_t>(data[2]);
    }
    return {1, {}};
  }
  ByteVector status(std::size_t size) {
    const bool busy = busy_ > 0 && busy_-- > 0;
    ByteVector out(14);
    out[0] = std::byte{eight_bytes ? std::uint8_t{0x40} : std::uint8_t{0}};
    out[1] = std::byte{static_cast<std::uint8_t>((busy ? 0x80 : 0) | (error_ ? 0x20 : 0))};
    out[2] = static_cast<std::byte>(address_);
    if (!busy)
      std::copy_n(image.begin() + static_cast<std::ptrdiff_t>(2 * address_), eight_bytes ? 8 : 4, out.begin() + 6);
    out.resize(size);
    return out;
  }
  std::size_t address_ = 0, accesses_ = 0;
  int busy_ = 0;
  bool error_ = false;
};

enum class Loss : std::uint8_t { kNothing, kRequest, kReply };

struct SiiRig {
  FakeSii device;
  SiiReader reader;
  Time now = 1s;
  std::size_t count = 0;
  std::function<Loss(std::size_t)> loses;

  void run(Time limit = 5s) {
    reader.start(now);
    for (const Time end = now + limit; now < end && !reader.done() && !reader.failed(); now += 100us) {
      reader.tick(now);
      const auto access = reader.next(now);
      if (!access) continue;
      const Loss loss = loses ? loses(count) : Loss::kNothing;
      ++count;
      if (loss != Loss::kRequest) {
        const auto [counter, data] = device.access(*access);
        if (loss == Loss::kNothing) {
          reader.answered(counter, data, now);
          continue;
        }
      }
      reader.lost(now += 4ms);
    }
  }
};

TEST(StationSiiReader, ReadsWhoTheDeviceIs) {
  for (const bool eight : {false, true}) {
    SiiRig rig;
    rig.device.eight_bytes = eight;
    rig.run();
    ASSERT_TRUE(rig.reader.done()) << rig.reader.trouble();
    EXPECT_EQ(rig.reader.identity(), *parse_sii_identity(rig.device.image));
    EXPECT_EQ(rig.reader.identity().vendor, kMecademicVendor);
    EXPECT_EQ(rig.reader.identity().serial, 4711u);
    EXPECT_TRUE(rig.reader.identity().checksum_right);
    EXPECT_EQ(rig.device.commands, eight ? 8 : 16);
  }
}

TEST(StationSiiReader, TakesTheSiiAndGivesItBack) {
  SiiRig rig;
  rig.run();
  EXPECT_THAT(rig.device.owners, ElementsAre(2, 0, 1));
}

TEST(StationSiiReader, WaitsWhileItIsBusy) {
  SiiRig rig;
  rig.device.busy_reads = 7;
  rig.run();
  ASSERT_TRUE(rig.reader.done()) << rig.reader.trouble();
  EXPECT_EQ(rig.device.commands, 16);
}

TEST(StationSiiReader, HasItsTimeForEveryReadAnew) {
  SiiRig rig;
  rig.device.busy_reads = 400;  // 0.2 s
  rig.run();
  EXPECT_TRUE(rig.reader.done()) << rig.reader.trouble();
}

TEST(StationSiiReader, ClearsARefusalAndAsksAgain) {
  SiiRig rig;
  rig.device.refusals = 3;
  rig.run();
  ASSERT_TRUE(rig.reader.done()) << rig.reader.trouble();
  EXPECT_EQ(rig.device.clears, 3);
  EXPECT_EQ(rig.reader.identity(), *parse_sii_identity(rig.device.image));
}

TEST(StationSiiReader, SaysThatTheChecksumIsWrong) {
  SiiRig rig;
  rig.device.image[4] ^= std::byte{1};
  rig.run();
  ASSERT_TRUE(rig.reader.done());
  EXPECT_FALSE(rig.reader.identity().checksum_right);
  EXPECT_EQ(rig.reader.identity().vendor, kMecademicVendor);
}

TEST(StationSiiReader, ReadsTheSameWhateverFrameIsLost) {
  SiiRig good;
  good.run();
  ASSERT_GT(good.count, 30u);
  for (const Loss how : {Loss::kRequest, Loss::kReply}) {
    for (std::size_t k = 0; k < good.count; ++k) {
      SiiRig rig;
      rig.loses = [=](std::size_t n) { return n == k ? how : Loss::kNothing; };
      rig.run();
      ASSERT_TRUE(rig.reader.done()) << k;
      ASSERT_EQ(rig.reader.identity(), good.reader.identity()) << k;
    }
  }
}

TEST(StationSiiReader, SaysWhatStandsInTheWay) {
  const auto trouble_of = [](auto spoil) {
    SiiRig rig;
    spoil(rig);
    rig.run();
    EXPECT_TRUE(rig.reader.failed());
    return std::string(rig.reader.trouble());
  };
  EXPECT_THAT(trouble_of([](SiiRig& r) { r.loses = [](std::size_t) { return Loss::kReply; }; }),
              StartsWith("it does not answer when its SII is read"));
  EXPECT_THAT(trouble_of([](SiiRig& r) { r.device.busy_reads = 1'000'000; }), StartsWith("its SII stays busy"));
  EXPECT_THAT(trouble_of([](SiiRig& r) { r.device.refusals = 1'000'000; }), StartsWith("its SII refuses to be read"));
  EXPECT_THAT(trouble_of([](SiiRig& r) { r.device.deaf = true; }), StartsWith("its SII does not give what is asked"));
}

// A device that is switched off has lost its address: frames come back, and nobody has counted in them.
TEST(StationSiiReader, DoesNotWaitForADeviceThatIsGone) {
  for (const std::size_t gone_from : {0u, 10u}) {
    SiiRig rig;
    rig.device.gone_from = gone_from;
    rig.run();
    ASSERT_TRUE(rig.reader.failed());
    EXPECT_THAT(std::string(rig.reader.trouble()), StartsWith("it does not answer when its SII is read"));
    EXPECT_EQ(rig.count, gone_from + 21);
  }
}

TEST(StationSiiReader, IsNotDisturbedByAFewAnswersThatNobodyCounted) {
  SiiRig rig;
  rig.device.uncounted_every = 2;
  rig.run();
  EXPECT_TRUE(rig.reader.done()) << rig.reader.trouble();
}

TEST(StationSiiReader, WantsTheSameUntilItIsAnswered) {
  SiiReader reader;
  reader.start(1s);
  for (int i = 0; i < 3; ++i) {
    const auto access = reader.next(1s);
    ASSERT_TRUE(access);
    EXPECT_EQ(access->address, reg::kSiiOwner);
  }
  reader.lost(1s);
  ASSERT_TRUE(reader.next(1s));
}

}  // namespace
}  // namespace meca::ethercat::station_test
