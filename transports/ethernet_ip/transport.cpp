#include "transports/ethernet_ip/transport.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <stdexcept>
#include <utility>

#include "transports/ethernet_ip/robot_link.hpp"
#include "transports/net/clock.hpp"
#include "transports/net/machine.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/udp.hpp"

namespace meca::ethernet_ip {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kScheduledDscp = 47;
constexpr int kBufferPerRobot = 64 * 1024;  // some 50 of the robot's packets, as the kernel counts them
constexpr std::size_t kUdp = 0;             // its slot at the poller; the robots' TCP connections follow
constexpr std::size_t kLargestDatagram = 1500;
// The bridge has promised to be gone within 2 s, of which the stop image may take 1.5 s.
constexpr Time kCloseTime = 400ms;
constexpr Time kCloseStep = 5ms;

// FNV-1a: the same text gives the same number, on every machine and for ever.
std::uint32_t number_of(std::string_view text) noexcept {
  std::uint32_t hash = 2166136261u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash == 0 ? 1 : hash;
}

class Bus final : public transports::Transport {
 public:
  Bus(std::vector<RobotOptions> robots, BusOptions options)
      : robots_(std::move(robots)), options_(std::move(options)), poller_(robots_.size() + 1) {}

  std::endian byte_order() const noexcept override { return std::endian::little; }
  std::span<const transports::CounterInfo> counters() const noexcept override { return link_counters(); }
  void open(Time now) override;
  void exchange(Time now, std::span<transports::Exchange> exchanges) noexcept override;
  Woke wait(Time deadline) noexcept override;
  void close() noexcept override;

 private:
  OriginatorSettings settings_of(const RobotOptions& robot) const;
  void check_addresses() const;
  void serve(Time until) noexcept;
  void receive(Time now) noexcept;
  void deliver(const net::Endpoint& from, Bytes datagram, Time now) noexcept;
  void produce(Time now) noexcept;
  Time next_send(Time at_most) const noexcept;

  std::vector<RobotOptions> robots_;
  BusOptions options_;
  std::uint16_t incarnation_ = 0;
  net::UdpSocket udp_;
  net::Poller poller_;
  std::vector<RobotLink> links_;
  std::vector<std::pair<std::uint32_t, RobotLink*>> by_address_;  // sorted
  std::span<transports::Exchange> exchanges_;                     // of the last exchange()
  std::uint64_t unknown_packets_ = 0;
  std::array<std::byte, kLargestDatagram> buffer_{};
};

OriginatorSettings Bus::settings_of(const RobotOptions& robot) const {
  OriginatorSettings out;
  out.o_to_t_rpi_us = out.t_to_o_rpi_us = robot.rpi_us;
  out.multiplier_code = multiplier_code(robot.timeout_multiplier);
  out.multicast = robot.multicast;
  out.large = robot.large_forward_open;
  out.key = robot.key;
  out.major = robot.key_major;
  out.minor = robot.key_minor;
  out.vendor_id = options_.vendor_id;
  out.serial_number = options_.serial_number;
  out.incarnation = incarnation_;
  out.address = net::resolve_ipv4(robot.address);
  out.tcp_port = robot.tcp_port;
  out.io_port = options_.io_port;
  out.tick = Time{};  // wait() asks at the very time
  return out;
}

void Bus::check_addresses() const {
  const auto same = std::ranges::adjacent_find(by_address_, {}, &std::pair<std::uint32_t, RobotLink*>::first);
  if (same == by_address_.end()) return;
  const auto name = [&](const RobotLink* link) {
    return robots_[static_cast<std::size_t>(link - links_.data())].address;
  };
  throw std::runtime_error("'" + name(same->second) + "' and '" + name(std::next(same)->second) + "' are both " +
                           net::to_string(same->first) + "; a robot has one connection");
}

void Bus::open(Time) {
  const bool multicast = std::ranges::any_of(robots_, &RobotOptions::multicast);
  if (multicast && options_.bind != 0) {
    throw std::runtime_error("multicast does not reach a socket that is bound to " + net::to_string(options_.bind) +
                             "; bind to 0.0.0.0, or ask for point-to-point");
  }
  if (options_.serial_number == 0) options_.serial_number = number_of(net::machine_identity() + "/" + options_.name);
  std::random_device random;
  incarnation_ = static_cast<std::uint16_t>(random());
  udp_ = net::UdpSocket({options_.bind, options_.io_port},
                        {.dscp = kScheduledDscp, .receive_buffer = kBufferPerRobot * static_cast<int>(robots_.size())});
  links_.clear();
  by_address_.clear();
  links_.reserve(robots_.size());
  for (const RobotOptions& robot : robots_) {
    links_.emplace_back(settings_of(robot), static_cast<std::uint16_t>(random()), options_.bind);
    by_address_.emplace_back(links_.back().address(), &links_.back());
  }
  std::ranges::sort(by_address_);
  check_addresses();
  poller_.watch(kUdp, udp_.descriptor());
}

void Bus::exchange(Time now, std::span<transports::Exchange> exchanges) noexcept {
  exchanges_ = exchanges.first(std::min(exchanges.size(), links_.size()));
  serve(Time{});
  for (RobotLink& link : links_) link.tick(udp_, now);
  produce(net::monotonic());
  for (std::size_t i = 0; i < exchanges_.size(); ++i) links_[i].fill(exchanges_[i], unknown_packets_);
}

transports::Transport::Woke Bus::wait(Time deadline) noexcept {
  for (;;) {
    const Time now = net::monotonic();
    produce(now);
    if (now >= deadline) return Woke::kDeadline;
    serve(next_send(deadline));
    bool arrival = false;
    for (RobotLink& link : links_) arrival |= link.wakes(deadline);
    if (arrival) return Woke::kArrival;
  }
}

// Waits until something arrives or the time is over, and takes what is there, up to a bound: whatever floods the socket
// must not keep us from what is due.
void Bus::serve(Time until) noexcept {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    poller_.watch(kUdp + 1 + i, links_[i].descriptor(), links_[i].wants_to_write());
  }
  if (!poller_.wait(until)) return;
  const Time now = net::monotonic();
  if (poller_.ready(kUdp)) receive(now);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (poller_.ready(kUdp + 1 + i)) links_[i].tcp_ready(udp_, now);
  }
}

