// A master with robots on its cable, in simulated time: what the tests of the master stand on. Cables and power can be
// taken away, frames lost, doubled and held up.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "transports/ethercat/chain.hpp"
#include "transports/ethercat/master.hpp"

namespace meca::ethercat::test {

using namespace std::chrono_literals;

// What becomes of a frame that comes back.
struct Fate {
  bool lost = false, doubled = false;
  Time held_up{};
};

inline MasterSettings settings_for(std::size_t robots) {
  MasterSettings out;
  for (std::size_t i = 0; i < robots; ++i) out.robots.push_back({static_cast<std::uint16_t>(i), std::nullopt});
  return out;
}

class Segment {
 public:
  // As many robots as the settings name when `devices` says nothing.
  explicit Segment(const MasterSettings& settings, std::vector<DeviceSettings> devices = {})
      : settings_(settings),
        devices_(make(devices.empty() ? defaults(settings.robots.size()) : devices)),
        chain_(pointers()),
        master_(settings) {
    chain_.set_ring(settings.redundant);
    // No robot is a copy of another.
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      image::InputBytes input{};
      input.fill(static_cast<std::byte>(0x10 + i));
      devices_[i]->set_input(input);
    }
  }

  Master& master() { return *asked_; }
  // Another master takes the first one's place, as after a restart; it outlives the segment's last cycle.
  void go_on_with(Master& other) { asked_ = &other; }
  Device& device(std::size_t i) { return *devices_[i]; }
  Chain& chain() { return chain_; }
  Time now() const { return now_; }

  std::function<Fate(std::size_t frame)> fate;   // of the n-th reply
  std::function<void(Segment&)> every_cycle;     // before begin_cycle()
  std::function<void(Bytes, Chain::Side)> sent;  // sees every frame before the devices do
  std::function<void(Bytes)> came_back;          // and when it has passed them
  std::function<void(bool into)> around_master;  // called before and after every call of the master

  // Cycles; false as soon as `until` holds.
  bool run(Time span, const std::function<bool()>& until = {}) {
    const Time end = now_ + span;
    while (now_ < end) {
      cycle();
      if (until && until()) return true;
    }
    return !until;
  }
  bool all_operational() {
    for (std::size_t i = 0; i < settings_.robots.size(); ++i)
      if (!asked_->station(i).operational()) return false;
    return true;
  }
  bool start(Time within = 20s) {
    return run(within, [this] { return all_operational(); });
  }
  // The master stands still, the devices do not.
  void pause(Time span) {
    for (const Time end = now_ + span; now_ < end; now_ += kStep) tick_devices();
  }
  void set_link(Master::Port port, bool up) { asked_->link_changed(port, up, now_); }

 private:
  static constexpr Time kStep = 100us;
  struct Reply {
    Time at;
    Chain::Side side;
    std::size_t size;
    std::array<std::byte, kLongestFrame> bytes;
  };

  static std::vector<DeviceSettings> defaults(std::size_t count) { return std::vector<DeviceSettings>(count); }
  static std::vector<std::unique_ptr<Device>> make(const std::vector<DeviceSettings>& settings) {
    std::vector<std::unique_ptr<Device>> out;
    for (const DeviceSettings& one : settings) out.push_back(std::make_unique<Device>(one));
    return out;
  }
  std::vector<Device*> pointers() {
    std::vector<Device*> out;
    for (const auto& device : devices_) out.push_back(device.get());
    return out;
  }

  void tick_devices() {
    for (const auto& device : devices_) {
      device->tick(now_);
      device->take_fresh();
    }
  }
  void cycle() {
    if (every_cycle) every_cycle(*this);
    asking_master([this] { asked_->begin_cycle(now_); });
    for (const Time end = now_ + settings_.cycle; now_ < end; now_ += kStep) {
      tick_devices();
      exchange();
    }
  }
  template <class Call>
  void asking_master(Call call) {
    if (around_master) around_master(true);
    call();
    if (around_master) around_master(false);
  }
  void exchange() {
    for (int guard = 0; guard < 1000; ++guard) {
      deliver();
      Bytes frame;
      asking_master([&] { frame = asked_->next_frame(now_); });
      if (frame.empty()) return;
      pass(frame, Chain::Side::kPrimary);
      if (settings_.redundant && asked_->on_both_ports()) pass(frame, Chain::Side::kSecondary);
    }
  }
  void pass(Bytes frame, Chain::Side side) {
    if (sent) sent(frame, side);
    if (waiting_.size() == kMostWaiting) return;
    Reply reply{.at = now_, .side = side, .size = frame.size(), .bytes = {}};
    std::copy(frame.begin(), frame.end(), reply.bytes.begin());
    const auto out = chain_.process(side, std::span(reply.bytes).first(reply.size), now_);
    if (!out) return;
    reply.side = *out;
    if (came_back) came_back(Bytes(reply.bytes).first(reply.size));
    const Fate what = fate ? fate(replies_++) : Fate{};
    if (what.lost) return;
    reply.at += what.held_up;
    waiting_.push_back(reply);
    if (what.doubled) waiting_.push_back(reply);
  }
  void deliver() {
    for (auto reply = waiting_.begin(); reply != waiting_.end();) {
      if (reply->at > now_) {
        ++reply;
        continue;
      }
      const Reply one = *reply;
      reply = waiting_.erase(reply);
      const auto port = one.side == Chain::Side::kPrimary ? Master::Port::kPrimary : Master::Port::kSecondary;
      asking_master([&] { asked_->received(port, Bytes(one.bytes).first(one.size), now_); });
    }
  }

  static constexpr std::size_t kMostWaiting = 256;
  MasterSettings settings_;
  std::vector<std::unique_ptr<Device>> devices_;
  Chain chain_;
  Master master_;
  Master* asked_ = &master_;
  Time now_{};
  std::size_t replies_ = 0;
  std::deque<Reply> waiting_;
};

}  // namespace meca::ethercat::test
