#include "sim/meca_sim/ethercat_network.hpp"

#include <algorithm>

#include <stdexcept>

#include "transports/net/claim.hpp"
#include "transports/net/clock.hpp"

namespace meca::sim {
namespace {

using Link = net::RawEthernet::Link;

// A real device closes its port much sooner; watchdogs of 100 ms must not notice.
constexpr Time kBetweenLinkLooks = std::chrono::milliseconds(10);

std::vector<net::RawEthernet> open_ports(const std::string& interface, const std::string& redundant_interface) {
  std::vector<net::RawEthernet> ports;
  ports.emplace_back(interface, ethercat::kEtherType);
  if (!redundant_interface.empty()) ports.emplace_back(redundant_interface, ethercat::kEtherType);
  return ports;
}

// Two simulators on one interface would both answer every frame.
std::vector<net::File> claim_all(const std::vector<net::RawEthernet>& ports) {
  std::vector<net::File> claims;
  for (const net::RawEthernet& port : ports) {
    auto claim = net::claim("meca500/ethercat-robots/" + port.interface());
    if (!claim) {
      throw std::runtime_error("'" + port.interface() +
                               "' has simulated robots already: another meca-sim runs on it; stop that one first "
                               "(several robots of one line: --count)");
    }
    claims.push_back(std::move(*claim));
  }
  return claims;
}

std::string in_words(const std::string& interface, Link link) {
  switch (link) {
    case Link::kUp:
      return {};
    case Link::kNoCarrier:
      return interface + " has no carrier: is the master's end up?";
    case Link::kDown:
      return interface + " is down: 'ip link set " + interface + " up' switches it on";
    case Link::kGone:
      return interface + " is gone; frames pass again when it is back";
  }
  return {};
}

}  // namespace

EthercatNetwork::EthercatNetwork(const std::vector<EthercatSegment::Member>& members, ConnectionLoss on_loss,
                                 const std::string& interface, const std::string& redundant_interface, Time now,
                                 const std::vector<Narrator::Say>& say)
    : ports_(open_ports(interface, redundant_interface)),
      claims_(claim_all(ports_)),
      segment_(members, ports_.size() > 1, on_loss, now) {
  for (std::size_t i = 0; i < segment_.size(); ++i) {
    narrators_.push_back(std::make_unique<EthercatNarrator>(segment_.robot(i), say[i]));
  }
  look_at_links(now);
}

std::string EthercatNetwork::place(std::size_t index) const {
  std::string text = "EtherCAT on " + ports_.front().interface();
  if (ports_.size() > 1) text += " and " + ports_.back().interface();
  return text + ", position " + std::to_string(index);
}

void EthercatNetwork::exchange(Time now) noexcept {
  look_at_links(now);
  send_late(now);
  for (int i = 0; i < kMostAtOnce; ++i) {
    bool more = false;
    for (std::size_t port = 0; port < ports_.size(); ++port) more = exchange_one(port) || more;
    if (!more) break;
  }
  segment_.advance(net::monotonic());
}

// The answer first: a master waits for it, and nothing that the robots do meanwhile is in it.
bool EthercatNetwork::exchange_one(std::size_t port) noexcept {
  const auto size = ports_[port].receive(buffer_);
  if (!size) return false;
  if (*size > buffer_.size()) return true;
  const std::span frame = std::span(buffer_).first(*size);
  const Time now = net::monotonic();  // the devices' clocks are read from it
  const auto out = segment_.process(static_cast<Side>(port), frame, now);
  if (out && static_cast<std::size_t>(*out) < ports_.size()) ports_[static_cast<std::size_t>(*out)].send(frame);
  segment_.advance(now);
  return true;
}

void EthercatNetwork::send_late(Time now) noexcept {
  while (const auto late = segment_.take_late(now)) {
    const auto port = static_cast<std::size_t>(late->out);
    if (port < ports_.size()) ports_[port].send(late->bytes);
  }
}

void EthercatNetwork::look_at_links(Time now) noexcept {
  if (now < look_at_links_at_) return;
  look_at_links_at_ = now + kBetweenLinkLooks;
  trouble_.clear();
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    const Link link = ports_[port].link();
    segment_.set_carrier(static_cast<Side>(port), link == Link::kUp);
    if (link == Link::kUp) continue;
    if (!trouble_.empty()) trouble_ += "; ";
    trouble_ += in_words(ports_[port].interface(), link);
  }
}

void EthercatNetwork::wait_for(net::Poller& poller, std::size_t first, Time) const noexcept {
  for (const net::RawEthernet& port : ports_) poller.watch(first++, port.descriptor());
}

Time EthercatNetwork::next_event(Time) const noexcept { return std::min(segment_.next_event(), look_at_links_at_); }

}  // namespace meca::sim
