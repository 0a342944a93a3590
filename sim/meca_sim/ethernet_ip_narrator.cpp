#include "sim/meca_sim/ethernet_ip_narrator.hpp"

#include "transports/net/ipv4.hpp"

namespace meca::sim {
namespace {

using Counters = ethernet_ip::AdapterCounters;
using Level = Narrator::Level;

// Packets that are dropped without an answer: the host only sees its connection time out, so the first one is told.
struct Dropped {
  std::uint64_t Counters::*count;
  const char* sentence;
};
constexpr Dropped kDropped[] = {
    {&Counters::malformed,
     "an O->T packet is of a wrong form or length and is ignored; expected are 66 bytes of data: sequence count 2, "
     "run/idle header 4, outputs 60"},
    {&Counters::foreign,
     "an O->T packet is of no connection that is open, or not from the address that opened it, and is ignored"},
    {&Counters::stale, "an O->T packet has an old sequence number and is ignored"},
    {&Counters::repeated, "an O->T packet has a sequence count that is not newer: no new data"},
    {&Counters::discarded, "a message over port 44818 makes no sense to this robot and gets no answer"},
};

}  // namespace

void EthernetIpNarrator::look_at_connection() {
  look_at_host();
  look_at_refused_packets();
  seen_ = robot_.adapter().counters();
}

void EthernetIpNarrator::look_at_host() {
  const ethernet_ip::Adapter& adapter = robot_.adapter();
  const Counters& now = adapter.counters();
  if (now.timeouts != seen_.timeouts) say_(Level::kWarning, "the I/O connection timed out: no O->T packets any more");
  if (now.closes != seen_.closes) say_(Level::kInfo, "the I/O connection was closed by its host");
  if (now.opens != seen_.opens && adapter.connected()) {
    say_(Level::kInfo, "the I/O connection was opened by " + net::to_string(adapter.originator()));
  }
  if (now.refusals != seen_.refusals) {
    say_(Level::kWarning, "a Forward Open or Forward Close was refused, " + counted(now.refusals, "until now"));
  }
  if (adapter.run() == running_) return;
  running_ = adapter.run();
  if (running_) say_(Level::kInfo, "the host says run");
  if (!running_ && adapter.connected()) say_(Level::kInfo, "the host says idle: its outputs are not applied");
}

void EthernetIpNarrator::look_at_refused_packets() {
  const Counters& now = robot_.adapter().counters();
  for (const Dropped& dropped : kDropped) {
    if (seen_.*dropped.count == 0 && now.*dropped.count != 0) {
      say_(Level::kWarning, dropped.sentence + std::string("; more are only counted"));
    }
  }
}

std::string EthernetIpNarrator::connection_summary() const {
  const Counters& c = robot_.adapter().counters();
  return counted(c.opens, "opened, ") + counted(c.closes, "closed, ") + counted(c.timeouts, "timed out, ") +
         counted(c.refusals, "refused; O->T packets: ") + counted(c.consumed, "new (") + counted(c.idle, "idle), ") +
         counted(c.repeated, "repeated, ") + counted(c.stale, "stale, ") + counted(c.foreign, "foreign, ") +
         counted(c.malformed, "malformed; T->O packets: ") + std::to_string(c.produced);
}

}  // namespace meca::sim
