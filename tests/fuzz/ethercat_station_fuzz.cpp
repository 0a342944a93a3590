// A robot that answers anything, at any time: the station writes nothing but what its way up needs, asks for OP only
// after process data has run, and keeps what its headers promise. Input: one byte of settings, then steps of one kind
// byte and what it needs, until they run out. Most steps are answers of a device that knows its business, so that every
// phase is reached; the others spoil one. With bit 7 of the settings the steps are transfers of values of any size,
// which a station makes only short ones of.
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/source.hpp"
#include "tests/unit/ethercat/station_fake.hpp"
#include "transports/ethercat/sdo_client.hpp"
#include "transports/ethercat/station.hpp"

namespace {

using namespace meca::ethercat;
using meca::ethercat::station_test::ByteVector;
using meca::ethercat::station_test::FakeDevice;
using meca::fuzz::Source;
using Phase = Station::Phase;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "ethercat_station_fuzz: %s\n", what);
  std::abort();
}

StationSettings settings_of(std::uint8_t choice) {
  StationSettings settings;
  settings.logical_output = 0x10000;
  settings.logical_input = 0x20000;
  settings.dc = (choice & 1) != 0;
  settings.sync0_cycle = std::chrono::milliseconds(1);
  if ((choice & 2) != 0) settings.watchdog = Time{};
  return settings;
}

constexpr SiiIdentity kIdentity{0, kMecademicVendor, kMeca500Product, 1, 7, 0x1000, 128, 0x1080, 128, 4, true};

class Bench {
 public:
  explicit Bench(std::uint8_t choice)
      : device_(static_cast<meca::image::Layout>((choice >> 2) % 3)), station_(settings_of(choice)) {
    device_.dictionary.complete_access = (choice & 0x10) == 0;
    device_.drops_duplicates = (choice & 0x20) == 0;
    device_.repeats_mails = (choice & 0x40) == 0;
    station_.found(0x1001, kIdentity, now_);
  }

  void step(Source& source) {
    const bool closed = station_.phase() == Phase::kClosed;
    switch (source.take<std::uint8_t>() % 16) {
      case 0:
      case 1:
        for (int n = source.take<std::uint8_t>(); n >= 0; --n) live();
        break;
      case 2:
        if (const auto access = look()) {
          const std::uint16_t counter = source.take<std::uint8_t>() % 3;
          station_.answered(counter, source.take_bytes(source.take<std::uint8_t>()), now_);
        }
        break;
      case 3:
        if (look()) station_.lost(now_);
        break;
      case 4:
        spoil(source);
        break;
      case 5: {
        const auto type = source.take<std::uint8_t>();
        device_.post(type % 16, source.take_bytes(source.take<std::uint8_t>() % 123));
        break;
      }
      case 6: {
        const auto status = source.take<std::uint16_t>();
        station_.al_status(status, source.take<std::uint16_t>(), now_);
        break;
      }
      case 7:
        device_.set_status(source.take<std::uint8_t>() % 32, source.take<std::uint8_t>());
        break;
      case 8:
        now_ += std::chrono::milliseconds(source.take<std::uint16_t>());
        break;
      case 9:
        exchange_process_data();
        break;
      case 10:
        station_.absent("not in the chain", now_);
        break;
      case 11:
        station_.found(0x1001 + source.take<std::uint8_t>() % 2, kIdentity, now_);
        break;
      case 12:
        station_.dc_ready(source.take<std::uint64_t>(), now_);
        break;
      case 13:
        if (source.take<std::uint8_t>() < 16) station_.close(now_);
        break;
      case 14: {
        const auto index = source.take<std::uint16_t>();
        const auto sub = source.take<std::uint8_t>();
        device_.dictionary.set(index, sub, source.take_bytes(source.take<std::uint8_t>()));
        break;
      }
      case 15:
        device_.power_cycle();
        break;
    }
    require(!closed || station_.phase() == Phase::kClosed, "closed is for ever");
  }

