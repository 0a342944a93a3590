// The open connection: our packets on time, the robot's packets checked.
#include <algorithm>
#include <utility>

#include "transports/ethernet_ip/originator.hpp"
#include "transports/ethernet_ip/status_text.hpp"

namespace meca::ethernet_ip {
namespace {

constexpr std::size_t kCountSize = 2;  // sequence count of transport class 1, in front of the image

Time microseconds(std::uint32_t us) noexcept { return std::chrono::microseconds(us); }
double milliseconds(Time t) noexcept { return std::chrono::duration<double, std::milli>(t).count(); }
int length(std::string_view s) noexcept { return static_cast<int>(s.size()); }

}  // namespace

void Originator::run(const ForwardOpenReply& reply, Time now) noexcept {
  state_ = State::kRunning;
  pending_ = Pending::kNothing;
  ++counters_.opens;
  o_to_t_id_ = reply.o_to_t_id;
  t_to_o_id_ = reply.t_to_o_id;  // echoed for point-to-point, the robot's choice for multicast
  o_to_t_api_us_ = reply.o_to_t_api_us;
  t_to_o_api_us_ = reply.t_to_o_api_us;
  sent_sequence_ = 0;
  sent_count_ = 0;
  next_send_ = now;
  receiving_ = false;
  unexpected_size_ = 0;
  fresh_ = false;
  watchdog_at_ = now + std::max(settings_.first_packet_timeout, watchdog());
}

// Actual packet interval x multiplier, for the receiver to watch; the interval that was asked does not count.
Time Originator::watchdog() const noexcept {
  return microseconds(t_to_o_api_us_) * timeout_multiplier(settings_.multiplier_code);
}

// ---- The robot's packets

bool Originator::io_received(const SocketAddress& from, Bytes datagram, Time now) noexcept {
  const bool from_robot = from.ipv4 == settings_.address;
  if (state_ != State::kRunning) return from_robot;  // early, or late: nothing that counts
  const auto packet = read_io_packet(datagram);
  if (!packet) {
    if (from_robot) ++counters_.malformed;
    return from_robot;
  }
  const bool our_connection = packet->connection_id == t_to_o_id_;
  if (from_robot != our_connection) ++counters_.foreign;
  if (from_robot && our_connection) packet_received(*packet, now);
  return from_robot;
}

void Originator::packet_received(const IoPacket& packet, Time now) noexcept {
  if (packet.data.size() != kInputSize) {
    ++counters_.malformed;
    unexpected_size_ = packet.data.size();
    if (!receiving_) trouble_ = silence();
    return;
  }
  if (receiving_ && !newer(packet.sequence, received_sequence_)) {
    ++counters_.stale;
    return;
  }
  const std::uint16_t count = wire::Reader(packet.data).u16();
  const bool new_data = !receiving_ || count != received_count_;
  if (receiving_) counters_.lost += packet.sequence - received_sequence_ - 1;
  if (!receiving_) {
    first_packet_at_ = now;
    trouble_ = other_intervals();
  }
  receiving_ = true;
  unexpected_size_ = 0;
  received_sequence_ = packet.sequence;
  received_count_ = count;
  watchdog_at_ = now + watchdog();
  if (!new_data) {
    ++counters_.repeated;
    return;
  }
  ++counters_.received;
  std::ranges::copy(packet.data.subspan(kCountSize), input_.begin());
  fresh_ = true;
}

// What the robot granted, where it is not what was asked for.
Originator::Text Originator::other_intervals() const noexcept {
  if (o_to_t_api_us_ == settings_.o_to_t_rpi_us && t_to_o_api_us_ == settings_.t_to_o_rpi_us) return {};
  const auto ms = [](std::uint32_t us) { return milliseconds(microseconds(us)); };
  return Text::format(
      "the robot grants a packet interval of %.10g ms O->T and %.10g ms T->O, %.10g and %.10g ms were asked for; the "
      "watchdog is %.10g ms; set rpi to what it grants if it stays so",
      ms(o_to_t_api_us_), ms(t_to_o_api_us_), ms(settings_.o_to_t_rpi_us), ms(settings_.t_to_o_rpi_us),
      milliseconds(watchdog()));
}

// Why nothing that can be taken arrives.
Originator::Text Originator::silence() const noexcept {
  const auto robot = dotted(settings_.address), group = dotted(group_);
  if (unexpected_size_ != 0) {
    return Text::format(
        "the robot's packets have %zu bytes, %u were agreed%s; check that it is a Meca500, and its "
        "firmware",
        unexpected_size_, unsigned{kInputSize},
        unexpected_size_ == kInputSize + 4u ? " (does it send a run/idle header?)" : "");
  }
  if (receiving_) {
    return Text::format(
        "no packet from %.*s for %.10g ms (%.10g ms x %u); check the network, and whether EtherNet/IP "
        "is still enabled on the robot",
        length(robot), robot.view().data(), milliseconds(watchdog()), milliseconds(microseconds(t_to_o_api_us_)),
        static_cast<unsigned>(timeout_multiplier(settings_.multiplier_code)));
  }
  const double waited = milliseconds(std::max(settings_.first_packet_timeout, watchdog())) / 1000;
  if (group_ != 0) {
    return Text::format(
        "connection open, but nothing arrives from %.*s at group %.*s for %.3g s; let UDP %u through this "
        "host's firewall, check IGMP snooping, or ask for point-to-point",
        length(robot), robot.view().data(), length(group), group.view().data(), waited, unsigned{settings_.io_port});
  }
  return Text::format(
      "connection open, but no answer on UDP from %.*s for %.3g s; let UDP %u towards this host through "
      "its firewall",
      length(robot), robot.view().data(), waited, unsigned{settings_.io_port});
}

std::uint32_t Originator::group() const noexcept { return group_; }

void Originator::join_failed(std::string_view why, Time now) noexcept {
  if (state_ != State::kRunning || group_ == 0) return;
  const auto group = dotted(group_);
  fail(Text::format("multicast group %.*s cannot be joined: %.*s; choose the interface, or ask for point-to-point",
                    length(group), group.view().data(), length(why), why.data()),
       now);
}

bool Originator::running() const noexcept { return state_ == State::kRunning && receiving_; }

const image::InputBytes& Originator::input() const noexcept { return input_; }

bool Originator::take_fresh() noexcept { return std::exchange(fresh_, false); }

// ---- Our packets

std::optional<Time> Originator::next_send() const noexcept {
  if (state_ != State::kRunning) return std::nullopt;
  return next_send_;
}

std::optional<Originator::Datagram> Originator::produce(const image::OutputBytes& outputs, bool run,
                                                        Time now) noexcept {
  const Time reached = now + settings_.tick / 2;
  if (state_ != State::kRunning || reached < next_send_) return std::nullopt;
  const Time period = microseconds(o_to_t_api_us_);
  const auto missed = (reached - next_send_) / period;
  counters_.skipped_sends += static_cast<std::uint64_t>(missed);
  next_send_ += (missed + 1) * period;

  wire::Writer out(packet_);
  write_io_packet(out, o_to_t_id_, ++sent_sequence_, kOutputSize);
  out.u16(++sent_count_);
  out.u32(run ? kRun : 0);
  out.bytes(outputs);
  ++counters_.sent;
  return Datagram{destination_, out.written()};
}

}  // namespace meca::ethernet_ip
