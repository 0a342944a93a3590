#include "sim/meca_sim/ethernet_ip_robot.hpp"

#include <algorithm>

namespace meca::sim {
namespace {

constexpr Time kLongestSilence = std::chrono::milliseconds(100);

}  // namespace

EthernetIpRobot::EthernetIpRobot(const RobotOptions& model, const ethernet_ip::AdapterSettings& adapter,
                                 ConnectionLoss on_loss, Time now)
    : robot_(model),
      adapter_(adapter),
      format_{model.layout, std::endian::little},
      on_loss_(on_loss),
      next_cycle_(now + kCycle) {
  show_inputs();
}

void EthernetIpRobot::advance(Time now) noexcept {
  carry_faults();
  adapter_.tick(now);
  watch_connection();
  if (now < next_cycle_) return;
  next_cycle_ = std::max(next_cycle_, now - kLongestSilence);
  for (; next_cycle_ <= now; next_cycle_ += kCycle) step();
  show_inputs();
}

void EthernetIpRobot::io_received(const ethernet_ip::SocketAddress& from, ethernet_ip::Bytes datagram,
                                  Time now) noexcept {
  if (!hears() || faults_.frozen) return;
  adapter_.io_received(from, datagram, now);
  if (!adapter_.take_fresh()) return;
  waiting_count_ = std::min(waiting_count_ + 1, waiting_.size());
  waiting_[waiting_count_ - 1] = adapter_.output();
}

std::optional<ethernet_ip::Adapter::Datagram> EthernetIpRobot::produce(Time now) noexcept {
  carry_faults();
  if (!present()) return std::nullopt;
  const auto datagram = adapter_.produce(now);
  return faults_.unplugged ? std::nullopt : datagram;  // into an open cable: lost, and counted by who sent it
}

Time EthernetIpRobot::next_event() const noexcept {
  return std::min(next_cycle_, adapter_.next_event().value_or(next_cycle_));
}

void EthernetIpRobot::carry_faults() noexcept {
  ethernet_ip::AdapterFaults& to = adapter_.faults();
  to.refuse_open = faults_.refuse_open;
  to.wrong_size = faults_.wrong_size;
  to.api_us = faults_.api_us;
  to.no_socket_items = faults_.no_socket_items;
  to.foreign_address.reset();
  if (faults_.foreign_address) to.foreign_address = {faults_.foreign_address->ipv4, faults_.foreign_address->port};
  to.stop_producing = faults_.stop_producing || faults_.frozen;
  to.duplicate = faults_.duplicate;
  to.stale_sequence = faults_.stale_sequence;
  to.corrupt = faults_.corrupt;
  to.frozen_count = faults_.frozen_count;
  if (faults_.events.tcp_closures != tcp_closures_) adapter_.close_tcp_connections();
  tcp_closures_ = faults_.events.tcp_closures;
  // At once, so that nothing of it is left when the power is back.
  if (faults_.without_power && !without_power_) robot_.power_cycle();
  without_power_ = faults_.without_power;
}

void EthernetIpRobot::step() noexcept {
  if (without_power_) {
    // It does not even begin to start up.
  } else if (waiting_count_ > 0) {
    robot_.step(image::decode_outputs(waiting_.front(), format_), kCycle);
    std::shift_left(waiting_.begin(), waiting_.end(), 1);
    --waiting_count_;
  } else {
    robot_.step_without_outputs(kCycle);
  }
  if (was_present_ && !robot_.present()) leave();
  was_present_ = robot_.present();
}

// What was connected is forgotten, and is no loss to the robot: it starts up without a memory of it.
void EthernetIpRobot::leave() noexcept {
  adapter_.power_cycle();
  waiting_count_ = 0;
}

void EthernetIpRobot::watch_connection() noexcept {
  const ethernet_ip::AdapterCounters& counters = adapter_.counters();
  const std::uint64_t ends = counters.closes + counters.timeouts;
  const bool ended = ends != ends_, opened = counters.opens != opens_;
  ends_ = ends;
  opens_ = counters.opens;
  if (ended) waiting_count_ = 0;
  if (on_loss_ == ConnectionLoss::kContinue) return;
  if (ended) robot_.drop_connection();
  if (opened && adapter_.connected()) robot_.restore_connection();
}

void EthernetIpRobot::show_inputs() noexcept {
  image::InputBytes input{};
  image::encode_inputs(robot_.inputs(), format_, input);
  adapter_.set_input(input);
}

}  // namespace meca::sim
