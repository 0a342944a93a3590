// Class 1 of the adapter: O->T in, T->O out, and the watchdog between them.
#include <algorithm>

#include "transports/ethernet_ip/adapter_state.hpp"

namespace meca::ethernet_ip {
namespace {

// Data of a T->O packet, whatever size a fault made us accept: at least a sequence count, and a byte to leave out.
constexpr std::size_t kLeastProduced = 3, kMostProduced = 1024;

// New data of a packet whose sequence was new: sequence count, run/idle header, image.
void take_data(AdapterState& s, Bytes data) noexcept {
  IoConnection& io = s.io;
  wire::Reader in(data);
  const std::uint16_t count = in.u16();
  if (io.heard && !newer(count, io.count)) {
    ++s.counters.repeated;
    return;
  }
  io.count = count;
  io.run = (in.u32() & kRun) != 0;
  ++s.counters.consumed;
  if (!io.run) {
    ++s.counters.idle;
    return;
  }
  std::ranges::copy(in.rest(), s.output.begin());
  io.fresh = true;
}

// The numbers of the next packet, as the faults want them.
void advance(AdapterState& s, std::uint32_t& sequence) noexcept {
  IoConnection& io = s.io;
  io.stale_turn = s.faults.stale_sequence && !io.stale_turn && io.sent_sequence > 0;
  if (io.stale_turn) {
    sequence = io.sent_sequence - 1;
    return;
  }
  sequence = ++io.sent_sequence;
  if (!s.faults.frozen_count) ++io.sent_count;
}

void compose(AdapterState& s) noexcept {
  std::uint32_t sequence = 0;
  advance(s, sequence);
  const std::size_t size = std::clamp(s.io.input_size, kLeastProduced, kMostProduced) - (s.faults.corrupt ? 1 : 0);
  const std::size_t image = std::min(size - 2, s.input.size());
  wire::Writer out(s.io_packet);
  write_io_packet(out, s.io.t_to_o_id, sequence, size);
  out.u16(s.io.sent_count);
  out.bytes(Bytes(s.input).first(image));
  out.zeros(size - 2 - image);
  s.io_packet_size = out.size();
}

}  // namespace

void end_connection(AdapterState& s) noexcept { s.io = {}; }

void check_watchdog(AdapterState& s, Time now) noexcept {
  if (!s.io.open || now < s.io.deadline) return;
  if (s.settings.ownership == OwnershipPolicy::kKeep) {
    s.kept_owner = Owner{s.io.triad.originator_vendor, s.io.triad.originator_serial};
  }
  end_connection(s);
  ++s.counters.timeouts;
}

void consume(AdapterState& s, const SocketAddress& from, Bytes datagram, Time now) noexcept {
  check_watchdog(s, now);
  IoConnection& io = s.io;
  const auto packet = read_io_packet(datagram);
  if (!packet) {
    ++s.counters.malformed;
    return;
  }
  if (!io.open || packet->connection_id != io.o_to_t_id || from.ipv4 != io.originator) {
    ++s.counters.foreign;
    return;
  }
  if (packet->data.size() != kOutputSize) {
    ++s.counters.malformed;
    return;
  }
  if (io.heard && !newer(packet->sequence, io.sequence)) {  // the first one may be any number
    ++s.counters.stale;
    return;
  }
  io.sequence = packet->sequence;
  io.deadline = now + io.watchdog;
  take_data(s, packet->data);
  io.heard = true;
}

std::optional<Adapter::Datagram> produce(AdapterState& s, Time now) noexcept {
  check_watchdog(s, now);
  IoConnection& io = s.io;
  if (!io.open || s.faults.stop_producing) return std::nullopt;
  if (io.repeat_last) {
    io.repeat_last = false;
  } else {
    if (now < io.next_send) return std::nullopt;
    io.next_send += ((now - io.next_send) / io.period + 1) * io.period;  // what was missed is skipped
    compose(s);
    io.repeat_last = s.faults.duplicate;
  }
  ++s.counters.produced;
  return Adapter::Datagram{io.to, io.multicast, Bytes(s.io_packet).first(s.io_packet_size)};
}

}  // namespace meca::ethernet_ip