 private:
  // What it wants, twice, and what of it is allowed.
  std::optional<Access> look() {
    station_.tick(now_);
    const auto access = station_.next(now_);
    const bool operational = station_.operational();
    require(operational == (station_.phase() == Phase::kOperational), "operational in another phase");
    require(operational || station_.phase() == Phase::kClosed || !station_.trouble().empty(), "no word about it");
    require(!operational || station_.trouble().empty(), "operational, and a word about it");
    if (station_.phase() != Phase::kStarting && station_.phase() != Phase::kRecovering) cycles_ = 0;
    if (!access) return access;
    const auto again = station_.next(now_);
    require(again && again->address == access->address && again->size == access->size, "another wish meanwhile");
    require(access->size > 0 && access->size <= Access::kMost, "an access of an impossible size");
    require(access->data.size() == (access->write ? access->size : 0u), "data that is not what is written");
    if (access->write) check_write(*access);
    return access;
  }
  void check_write(const Access& access) {
    const auto within = [&](unsigned first, unsigned end) {
      return access.address >= first && access.address + access.size <= end;
    };
    require(within(0x0120, 0x0122) || within(0x0400, 0x0402) || within(0x0420, 0x0422) || within(0x0500, 0x0501) ||
                within(0x0600, 0x0680) || within(0x0800, 0x0820) || within(0x0980, 0x0982) || within(0x0990, 0x09A8) ||
                within(0x1000, 0x1080),
            "a write to a register that is not its own");
    if (access.address != reg::kAlControl) return;
    const auto control = std::to_integer<unsigned>(access.data[0]);
    const unsigned state = control & 0x0F;
    require(control == 8 ? cycles_ >= kCyclesBeforeOp : state != 3 || (control & 0x10) != 0,
            "OP before process data ran, or BOOT");
  }
  void live() {
    now_ += std::chrono::microseconds(200);
    if (const auto access = look()) {
      const auto answer = device_.access(*access);
      station_.answered(answer.working_counter, answer.data, now_);
    }
    if ((device_.status() & 0x0F) >= 4) exchange_process_data();
  }
  void exchange_process_data() {
    if (!station_.wants_process_data()) return;
    ++cycles_;
    station_.process_data_exchanged(now_);
  }
  void spoil(Source& source) {
    const auto access = look();
    if (!access) return;
    auto answer = device_.access(*access);
    const std::size_t at = source.take<std::uint8_t>();
    const auto bits = static_cast<std::byte>(source.take<std::uint8_t>());
    if (at < answer.data.size()) answer.data[at] ^= bits;
    station_.answered(answer.working_counter, answer.data, now_);
  }

  FakeDevice device_;
  Station station_;
  Time now_{std::chrono::seconds(1)};
  int cycles_ = 0;
};

// A client of objects in place of the station. The first value that it writes, and nothing but losses on the way, is
// in the object when it is done.
class Transfers {
 public:
  explicit Transfers(std::uint8_t choice) {
    device_.set_status(static_cast<std::uint16_t>(AlState::kPreop), 0);
    device_.repeats_mails = (choice & 0x40) == 0;
  }

  void step(Source& source) {
    switch (source.take<std::uint8_t>() % 8) {
      case 0:
        for (int n = source.take<std::uint8_t>(); n >= 0; --n) exchange();
        break;
      case 1:
        honest_ = transfers_++ == 0;
        written_.assign(source.take<std::uint16_t>() % (SdoClient::kMostValue + 2), std::byte{0x5A});
        client_.download(kObject, written_, now_);
        break;
      case 2:
        honest_ = false;
        ++transfers_;
        client_.upload({kObject.index, source.take<std::uint8_t>()}, source.take<std::uint8_t>() % 2 != 0, now_);
        break;
      case 3:
        if (look()) client_.lost(now_);
        break;
      case 4:
        if (const auto access = look()) {
          device_.access(*access);
          client_.lost(now_);
        }
        break;
      case 5: {
        honest_ = false;
        const std::size_t at = source.take<std::uint8_t>();
        exchange(at, static_cast<std::byte>(source.take<std::uint8_t>()));
        break;
      }
      case 6: {
        honest_ = false;
        ++transfers_;
        const auto type = source.take<std::uint8_t>();
        device_.post(type % 16, source.take_bytes(source.take<std::uint8_t>() % 123));
        break;
      }
      case 7:
        now_ += std::chrono::milliseconds(source.take<std::uint16_t>());
        break;
    }
    check();
  }

 private:
  static constexpr SdoAddress kObject{0x2F00, 0};

  std::optional<Access> look() {
    now_ += std::chrono::microseconds(200);
    client_.tick(now_);
    const auto access = client_.next(now_);
    if (!access) return access;
    require(access->size > 0 && access->size <= Access::kMost, "an access of an impossible size");
    require(access->address == 0x1000 || access->address == 0x1080 || access->address == 0x080D ||
                access->address == 0x080E,
            "an access that is not to the mailbox");
    return access;
  }
  void exchange(std::size_t spoil_at = Access::kMost, std::byte bits = {}) {
    const auto access = look();
    if (!access) return;
    auto answer = device_.access(*access);
    if (spoil_at < answer.data.size()) answer.data[spoil_at] ^= bits;
    client_.answered(answer.working_counter, answer.data, now_);
  }
  void check() {
    const auto outcome = client_.outcome();
    require(client_.value().size() <= SdoClient::kMostValue, "a value that is longer than there is room for");
    require(outcome != AccessMachine::Outcome::kFailed || !client_.trouble().view().empty(), "no word about it");
    if (!honest_ || outcome != AccessMachine::Outcome::kDone) return;
    ByteVector now;
    require(device_.dictionary.read(kObject, false, now) == 0 && now == written_, "done, and another value");
  }

  FakeDevice device_;
  StationCounters counters_;
  MailboxClient mailbox_{{std::chrono::milliseconds(100), std::chrono::seconds(2)}, counters_};
  SdoClient client_{mailbox_, counters_};
  Time now_{std::chrono::seconds(1)};
  ByteVector written_;
  int transfers_ = 0;
  bool honest_ = false;
};

template <class World>
void run(World world, Source& source) {
  while (!source.empty()) world.step(source);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source source(data, size);
  const auto choice = source.take<std::uint8_t>();
  if ((choice & 0x80) != 0)
    run(Transfers(choice), source);
  else
    run(Bench(choice), source);
  return 0;
}
