// A master on a chain of robots whose wire lies: replies are changed, lost, repeated and invented, cables and power
// come and go. The master keeps what its header promises and sends nothing but whole frames of its own. Input: one byte
// of settings, then records of one kind byte and its bytes, until they run out.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "tests/fuzz/source.hpp"
#include "transports/ethercat/chain.hpp"
#include "transports/ethercat/master.hpp"

namespace {

using meca::fuzz::Source;

using namespace meca::ethercat;
using namespace std::chrono_literals;
using Port = Master::Port;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "ethercat_master_fuzz: %s\n", what);
  std::abort();
}

constexpr std::size_t kRobots = 3;
constexpr int kMostRecords = 400;

MasterSettings settings_of(std::uint8_t choice) {
  MasterSettings out;
  for (std::uint16_t i = 0; i < kRobots; ++i) out.robots.push_back({i, std::nullopt});
  out.redundant = (choice & 1) != 0;
  out.dc = (choice & 2) != 0;
  out.separate = (choice & 4) != 0;
  if ((choice & 8) != 0) out.robots[1].alias = 5;
  return out;
}

class Bench {
 public:
  explicit Bench(std::uint8_t choice) : settings_(settings_of(choice)), master_(settings_) {
    for (std::size_t i = 0; i < kRobots; ++i) {
      DeviceSettings device;
      if (i == 1) device.alias = 5;
      devices_.push_back(std::make_unique<Device>(device));
    }
    chain_ = std::make_unique<Chain>(std::vector{devices_[0].get(), devices_[1].get(), devices_[2].get()});
    chain_->set_ring(settings_.redundant);
  }

  void step(Source& source) {
    switch (source.take<std::uint8_t>() % 12) {
      case 0:
        return cycles(source.take<std::uint8_t>());
      case 1:  // changed
        flip_at_ = source.take<std::uint16_t>();
        flip_by_ = source.take<std::uint8_t>();
        return cycles(1);
      case 2: {  // invented
        const auto size = source.take<std::uint16_t>();
        return master_.received(port(source), source.take_bytes(size), now_);
      }
      case 3:  // repeated
        return master_.received(port(source), last_, now_);
      case 4:
        lose_ = source.take<std::uint8_t>();
        return;
      case 5:
        return chain_->cut(source.take<std::uint8_t>() % (kRobots + 1));
      case 6:
        return chain_->heal(source.take<std::uint8_t>() % (kRobots + 1));
      case 7:
        return devices_[source.take<std::uint8_t>() % kRobots]->power_cycle(now_);
      case 8:
        return answer(source);
      case 9: {
        const auto which = port(source);
        return master_.link_changed(which, source.take<std::uint8_t>() % 2 != 0, now_);
      }
      case 10:
        if (source.take<std::uint8_t>() < 16) master_.close(now_), closing_ = true;
        return;
      default:
        now_ += Time(source.take<std::uint16_t>() * 1us);
        return;
    }
  }

 private:
  static Port port(Source& source) { return source.take<std::uint8_t>() % 2 == 0 ? Port::kPrimary : Port::kSecondary; }

  void cycles(unsigned count) {
    for (unsigned i = 0; i < count; ++i, now_ += 1ms) {
      for (const auto& device : devices_) device->tick(now_);
      master_.begin_cycle(now_);
      exchange();
      check();
    }
  }
  void exchange() {
    for (int guard = 0;; ++guard) {
      require(guard < 64, "frames without end");
      const Bytes frame = master_.next_frame(now_);
      if (frame.empty()) return;
      look_at(frame);
      pass(frame, Chain::Side::kPrimary);
      if (settings_.redundant && master_.on_both_ports()) pass(sent_, Chain::Side::kSecondary);
    }
  }
  void look_at(Bytes frame) {
    sent_.assign(frame.begin(), frame.end());
    require(frame.size() >= kShortestFrame && frame.size() <= kLongestFrame, "a frame of a forbidden size");
    require(frame[6] == settings_.source[0], "a frame of somebody else");
    DatagramWalk<const std::byte> walk(frame);
    int count = 0;
    while (const auto datagram = walk.next()) {
      ++count;
      require(datagram->working_counter() == 0 && datagram->raw_command() < kCommands, "a datagram nobody can use");
    }
    require(walk.ok() && count > 0, "a frame that is not whole");
  }
  void pass(Bytes frame, Chain::Side side) {
    std::vector<std::byte> bytes(frame.begin(), frame.end());
    const auto out = chain_->process(side, bytes, now_);
    if (!out) return;
    if (flip_by_ != 0) bytes[flip_at_ % bytes.size()] ^= static_cast<std::byte>(flip_by_);
    flip_by_ = 0;
    last_ = bytes;
    if (lose_ > 0) {
      --lose_;
      return;
    }
    master_.received(*out == Chain::Side::kPrimary ? Port::kPrimary : Port::kSecondary, bytes, now_);
  }
  // To what was sent last, with odd contents and working counters: passes every check of the frame.
  void answer(Source& source) {
    const Port which = port(source);
    master_.begin_cycle(now_);
    for (Bytes frame = master_.next_frame(now_); !frame.empty(); frame = master_.next_frame(now_)) {
      look_at(frame);
      DatagramWalk<std::byte> walk{std::span(sent_)};
      while (auto datagram = walk.next()) {
        datagram->set_working_counter(source.take<std::uint8_t>() % 4);
        const auto data = source.take_bytes(source.take<std::uint8_t>() % (datagram->data().size() + 1));
        std::ranges::copy(data, datagram->data().begin());
      }
      master_.received(which, sent_, now_);
    }
    now_ += 1ms;
    check();
  }

  void check() {
    std::size_t operational = 0;
    for (std::size_t i = 0; i < kRobots; ++i) {
      const Station& station = master_.station(i);
      operational += station.operational();
      require(master_.trouble(i).size() <= 255, "a sentence without end");
      require(station.operational() || !master_.trouble(i).empty() || closing_ ||
                  station.phase() != Station::Phase::kAbsent,
              "absent, and not a word why");
      master_.take_fresh(i);
    }
    require(!master_.closed() || closing_, "closed by itself");
    const MasterCounters& counters = master_.counters();
    require(counters.lost_frames <= counters.sent_frames, "more frames lost than sent");
  }

  MasterSettings settings_;
  Master master_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::unique_ptr<Chain> chain_;
  std::vector<std::byte> sent_, last_;
  Time now_{};
  std::size_t flip_at_ = 0;
  std::uint8_t flip_by_ = 0, lose_ = 0;
  bool closing_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source source(data, size);
  Bench bench(source.take<std::uint8_t>());
  for (int i = 0; i < kMostRecords && !source.empty(); ++i) bench.step(source);
  return 0;
}
