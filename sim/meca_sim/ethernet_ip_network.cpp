#include "sim/meca_sim/ethernet_ip_network.hpp"

#include <algorithm>
#include <stdexcept>

namespace meca::sim {
namespace {

ethernet_ip::AdapterSettings with_address(ethernet_ip::AdapterSettings settings, const net::Interface& own) {
  settings.address = own.address;
  settings.netmask = own.netmask;
  return settings;
}

std::string list_of(const std::vector<net::Interface>& interfaces) {
  std::string text;
  for (const auto& i : interfaces) text += (text.empty() ? "" : ", ") + i.name + " " + net::to_string(i.address);
  return text;
}

}  // namespace

net::Interface find_own_interface(const std::string& bind) {
  const auto interfaces = net::ipv4_interfaces();
  const auto address = net::parse_ipv4(bind);
  const auto found = std::ranges::find_if(interfaces, [&](const net::Interface& i) {
    const bool loopback = i.address >> 24 == 127;  // the whole of 127/8 is this machine's
    if (!address) return i.name == bind;
    return loopback ? ((*address ^ i.address) & i.netmask) == 0 : *address == i.address;
  });
  if (found == interfaces.end()) {
    throw std::runtime_error("--bind: '" + bind + "' is neither an address nor an interface of this machine; it has " +
                             list_of(interfaces));
  }
  net::Interface own = *found;
  if (address) own.address = *address;
  return own;
}

EthernetIpNetwork::EthernetIpNetwork(const RobotOptions& model, ethernet_ip::AdapterSettings adapter,
                                     ConnectionLoss on_loss, const net::Interface& own, Time now, Narrator::Say say)
    : own_(own),
      robot_(model, with_address(std::move(adapter), own), on_loss, now),
      sockets_(robot_, own),
      narrator_(robot_, std::move(say)) {}

void EthernetIpNetwork::exchange(Time now) noexcept {
  robot_.advance(now);
  sockets_.exchange(now);
}

Time EthernetIpNetwork::next_event(Time now) const noexcept {
  return std::min(robot_.next_event(), sockets_.next_event(now));
}

}  // namespace meca::sim