void Bus::receive(Time now) noexcept {
  const std::size_t most = 32 + 4 * links_.size();
  for (std::size_t i = 0; i < most; ++i) {
    const auto got = udp_.receive(buffer_);
    if (!got) return;
    deliver(got->from, Bytes(buffer_).first(std::min(got->size, buffer_.size())), now);
  }
}

void Bus::deliver(const net::Endpoint& from, Bytes datagram, Time now) noexcept {
  const auto found = std::ranges::lower_bound(by_address_, from.ipv4, {}, &std::pair<std::uint32_t, RobotLink*>::first);
  if (found != by_address_.end() && found->first == from.ipv4) {
    found->second->io_received(from, datagram, now);
    return;
  }
  ++unknown_packets_;
  for (RobotLink& link : links_) link.io_received(from, datagram, now);  // one of them may be meant: it counts that
}

void Bus::produce(Time now) noexcept {
  for (std::size_t i = 0; i < exchanges_.size(); ++i) links_[i].produce(udp_, exchanges_[i], now);
}

Time Bus::next_send(Time at_most) const noexcept {
  for (std::size_t i = 0; i < exchanges_.size(); ++i)
    at_most = std::min(at_most, links_[i].next_send().value_or(at_most));
  return at_most;
}

// Forward Close to all at once.
void Bus::close() noexcept {
  Time now = net::monotonic();
  const Time end = now + kCloseTime;
  for (RobotLink& link : links_) link.close(now);
  while (now < end && !std::ranges::all_of(links_, &RobotLink::closed)) {
    for (RobotLink& link : links_) link.tick(udp_, now);
    serve(std::min(end, now + kCloseStep));
    now = net::monotonic();
  }
  for (RobotLink& link : links_) link.hang_up(udp_);
  exchanges_ = {};
  udp_ = {};
}

}  // namespace

std::unique_ptr<transports::Transport> make_transport(std::vector<RobotOptions> robots, BusOptions options) {
  return std::make_unique<Bus>(std::move(robots), std::move(options));
}

std::uint8_t multiplier_code(std::uint32_t multiplier) noexcept {
  const int width = std::bit_width(std::clamp(multiplier, 4u, 512u));
  return static_cast<std::uint8_t>(width - 3);
}

}  // namespace meca::ethernet_ip
