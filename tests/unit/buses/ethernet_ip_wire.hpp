// EtherNet/IP in place of the bench's direct link: our originator and the robot's adapter, with the simulated robot
// behind it, and a network between them that loses, repeats and is cut. No sockets, simulated time.
#pragma once

#include <optional>
#include <vector>

#include "tests/unit/buses/bus_wire.hpp"
#include "transports/ethernet_ip/adapter.hpp"
#include "transports/ethernet_ip/originator.hpp"
#include "transports/image/codec.hpp"

namespace meca::test {

class EthernetIpWire : public BusWire {
 public:
  using Time = ethernet_ip::Time;
  static constexpr auto kRpi = 10ms;
  static constexpr std::uint32_t kHost = 0x0A000001, kRobot = 0x0A000002;

  // The bench's simulated robot is reached through this wire from now on; `bench` outlives it.
  explicit EthernetIpWire(Bench& bench) : bench_(bench), adapter_(adapter_settings()), originator_(originator(1)) {
    bench_.wire = [this] { exchange(); };
  }
  ~EthernetIpWire() override { bench_.wire = nullptr; }

  static CycleSettings settings(CycleSettings s = {}) {
    s.cycle = kRpi;
    s.stale_after = 3 * kRpi;
    s.lease = 100 * kRpi;  // as many cycles as by default
    s.velocity_lease = 50 * kRpi;
    return s;
  }

  const image::OutputBytes& heard() const override { return adapter_.output(); }
  bool connected() const override { return adapter_.connected(); }
  std::uint64_t connections() const override { return adapter_.counters().opens; }
  std::string figures() const override {
    const auto& originator = originator_.counters();
    return "connections opened " + std::to_string(connections()) + "; of this life: watchdog trips " +
           std::to_string(originator.watchdog_trips) + ", lost " + std::to_string(originator.lost) + ", stale " +
           std::to_string(originator.stale);
  }

 private:
  static ethernet_ip::AdapterSettings adapter_settings() {
    ethernet_ip::AdapterSettings s;
    s.identity.vendor_id = ethernet_ip::kMecademicVendor;
    s.identity.device_type = ethernet_ip::kRobotDeviceType;
    s.identity.product_code = ethernet_ip::kMeca500ProductCode;
    s.identity.major = 11;
    s.identity.minor = 3;
    s.identity.set_name("Meca500");
    s.address = kRobot;
    return s;
  }
  static ethernet_ip::Originator originator(std::uint16_t serial) {
    ethernet_ip::OriginatorSettings s;
    s.vendor_id = 0xFFFF;
    s.serial_number = 4711;
    s.incarnation = serial;
    s.address = kRobot;
    s.tick = kRpi;
    return ethernet_ip::Originator(s, static_cast<std::uint16_t>(serial * 1000));
  }

  bool reachable() const { return bench_.link_up && bench_.sim->present(); }

  void exchange() {
    const Time now = bench_.now;
    if (bench_.cycle.get() != life_) {  // another life of the bridge
      life_ = bench_.cycle.get();
      if (lives_++ > 0) originator_ = originator(lives_);
    }
    if (!bench_.sim->present() && was_present_) {
      adapter_.power_cycle();
      connected_ = false;
    }
    was_present_ = bench_.sim->present();
    originator_.tick(now);
    adapter_.tick(now);
    connect(now);
    carry_outputs(now);
    carry_tcp(now);
    step_robot();
    carry_inputs(now);
    bench_.exchange.link = originator_.running() ? LinkState::kUp : LinkState::kDown;
    bench_.exchange.fresh = originator_.take_fresh();
    if (bench_.exchange.fresh) bench_.exchange.input = originator_.input();
    bench_.lose_output = bench_.lose_input = bench_.repeat_output = bench_.repeat_input = false;
  }

  void connect(Time now) {
    if (!originator_.wants_tcp()) {
      tcp_ = false;
      return;
    }
    if (tcp_ || !reachable()) return;
    adapter_.tcp_closed(0, now);  // whatever was left of an earlier one
    adapter_.tcp_accepted(0, kHost, now);
    originator_.tcp_connected(now, kHost);
    tcp_ = true;
  }
  void carry_tcp(Time now) {
    if (!tcp_ || !reachable()) return;
    for (int turns = 0; turns < 4; ++turns) {
      const auto asked = copy(originator_.tcp_output());
      originator_.tcp_sent(asked.size());
      if (!asked.empty()) adapter_.tcp_received(0, asked, now);
      const auto answered = copy(adapter_.tcp_output(0));
      adapter_.tcp_sent(0, answered.size());
      if (!answered.empty()) originator_.tcp_received(answered, now);
    }
    if (!adapter_.wants_closed(0)) return;
    adapter_.tcp_closed(0, now);
    originator_.tcp_closed({}, now);
    tcp_ = false;
  }
  void carry_outputs(Time now) {
    const auto packet = originator_.produce(bench_.exchange.output, bench_.exchange.output_valid, now);
    if (!packet || !reachable() || bench_.lose_output) return;
    for (int n = bench_.repeat_output ? 2 : 1; n > 0; --n) adapter_.io_received({kHost, 2222}, packet->bytes, now);
  }
  void step_robot() {
    if (connected_ && !adapter_.connected()) bench_.sim->drop_connection();
    if (!connected_ && adapter_.connected()) bench_.sim->restore_connection();
    if (connected_ && !adapter_.connected() && bench_.on_heard) bench_.on_heard({});
    connected_ = adapter_.connected();
    if (adapter_.take_fresh()) {
      if (bench_.on_heard) bench_.on_heard(adapter_.output());
      bench_.sim->step(adapter_.output(), std::endian::little, bench_.settings.cycle);
    } else {
      bench_.sim->step_without_outputs(bench_.settings.cycle);
    }
    image::InputBytes bytes{};
    image::encode_inputs(bench_.sim->inputs(), {bench_.layout}, bytes);
    adapter_.set_input(bytes);
  }
  void carry_inputs(Time now) {
    while (const auto packet = adapter_.produce(now)) {
      const auto bytes = copy(packet->bytes);
      if (!reachable() || bench_.lose_input) continue;
      if (bench_.repeat_input && !last_.empty()) originator_.io_received({kRobot, 2222}, last_, now);
      originator_.io_received({kRobot, 2222}, bytes, now);
      last_ = bytes;
    }
  }
  static std::vector<std::byte> copy(ethernet_ip::Bytes bytes) { return {bytes.begin(), bytes.end()}; }

  Bench& bench_;
  ethernet_ip::Adapter adapter_;
  ethernet_ip::Originator originator_;
  const bridge::Cycle* life_ = nullptr;
  std::uint16_t lives_ = 0;
  bool tcp_ = false, connected_ = false, was_present_ = true;
  std::vector<std::byte> last_;
};

}  // namespace meca::test
