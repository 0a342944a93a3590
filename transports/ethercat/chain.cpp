#include "transports/ethercat/chain.hpp"

#include <utility>

namespace meca::ethercat {

Chain::Chain(std::vector<Device*> devices, Time wire)
    : devices_(std::move(devices)), cable_(devices_.size() + 1, true), powered_(devices_.size(), true), wire_(wire) {
  topology_changed();
}

std::optional<Chain::Side> Chain::process(Side in, std::span<std::byte> frame, Time now) noexcept {
  if (!DatagramWalk<std::byte>(frame).next()) return std::nullopt;
  if (whole_ring_ && in == Side::kSecondary) return Side::kPrimary;
  const Stretch& stretch = in == Side::kPrimary ? primary_ : secondary_;
  if (stretch.first == stretch.end) return std::nullopt;
  // Frames are processed on their way from port 0 to port 1 only. From the secondary side they pass all devices first,
  // and the farthest one turns them round.
  const auto steps = [this](std::size_t count) { return wire_ * static_cast<std::int64_t>(count); };
  const std::size_t last = stretch.end - 1;
  const Time begin = in == Side::kPrimary ? now : now + steps(last - stretch.first);
  for (std::size_t k = stretch.first; k < stretch.end; ++k) {
    const Time at_port0 = begin + steps(k - stretch.first);
    std::optional<Time> at_port1;
    if (in == Side::kSecondary) {
      at_port1 = now + steps(last - k);
    } else if (!whole_ring_ && k < last) {
      at_port1 = begin + steps(last - stretch.first) + steps(last - k);
    }
    pass(*devices_[k], frame, at_port0, at_port1);
  }
  frame[kSourceAddress] |= kReplyBit;
  return whole_ring_ ? Side::kSecondary : in;
}

void Chain::pass(Device& device, std::span<std::byte> frame, Time at_port0, std::optional<Time> at_port1) noexcept {
  Esc& esc = device.esc();
  esc.faults().working_counter = device.faults().working_counter;
  esc.faults().lose_mailbox_reads = device.faults().lose_mailbox_replies;
  esc.frame_begins(at_port0, at_port1);
  DatagramWalk<std::byte> walk(frame);
  while (const auto datagram = walk.next()) esc.process(*datagram, at_port0);
}

void Chain::set_ring(bool closed_to_master) noexcept {
  ring_ = closed_to_master;
  topology_changed();
}

void Chain::cut(std::size_t k) noexcept {
  if (k >= cable_.size()) return;
  cable_[k] = false;
  topology_changed();
}

void Chain::heal(std::size_t k) noexcept {
  if (k >= cable_.size()) return;
  cable_[k] = true;
  topology_changed();
}

void Chain::set_powered(std::size_t device, bool powered) noexcept {
  if (device >= powered_.size()) return;
  powered_[device] = powered;
  topology_changed();
}

// A cable carries a link when it is not cut and both of its ends have power; the master always has.
bool Chain::link(std::size_t cable) const noexcept {
  if (!cable_[cable]) return false;
  if (cable > 0 && !powered_[cable - 1]) return false;
  return cable < devices_.size() ? bool{powered_[cable]} : ring_;
}

void Chain::topology_changed() noexcept {
  const std::size_t n = devices_.size();
  primary_ = {0, 0};
  while (primary_.end < n && link(primary_.end)) ++primary_.end;
  whole_ring_ = n > 0 && primary_.end == n && link(n);
  secondary_ = {n, n};
  while (secondary_.first > 0 && link(secondary_.first)) --secondary_.first;
  for (std::size_t k = 0; k < n; ++k)
    if (powered_[k]) devices_[k]->esc().set_ports({{link(k), link(k + 1), false, false}});
}

std::size_t Chain::size() const noexcept { return devices_.size(); }

bool Chain::reached(std::size_t device, Side from) const noexcept {
  if (from == Side::kPrimary) return device < primary_.end;
  return !whole_ring_ && device >= secondary_.first && device < secondary_.end;
}

}  // namespace meca::ethercat
