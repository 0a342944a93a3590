#include "tests/bench/eip_cell.hpp"

#include <netinet/in.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "tests/bench/clock.hpp"
#include "transports/image/codec.hpp"

namespace meca::bench {
namespace {

using namespace ethernet_ip;
using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr std::size_t kBare = 0, kFirst = 1, kSlotsPerRobot = 3;  // of the poller: listener, stream, io
constexpr std::size_t kConnection = 0;                            // of the adapter
constexpr auto kConnectTime = 30s;

std::uint32_t address_of(int robot) { return net::parse_ipv4(eip_address(robot)).value(); }

AdapterSettings meca500(int number) {
  AdapterSettings out;
  out.identity = {.vendor_id = kMecademicVendor,
                  .device_type = kRobotDeviceType,
                  .product_code = kMeca500ProductCode,
                  .major = 11,
                  .minor = 3,
                  .serial_number = static_cast<std::uint32_t>(number + 1)};
  out.identity.set_name("Meca500");
  out.address = address_of(number);
  out.lenient_rpi = true;
  return out;
}

// The robot's clock here is the Unix time of this machine.
image::InputBytes stamped_image() {
  const std::int64_t us = unix_now_ns() / 1000;
  image::Inputs inputs;
  inputs.robot_timestamp.seconds = static_cast<std::uint32_t>(us / 1'000'000);
  inputs.robot_timestamp.microseconds = static_cast<std::uint32_t>(us % 1'000'000);
  image::InputBytes out{};
  image::encode_inputs(inputs, {}, out);
  return out;
}

}  // namespace

std::string eip_address(int robot) { return "127.0.1." + std::to_string(robot + 1); }

StampingSocket::StampingSocket(const net::Endpoint& local) : socket_(local, {}) {
  const int on = 1;
  if (setsockopt(socket_.descriptor(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) != 0)
    throw std::runtime_error("SO_TIMESTAMPNS: " + std::string(std::strerror(errno)));
}

std::optional<StampedDatagram> StampingSocket::receive() {
  sockaddr_in from{};
  iovec into{buffer_.data(), buffer_.size()};
  alignas(cmsghdr) std::array<std::byte, 128> control;
  msghdr message{};
  message.msg_name = &from;
  message.msg_namelen = sizeof from;
  message.msg_iov = &into;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const auto size = recvmsg(socket_.descriptor(), &message, MSG_DONTWAIT);
  if (size < 0) return std::nullopt;
  StampedDatagram out{{ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)},
                      std::span(buffer_).first(static_cast<std::size_t>(size)),
                      {}};
  for (auto* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SO_TIMESTAMPNS) continue;
    timespec at{};
    std::memcpy(&at, CMSG_DATA(part), sizeof at);
    out.at = std::chrono::seconds(at.tv_sec) + nanoseconds(at.tv_nsec);
  }
  if (out.at == nanoseconds{}) throw std::runtime_error("the kernel does not stamp what arrives");
  return out;
}

void Arrivals::packet(std::uint32_t number, nanoseconds at) {
  if (sequence && !newer(number, *sequence)) return;
  if (sequence) lost += static_cast<std::int64_t>(number - *sequence - 1);
  sequence = number;
  periods.packet(at);
}

EipCell::Robot::Robot(int number)
    : adapter(meca500(number)), listener({address_of(number), kTcpPort}), io({address_of(number), kIoPort}) {}

EipCell::EipCell(int robots)
    : bare_({address_of(0), kBarePort}), poller_(kFirst + kSlotsPerRobot * static_cast<std::size_t>(robots)) {
  robots_.reserve(static_cast<std::size_t>(robots));
  for (int i = 0; i < robots; ++i) robots_.emplace_back(i);
  poller_.watch(kBare, bare_.socket().descriptor());
}

void EipCell::run(nanoseconds duration) {
  const auto end = monotonic_now() + duration;
  for (auto now = monotonic_now(); now < end; now = monotonic_now()) {
    auto next = end;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      Robot& robot = robots_[i];
      produce(robot);
      const std::size_t slot = kFirst + i * kSlotsPerRobot;
      poller_.watch(slot, robot.listener.descriptor());
      poller_.watch(slot + 1, robot.stream.descriptor());
      poller_.watch(slot + 2, robot.io.socket().descriptor());
      next = std::min(next, robot.adapter.next_event().value_or(end));
    }
    if (!poller_.wait(next)) continue;
    now = monotonic_now();
    if (poller_.ready(kBare)) serve_bare();
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const std::size_t slot = kFirst + i * kSlotsPerRobot;
      if (poller_.ready(slot) || poller_.ready(slot + 1)) serve_tcp(robots_[i], now);
      if (poller_.ready(slot + 2)) serve_io(robots_[i], now);
    }
  }
}

