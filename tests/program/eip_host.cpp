#include "tests/program/eip_host.hpp"

#include <unistd.h>

#include <array>
#include <thread>

#include "transports/net/clock.hpp"

namespace meca::test {
namespace {

using namespace std::chrono_literals;
using ethernet_ip::Time;

constexpr std::uint32_t kLoopback = 0x7F000001;

ethernet_ip::OriginatorSettings complete(ethernet_ip::OriginatorSettings settings, std::uint32_t robot,
                                         const net::UdpSocket& io) {
  settings.address = robot;
  settings.vendor_id = 0x1234;
  if (settings.serial_number == 0) settings.serial_number = static_cast<std::uint32_t>(::getpid());
  if (!settings.multicast) settings.io_port = io.local().port;  // groups come to 2222
  return settings;
}

}  // namespace

EipHost::EipHost(std::uint32_t robot, ethernet_ip::OriginatorSettings settings)
    : io({kLoopback, 0}, {}),
      originator(complete(settings, robot, io), static_cast<std::uint16_t>(net::monotonic().count() >> 10)),
      robot_(robot) {}

bool EipHost::until(const std::function<bool()>& condition) {
  for (const Time end = net::monotonic() + 60s; net::monotonic() < end;) {
    if (condition()) return true;
    pump();
    std::this_thread::sleep_for(500us);
  }
  return condition();
}

void EipHost::run_for(std::chrono::nanoseconds time) {
  const Time end = net::monotonic() + time;
  until([end] { return net::monotonic() >= end; });
}

void EipHost::pump() {
  const Time now = net::monotonic();
  pump_io(now);
  pump_tcp(now);
  originator.tick(now);
  image::OutputBytes bytes{};
  image::encode_outputs(outputs, {}, bytes);
  if (const auto datagram = originator.produce(bytes, true, now)) {
    io.send({datagram->to.ipv4, datagram->to.port}, datagram->bytes);
  }
}

void EipHost::pump_io(Time now) {
  const std::uint32_t group = originator.group();
  if (group == 0) group_io_ = {};
  if (group != 0 && !group_io_) {
    group_io_ = net::UdpSocket({group, ethernet_ip::kIoPort}, {.share_port = true});
    if (!group_io_.join(group, kLoopback)) originator.join_failed("the loopback interface takes no groups", now);
  }
  std::array<std::byte, 2048> buffer{};
  for (net::UdpSocket* socket : {&io, &group_io_}) {
    while (const auto received = *socket ? socket->receive(buffer) : std::nullopt) {
      originator.io_received({received->from.ipv4, received->from.port}, std::span(buffer).first(received->size), now);
    }
  }
}

void EipHost::pump_tcp(Time now) {
  if (!originator.wants_tcp()) {
    tcp_.close();
    connected_ = false;
    return;
  }
  if (!tcp_) tcp_ = net::TcpStream::connect({robot_, ethernet_ip::kTcpPort});
  if (!connected_) {
    const auto progress = tcp_.progress();
    if (progress == net::TcpStream::Progress::kConnecting) return;
    if (progress == net::TcpStream::Progress::kFailed) {
      ++refused;
      return originator.tcp_closed(tcp_.trouble(), now);
    }
    connected_ = true;
    connected_at = now;
    said_at = {};
    originator.tcp_connected(now, kLoopback);
  }
  std::array<std::byte, 2048> buffer{};
  const auto [size, closed] = tcp_.receive(buffer);
  if (size > 0) {
    if (said_at == Time{}) said_at = now;
    last_tcp.assign(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size));
    originator.tcp_received(std::span(buffer).first(size), now);
  }
  if (closed) {
    ++hung_up;
    tcp_.close();
    connected_ = false;
    return originator.tcp_closed(tcp_.trouble(), now);
  }
  originator.tcp_sent(tcp_.send(originator.tcp_output()).bytes);
}

}  // namespace meca::test
