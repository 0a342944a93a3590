// EtherCAT in place of the bench's direct link: our master and a chain of one device, with the simulated robot behind
// it, and a cable between them that loses, repeats and is cut. No sockets, simulated time.
#pragma once

#include <optional>
#include <vector>

#include "tests/unit/buses/bus_wire.hpp"
#include "transports/ethercat/chain.hpp"
#include "transports/ethercat/master.hpp"

namespace meca::test {

class EthercatWire : public BusWire {
 public:
  using Time = ethercat::Time;

  // The bench's simulated robot is reached through this wire from now on; `bench` outlives it.
  explicit EthercatWire(Bench& bench)
      : bench_(bench), device_(device_settings(bench.layout)), chain_({&device_}), master_(master_settings(bench)) {
    bench_.wire = [this] { exchange(); };
  }
  ~EthercatWire() override { bench_.wire = nullptr; }

  static CycleSettings settings(CycleSettings s = {}) { return s; }  // 1 ms, as on the built-in robot

  const image::OutputBytes& heard() const override { return device_.output(); }
  bool connected() const override { return device_.operational(); }
  std::uint64_t connections() const override { return connections_; }
  std::string figures() const override {
    const auto& master = master_.counters();
    return "OP reached " + std::to_string(connections_) + " times; of this life: frames lost " +
           std::to_string(master.lost_frames) + ", late " + std::to_string(master.late_frames) + ", unexpected " +
           std::to_string(master.unexpected_frames) + ", scans " + std::to_string(master.scans) +
           "; watchdog expiries " + std::to_string(device_.counters().watchdog_expiries);
  }
  // A robot that goes on with its queue when it loses its host: which of both a Meca500 does is not published.
  void keep_queue_on_loss() { keeps_queue_ = true; }

 private:
  using Frame = std::vector<std::byte>;
  // The owner of the interface looks at its carrier so often (transport.cpp).
  static constexpr Time kLinkPeriod = 100ms;

  static ethercat::DeviceSettings device_settings(Layout layout) {
    ethercat::DeviceSettings s;
    s.layout = layout;
    s.firmware = std::to_string(9 + static_cast<int>(layout)) + ".3.0.1";
    return s;
  }
  static ethercat::MasterSettings master_settings(const Bench& bench) {
    ethercat::MasterSettings s;
    s.robots.resize(1);
    s.cycle = bench.settings.cycle;
    return s;
  }

  void exchange() {
    const Time now = bench_.now;
    if (bench_.cycle.get() != life_) {  // another life of the bridge: nothing is left of the last one
      life_ = bench_.cycle.get();
      if (lives_++ > 0) master_ = ethercat::Master(master_settings(bench_));
      carrier_ = true;
    }
    power(now);
    cable(now);
    device_.tick(now);
    master_.set_output(0, bench_.exchange.output);
    master_.begin_cycle(now);
    bring_late(now);
    for (auto frame = master_.next_frame(now); !frame.empty(); frame = master_.next_frame(now)) {
      carry({frame.begin(), frame.end()}, now);
    }
    device_.tick(now);  // the robot acts on what has just come
    step_robot();
    tell_bridge();
    bench_.lose_output = bench_.lose_input = bench_.repeat_output = bench_.repeat_input = false;
  }

  void power(Time now) {
    const bool present = bench_.sim->present();
    if (present == was_present_) return;
    was_present_ = present;
    chain_.set_powered(0, present);
    device_.power_cycle(now);
    connected_ = false;
  }
  void cable(Time now) {
    bench_.link_up ? chain_.heal(0) : chain_.cut(0);
    const bool carrier = bench_.link_up && bench_.sim->present();
    if (now < next_look_) return;
    next_look_ = now + kLinkPeriod;
    if (carrier != carrier_) master_.link_changed(ethercat::Master::Port::kPrimary, carrier, now);
    carrier_ = carrier;
  }

  void carry(Frame frame, Time now) {
    if (!bench_.link_up || bench_.lose_output) return;
    Frame twice = frame;
    bring_back(frame, now);
    if (bench_.repeat_output) bring_back(twice, now);
  }
  // Through the chain and back. Every second reply that is lost is only late, by a cycle.
  void bring_back(Frame& frame, Time now) {
    if (!chain_.process(ethercat::Chain::Side::kPrimary, frame, now)) return;
    if (bench_.lose_input) {
      if (++lost_replies_ % 2 == 0) late_.push_back(frame);
      return;
    }
    if (bench_.repeat_input && !last_.empty()) master_.received(ethercat::Master::Port::kPrimary, last_, now);
    master_.received(ethercat::Master::Port::kPrimary, frame, now);
    last_ = frame;
  }
  void bring_late(Time now) {
    for (const Frame& frame : late_) {
      if (bench_.link_up) master_.received(ethercat::Master::Port::kPrimary, frame, now);
    }
    late_.clear();
  }

  void step_robot() {
    if (connected_ != device_.operational()) {
      connected_ = device_.operational();
      connections_ += connected_;
      if (!keeps_queue_) connected_ ? bench_.sim->restore_connection() : bench_.sim->drop_connection();
      if (!connected_ && bench_.on_heard) bench_.on_heard({});
    }
    if (device_.take_fresh()) {
      if (bench_.on_heard) bench_.on_heard(device_.output());
      bench_.sim->step(device_.output(), std::endian::little, bench_.settings.cycle);
    } else {
      bench_.sim->step_without_outputs(bench_.settings.cycle);
    }
    image::InputBytes bytes{};
    image::encode_inputs(bench_.sim->inputs(), {bench_.layout}, bytes);
    device_.set_input(bytes);
  }
  void tell_bridge() {
    const ethercat::Station& station = master_.station(0);
    bench_.exchange.link = station.operational() ? LinkState::kUp : LinkState::kDown;
    bench_.exchange.link_detail = master_.trouble(0);
    bench_.exchange.identity = station.firmware();
    bench_.exchange.fresh = master_.take_fresh(0);
    if (bench_.exchange.fresh) bench_.exchange.input = master_.input(0);
  }

  Bench& bench_;
  ethercat::Device device_;
  ethercat::Chain chain_;
  ethercat::Master master_;
  const bridge::Cycle* life_ = nullptr;
  int lives_ = 0;
  bool connected_ = false, was_present_ = true, carrier_ = true, keeps_queue_ = false;
  std::uint64_t connections_ = 0;
  unsigned lost_replies_ = 0;
  Time next_look_{};
  std::vector<Frame> late_;
  Frame last_;
};

}  // namespace meca::test