void EipCell::run_until_connected() {
  const auto end = monotonic_now() + kConnectTime;
  const auto flows = [](const Robot& robot) {
    return robot.adapter.connected() && robot.adapter.counters().consumed > 10;
  };
  while (!std::ranges::all_of(robots_, flows)) {
    if (monotonic_now() >= end) throw std::runtime_error("the bridge did not connect to every robot within 30 s");
    run(20ms);
  }
}

void EipCell::restart() {
  for (Robot& robot : robots_) robot.arrivals = {};
  bare_periods_ = {};
}

Arrivals EipCell::arrivals() const {
  Arrivals all;
  for (const Robot& robot : robots_) {
    all.periods.merge(robot.arrivals.periods);
    all.lost += robot.arrivals.lost;
  }
  return all;
}

PeriodStatistics EipCell::bare_periods() const {
  PeriodStatistics all;
  for (const auto& stream : bare_periods_) all.merge(stream);
  return all;
}

std::int64_t EipCell::timeouts() const {
  std::int64_t sum = 0;
  for (const Robot& robot : robots_) sum += static_cast<std::int64_t>(robot.adapter.counters().timeouts);
  return sum;
}

// The image is stamped when it is to leave, so that nothing of ours but the write itself lies between stamp and wire.
void EipCell::produce(Robot& robot) {
  const auto now = monotonic_now();
  if (robot.adapter.next_event().value_or(now + 1s) > now) return;
  robot.adapter.tick(now);
  robot.adapter.set_input(stamped_image());
  while (const auto out = robot.adapter.produce(now)) robot.io.socket().send({out->to.ipv4, out->to.port}, out->bytes);
}

void EipCell::serve_tcp(Robot& robot, nanoseconds now) {
  Adapter& adapter = robot.adapter;
  if (auto caller = robot.listener.accept(); caller && !robot.stream) {
    robot.stream = std::move(*caller);
    adapter.tcp_accepted(kConnection, robot.stream.peer().ipv4, now);
  }
  if (!robot.stream) return;
  std::array<std::byte, 512> buffer;
  auto got = robot.stream.receive(buffer);
  adapter.tcp_received(kConnection, Bytes(buffer).first(got.bytes), now);
  if (!got.closed) {
    const auto sent = robot.stream.send(adapter.tcp_output(kConnection));
    adapter.tcp_sent(kConnection, sent.bytes);
    got.closed = sent.closed || (adapter.wants_closed(kConnection) && adapter.tcp_output(kConnection).empty());
  }
  if (!got.closed) return;
  adapter.tcp_closed(kConnection, now);
  robot.stream.close();
}

void EipCell::serve_io(Robot& robot, nanoseconds now) {
  while (const auto got = robot.io.receive()) {
    robot.adapter.io_received({got->from.ipv4, got->from.port}, got->bytes, now);
    if (const auto packet = read_io_packet(got->bytes)) robot.arrivals.packet(packet->sequence, got->at);
  }
}

void EipCell::serve_bare() {
  while (const auto got = bare_.receive()) {
    const auto stream = got->bytes.empty() ? 0u : static_cast<std::size_t>(got->bytes[0]);
    bare_periods_[stream % kMostRobots].packet(got->at);
  }
}

void run_bare_sender(std::chrono::microseconds period, int streams, std::chrono::seconds duration) {
  net::UdpSocket socket({net::parse_ipv4(kEipHost).value(), 0}, {});
  std::array<std::byte, kBareSize> datagram{};
  auto deadline = monotonic_now();
  for (const auto end = deadline + duration; deadline < end; deadline += period) {
    sleep_until(deadline);
    for (int i = 0; i < streams; ++i) {
      datagram[0] = static_cast<std::byte>(i);
      socket.send({address_of(0), kBarePort}, datagram);
    }
  }
}

}  // namespace meca::bench
