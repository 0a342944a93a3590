#include "transports/net/raw_ethernet.hpp"

#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace meca::net {
namespace {

constexpr int kSmallestMtu = static_cast<int>(RawEthernet::kLongestFrame) - 14;
constexpr int kMostSkipped = 16;  // frames of our own in one call of receive()

ifreq request_for(const std::string& interface) noexcept {
  ifreq out{};
  std::copy_n(interface.data(), std::min(interface.size(), sizeof out.ifr_name - 1), out.ifr_name);
  return out;
}

[[noreturn]] void fail(const std::string& sentence) { throw std::runtime_error(sentence); }

std::string interfaces() {
  std::string out;
  struct if_nameindex* const all = ::if_nameindex();
  for (const struct if_nameindex* each = all; each != nullptr && each->if_index != 0; ++each) {
    if (std::strcmp(each->if_name, "lo") != 0) out += (out.empty() ? "" : ", ") + std::string(each->if_name);
  }
  if (all != nullptr) ::if_freenameindex(all);
  return out;
}

std::string no_right(const std::string& interface) {
  std::array<char, 512> path{};
  const ssize_t size = ::readlink("/proc/self/exe", path.data(), path.size());
  const std::string program = size > 0 ? std::string(path.data(), static_cast<std::size_t>(size)) : "<program>";
  return "raw frames on '" + interface +
         "' need the right CAP_NET_RAW; run as root, or give it to the program once: sudo setcap "
         "cap_net_raw,cap_sys_nice,cap_ipc_lock+ep " +
         program + ", or to its container: docker run --user root --cap-add NET_RAW";
}

// What can be asked without rights, so that these mistakes are told first.
std::array<std::byte, 6> check(const std::string& interface) {
  const File any(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request = request_for(interface);
  if (interface.size() >= IFNAMSIZ || ::ioctl(any.get(), SIOCGIFHWADDR, &request) != 0) {
    const std::string others = interfaces();
    fail("there is no network interface '" + interface + "' on this machine; " +
         (others.empty() ? "it has none" : "it has " + others));
  }
  if (request.ifr_hwaddr.sa_family != ARPHRD_ETHER) {
    fail("'" + interface + "' is no Ethernet interface" +
         (request.ifr_hwaddr.sa_family == ARPHRD_LOOPBACK ? " but a loopback" : "") +
         "; name the one that the robot's cable is in");
  }
  std::array<std::byte, 6> address;
  std::memcpy(address.data(), request.ifr_hwaddr.sa_data, address.size());
  request = request_for(interface);
  if (::ioctl(any.get(), SIOCGIFMTU, &request) == 0 && request.ifr_mtu < kSmallestMtu) {
    fail("'" + interface + "' takes frames of " + std::to_string(request.ifr_mtu) + " bytes (MTU), " +
         std::to_string(kSmallestMtu) + " are needed; ip link set " + interface + " mtu " +
         std::to_string(kSmallestMtu));
  }
  return address;
}

}  // namespace

RawEthernet::RawEthernet(const std::string& interface, std::uint16_t ether_type)
    : interface_(interface), ether_type_(ether_type), address_(check(interface)) {
  // No protocol yet: nothing from other interfaces arrives before it is bound to one.
  file_ = File(::socket(AF_PACKET, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!file_) {
    if (errno == EPERM || errno == EACCES) fail(no_right(interface));
    fail("a socket for raw frames cannot be opened: " + std::string(std::strerror(errno)));
  }
#ifdef PACKET_IGNORE_OUTGOING
  const int on = 1;  // receive() skips them where the kernel is too old for it (before 4.20)
  ::setsockopt(file_.get(), SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on);
#endif
  if (!bind(static_cast<int>(::if_nametoindex(interface.c_str())))) {
    fail("'" + interface + "' cannot be opened for raw frames: " + std::strerror(errno));
  }
}

bool RawEthernet::bind(int index) noexcept {
  if (index <= 0) return false;  // 0 would be all interfaces
  sockaddr_ll to{};
  to.sll_family = AF_PACKET;
  to.sll_protocol = htons(ether_type_);
  to.sll_ifindex = index;
  const bool bound = ::bind(file_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  // Of an interface that is down, the next call on the socket would say so instead of doing its work.
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(file_.get(), SOL_SOCKET, SO_ERROR, &error, &size);
  if (bound) index_ = index;
  return bound;
}

RawEthernet::Link RawEthernet::link() noexcept {
  ifreq request = request_for(interface_);
  if (::ioctl(file_.get(), SIOCGIFINDEX, &request) != 0) return Link::kGone;
  if (request.ifr_ifindex != index_ && !bind(request.ifr_ifindex)) return Link::kGone;
  request = request_for(interface_);
  if (::ioctl(file_.get(), SIOCGIFFLAGS, &request) != 0) return Link::kGone;
  if ((request.ifr_flags & IFF_UP) == 0) return Link::kDown;
  return (request.ifr_flags & IFF_RUNNING) != 0 ? Link::kUp : Link::kNoCarrier;
}

bool RawEthernet::send(std::span<const std::byte> frame) noexcept {
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (::send(file_.get(), frame.data(), frame.size(), 0) >= 0) return true;
    // An error that waited from before (the interface was down in between) is told instead of sending; once.
    if (errno != EINTR && errno != ENETDOWN) return false;
  }
  return false;
}

std::optional<std::size_t> RawEthernet::receive(std::span<std::byte> buffer) noexcept {
  for (int i = 0; i < kMostSkipped; ++i) {
    sockaddr_ll from{};
    socklen_t size = sizeof from;
    const ssize_t count =
        ::recvfrom(file_.get(), buffer.data(), buffer.size(), MSG_TRUNC, reinterpret_cast<sockaddr*>(&from), &size);
    if (count >= 0 && from.sll_pkttype == PACKET_OUTGOING) continue;
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR && errno != ENETDOWN) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace meca::net
