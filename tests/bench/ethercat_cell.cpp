#include "tests/bench/ethercat_cell.hpp"

#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "tests/bench/bare_ethernet.hpp"
#include "tests/bench/clock.hpp"
#include "transports/image/codec.hpp"

namespace meca::bench {
namespace {

using namespace ethercat;
using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr std::size_t kRobotsSlot = 0, kBareSlot = 1;
constexpr auto kCycle = 1ms, kTick = 1ms;
constexpr auto kConnectTime = 30s;
constexpr std::uint64_t kFlowing = 10;  // outputs

std::vector<Device*> pointers_to(std::vector<Device>& devices) {
  std::vector<Device*> out;
  for (Device& device : devices) out.push_back(&device);
  return out;
}

image::InputBytes stamped_image() {
  const std::int64_t us = unix_now_ns() / 1000;
  image::Inputs inputs;
  inputs.robot_timestamp.seconds = static_cast<std::uint32_t>(us / 1'000'000);
  inputs.robot_timestamp.microseconds = static_cast<std::uint32_t>(us % 1'000'000);
  image::InputBytes out{};
  image::encode_inputs(inputs, {image::Layout::kFirmware11, std::endian::little}, out);
  return out;
}

struct Content {
  bool process_data = false, begins_cycle = false;
};
// The first frame of a cycle asks for the AL state of all before anything else.
Content content_of(wire::Bytes frame) {
  DatagramWalk<const std::byte> walk(frame);
  Content out;
  bool first = true, broadcast = false;
  while (const auto datagram = walk.next()) {
    if (first) broadcast = datagram->command() == Command::kBrd;
    first = false;
    out.process_data = datagram->command() == Command::kLrw;
    if (out.process_data) break;
  }
  out.begins_cycle = out.process_data && broadcast;
  return out;
}

}  // namespace

void Rhythm::begin(nanoseconds at) {
  if (last_) off_us.push_back(std::abs(std::chrono::duration<double, std::micro>(at - *last_ - kCycle).count()));
  last_ = at;
  periods.packet(at);
}

EthercatCell::Port::Port(std::uint16_t ether_type) : socket(kRobotInterface, ether_type) {
  const int on = 1;
  if (setsockopt(socket.descriptor(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) != 0)
    throw std::runtime_error("SO_TIMESTAMPNS: " + std::string(std::strerror(errno)));
}

std::optional<EthercatCell::Received> EthercatCell::Port::receive() {
  iovec into{buffer.data(), buffer.size()};
  alignas(cmsghdr) std::array<std::byte, 128> control;
  msghdr message{};
  message.msg_iov = &into;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const auto size = recvmsg(socket.descriptor(), &message, MSG_DONTWAIT);
  if (size < 0) return std::nullopt;
  Received out{std::span(buffer).first(static_cast<std::size_t>(size)), {}};
  for (auto* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SO_TIMESTAMPNS) continue;
    timespec at{};
    std::memcpy(&at, CMSG_DATA(part), sizeof at);
    out.at = std::chrono::seconds(at.tv_sec) + nanoseconds(at.tv_nsec);
  }
  if (out.at == nanoseconds{}) throw std::runtime_error("the kernel does not stamp what arrives");
  return out;
}

EthercatCell::EthercatCell(int robots, bool stamped)
    : devices_([robots] {
        std::vector<Device> out;
        for (int i = 0; i < robots; ++i) out.emplace_back(DeviceSettings{});
        return out;
      }()),
      chain_(pointers_to(devices_)),
      stamped_(stamped),
      cyclic_(kEtherType),
      bare_(kBareEtherType),
      poller_(2) {
  real_time_ = make_real_time();
  poller_.watch(kRobotsSlot, cyclic_.socket.descriptor());
  poller_.watch(kBareSlot, bare_.socket.descriptor());
}

void EthercatCell::run(nanoseconds duration) {
  const auto end = monotonic_now() + duration;
  for (auto now = monotonic_now(); now < end; now = monotonic_now()) {
    if (poller_.wait(std::min<nanoseconds>(end, now + kTick))) {
      if (poller_.ready(kRobotsSlot)) serve_robots();
      if (poller_.ready(kBareSlot)) serve_bare();
    }
    now = monotonic_now();
    for (Device& device : devices_) device.tick(now);
  }
}

void EthercatCell::run_until_operational() {
  const auto end = monotonic_now() + kConnectTime;
  const auto flows = [](const Device& device) { return device.operational() && device.counters().outputs > kFlowing; };
  while (!std::ranges::all_of(devices_, flows)) {
    if (monotonic_now() >= end) throw std::runtime_error("the bridge did not bring every robot to OP within 30 s");
    run(20ms);
  }
}

void EthercatCell::restart() {
  cyclic_.rhythm = bare_.rhythm = {};
  held_ = {};
  frames_ = 0;
}

void EthercatCell::serve_robots() {
  while (const auto received = cyclic_.receive()) {
    const auto now = monotonic_now();
    if (stamped_) devices_.front().set_input(stamped_image());
    const Content content = content_of(received->frame);
    if (content.process_data) note_cyclic(*received, content.begins_cycle);
    if (!chain_.process(Chain::Side::kPrimary, received->frame, now)) continue;
    const auto held = monotonic_now() - now;
    cyclic_.socket.send(received->frame);
    if (!content.process_data) continue;
    held_ += held;
    ++frames_;
  }
}

void EthercatCell::note_cyclic(const Received& received, bool begins_cycle) {
  if (begins_cycle) {
    cyclic_.rhythm.begin(received.at);
    last_cycle_ = monotonic_now();
    sizes_.swap(current_sizes_);
    current_sizes_.clear();
  }
  current_sizes_.push_back(received.frame.size());
}

void EthercatCell::serve_bare() {
  while (const auto received = bare_.receive()) {
    bare_.socket.send(received->frame);
    if (received->frame[kBareNumber] == std::byte{0}) bare_.rhythm.begin(received->at);
  }
}

}  // namespace meca::bench
