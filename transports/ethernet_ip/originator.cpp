// The life of a connection: from the first attempt through back-off to the good-bye.
#include "transports/ethernet_ip/originator.hpp"

#include <algorithm>

#include "transports/ethernet_ip/status_text.hpp"

namespace meca::ethernet_ip {
namespace {

// The owner looks after every tick whether TCP is wanted: two ticks are at least one look.
constexpr std::uint8_t kHoldOffTicks = 2;
constexpr unsigned kMostDoublings = 20;

double seconds(Time t) noexcept { return std::chrono::duration<double>(t).count(); }
int length(std::string_view s) noexcept { return static_cast<int>(s.size()); }

}  // namespace

Originator::Originator(const OriginatorSettings& settings, std::uint16_t first_connection_serial) noexcept
    : settings_(settings), next_serial_(first_connection_serial) {
  wire::Writer path(path_);
  if (settings_.key != KeyPolicy::kNone) {
    write_key(path, {.vendor_id = kMecademicVendor,
                     .device_type = kRobotDeviceType,
                     .product_code = kMeca500ProductCode,
                     .major = settings_.major,
                     .minor = settings_.minor,
                     .compatible = settings_.key == KeyPolicy::kCompatible});
  }
  write_connection_points(path, kOutputPoint, kInputPoint);
  path_size_ = path.size();
}

void Originator::tick(Time now) noexcept {
  if (hold_off_ > 0) --hold_off_;
  switch (state_) {
    case State::kWaiting:
      if (hold_off_ == 0 && (!started_ || now >= next_attempt_)) connect(now);
      return;
    case State::kConnecting:
    case State::kRegistering:
    case State::kIdentifying:
    case State::kOpening:
      if (now >= deadline_) fail(no_answer(), now);
      return;
    case State::kRunning:
      if (now < watchdog_at_) return;
      ++counters_.watchdog_trips;
      fail(silence(), now);
      return;
    case State::kClosing:
      tick_closing(now);
      return;
    case State::kClosed:
      return;
  }
}

void Originator::connect(Time now) noexcept {
  started_ = true;
  duplicate_ = false;
  state_ = State::kConnecting;
  deadline_ = now + settings_.reply_timeout;
}

const char* Originator::name_of_pending() const noexcept {
  switch (pending_) {
    case Pending::kNothing:
      return "nothing";
    case Pending::kRegisterSession:
      return "RegisterSession";
    case Pending::kIdentity:
      return "GetAttributesAll of the identity";
    case Pending::kListIdentity:
      return "ListIdentity";
    case Pending::kForwardOpen:
      return "Forward Open";
    case Pending::kForwardClose:
      return "Forward Close";
  }
  return "";
}

Originator::Text Originator::no_answer() const noexcept {
  const auto robot = dotted(settings_.address);
  const double waited = seconds(settings_.reply_timeout);
  if (state_ == State::kConnecting) {
    return Text::format(
        "no answer from %.*s on TCP port %u for %.3g s; check address, cable, and that EtherNet/IP is enabled on the "
        "robot",
        length(robot), robot.view().data(), unsigned{settings_.tcp_port}, waited);
  }
  return Text::format("no answer to %s from %.*s for %.3g s, though TCP is connected; restart the robot's EtherNet/IP",
                      name_of_pending(), length(robot), robot.view().data(), waited);
}

// Whatever went wrong: says why, closes as far as it goes, and tries again later.
void Originator::fail(const Text& why, Time now) noexcept {
  if (state_ == State::kClosing) return closed();  // the first trouble is the one to tell
  trouble_ = why;
  const bool good_run = receiving_ && now - first_packet_at_ >= settings_.longest_backoff;
  if (good_run) failures_ = 0;
  next_attempt_ = now + std::min(settings_.longest_backoff,
                                 settings_.shortest_backoff * (std::int64_t{1} << std::min(failures_, kMostDoublings)));
  ++failures_;
  begin_closing(now);
}

void Originator::close(Time now) noexcept {
  if (for_good_) return;
  for_good_ = true;
  if (state_ == State::kClosing) return;  // after a fault: under way
  begin_closing(now);
}

void Originator::begin_closing(Time now) noexcept {
  state_ = State::kClosing;
  deadline_ = now + settings_.reply_timeout;
  pending_ = Pending::kNothing;
  reconnected_ = false;
  receiving_ = false;
  group_ = 0;
  o_to_t_api_us_ = t_to_o_api_us_ = 0;
  if (!maybe_open_) return end_session();
  if (session_ != 0) return send_forward_close(now);
  reconnected_ = true;  // there is no session: tcp_connected() goes on
  drop_tcp();
}

void Originator::end_session() noexcept {
  if (session_ == 0) return closed();
  send_unregister_session();
  session_ = 0;  // tick_closing() waits until it is sent
  pending_ = Pending::kNothing;
}

void Originator::closed() noexcept {
  drop_tcp();
  maybe_open_ = false;
  state_ = for_good_ ? State::kClosed : State::kWaiting;
}

void Originator::tick_closing(Time now) noexcept {
  const bool said_good_bye = !maybe_open_ && output_begin_ == output_end_;
  if (said_good_bye || now >= deadline_) closed();
}

void Originator::drop_tcp() noexcept {
  tcp_up_ = false;
  session_ = 0;
  pending_ = Pending::kNothing;
  received_size_ = 0;
  output_begin_ = output_end_ = 0;
  hold_off_ = kHoldOffTicks;
}

// ---- TCP

bool Originator::wants_tcp() const noexcept {
  if (hold_off_ > 0) return false;
  switch (state_) {
    case State::kConnecting:
    case State::kRegistering:
    case State::kIdentifying:
    case State::kOpening:
    case State::kClosing:
      return true;
    case State::kRunning:
      return tcp_up_;
    case State::kWaiting:
    case State::kClosed:
      return false;
  }
  return false;
}

void Originator::tcp_connected(Time now, std::uint32_t own_ipv4) noexcept {
  if (!wants_tcp() || tcp_up_) return;
  tcp_up_ = true;
  own_address_ = own_ipv4;
  if (state_ == State::kConnecting) state_ = State::kRegistering;
  send_register_session(now);
}

void Originator::tcp_closed(std::string_view why, Time now) noexcept {
  if (!wants_tcp()) return;
  const bool again = state_ == State::kClosing && maybe_open_ && !reconnected_;
  const bool was_up = tcp_up_;
  drop_tcp();
  hold_off_ = 0;  // the old one is gone already
  if (state_ == State::kRunning) return;
  if (again) {
    reconnected_ = true;
    return;
  }
  const auto robot = dotted(settings_.address);
  if (!was_up) {
    return fail(Text::format("TCP connection to %.*s port %u failed: %.*s; check address, cable, and that EtherNet/IP "
                             "is enabled on the robot",
                             length(robot), robot.view().data(), unsigned{settings_.tcp_port}, length(why), why.data()),
                now);
  }
  if (why.empty()) why = "closed by the robot";
  fail(Text::format("TCP connection to %.*s lost before the connection was open: %.*s", length(robot),
                    robot.view().data(), length(why), why.data()),
       now);
}

Bytes Originator::tcp_output() const noexcept {
  return Bytes(output_).subspan(output_begin_, output_end_ - output_begin_);
}

void Originator::tcp_sent(std::size_t count) noexcept {
  output_begin_ += std::min(count, output_end_ - output_begin_);
  if (output_begin_ == output_end_) output_begin_ = output_end_ = 0;
}

}  // namespace meca::ethernet_ip
