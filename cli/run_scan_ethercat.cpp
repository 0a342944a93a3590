// `meca-ctl scan ethercat`: asks every device of a chain with raw Ethernet frames. No DDS, no bridge.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cli/plan.hpp"
#include "cli/run.hpp"
#include "cli/scan_ethercat.hpp"
#include "transports/ethercat/scan.hpp"
#include "transports/net/clock.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/raw_ethernet.hpp"

namespace meca::cli {
namespace {

std::vector<net::RawEthernet> open_all(const std::vector<std::string>& interfaces) try {
  std::vector<net::RawEthernet> out;
  for (const std::string& interface : interfaces) out.emplace_back(interface, ethercat::kEtherType);
  return out;
} catch (const std::runtime_error& error) {
  throw UsageError(error.what());
}

void need_carrier(net::RawEthernet& socket) {
  switch (socket.link()) {
    case net::RawEthernet::Link::kUp:
      return;
    case net::RawEthernet::Link::kNoCarrier:
      throw UsageError(socket.interface() +
                       " has no carrier: there is no cable, or nobody with power at its other end");
    case net::RawEthernet::Link::kDown:
      throw UsageError(socket.interface() + " is switched off: sudo ip link set " + socket.interface() + " up");
    case net::RawEthernet::Link::kGone:
      throw UsageError(socket.interface() + " has gone away");
  }
}

// Frames of a chain leave at one interface; in a ring they come back at another one.
class Asking {
 public:
  Asking(std::vector<net::RawEthernet>& sockets, std::size_t through, const ethercat::ScanSettings& settings)
      : sockets_(sockets), through_(through), scan_(settings, net::monotonic()), poller_(sockets.size()) {
    for (std::size_t i = 0; i < sockets.size(); ++i) poller_.watch(i, sockets[i].descriptor());
  }

  void run() {
    while (!interrupted) {
      scan_.tick(net::monotonic());
      const auto frame = scan_.next_frame(net::monotonic());
      if (scan_.done()) return;
      if (!frame.empty()) sockets_[through_].send(frame);
      poller_.wait(scan_.next_event());
      for (std::size_t i = 0; i < sockets_.size(); ++i) listen(i);
    }
  }
  const ethercat::Scan& scan() const { return scan_; }
  // In a ring, the interface where the answers came.
  std::optional<std::size_t> ring_end() const { return answered_at_ == through_ ? std::nullopt : answered_at_; }
  // Devices process frames on their way from port 0 to port 1 only: from the far end of a ring they pass untouched.
  bool from_far_end_of_ring() const { return echoed_at_ && echoed_at_ != through_; }

 private:
  void listen(std::size_t i) {
    std::array<std::byte, net::RawEthernet::kLongestFrame> buffer;
    while (const auto size = sockets_[i].receive(buffer)) {
      const auto frame = std::span(buffer).first(std::min(*size, buffer.size()));
      const auto echoes = scan_.echoes();
      if (scan_.received(frame, net::monotonic())) answered_at_ = i;
      if (scan_.echoes() != echoes) echoed_at_ = i;
    }
  }

  std::vector<net::RawEthernet>& sockets_;
  std::size_t through_;
  ethercat::Scan scan_;
  net::Poller poller_;
  std::optional<std::size_t> answered_at_, echoed_at_;
};

void tell(const ScannedChain& chain, const Report& report) {
  report.text(chain_text(chain));
  for (const auto& device : chain.devices) report.object(to_json(chain, device));
}

}  // namespace

ExitCode run_scan_ethercat(const Invocation& call, const Report& report) {
  ethercat::ScanSettings settings;
  if (call.timeout_s) settings.patience = seconds_of(*call.timeout_s);
  auto sockets = open_all(call.interfaces);
  for (auto& socket : sockets) need_carrier(socket);

  ExitCode code = ExitCode::kDone;
  std::vector<bool> told(sockets.size());
  for (std::size_t i = 0; i < sockets.size(); ++i) {
    if (told[i]) continue;
    Asking asking(sockets, i, settings);
    asking.run();
    if (interrupted) return ExitCode::kInterrupted;
    const auto& scan = asking.scan();
    if (asking.from_far_end_of_ring()) continue;
    const std::string& interface = sockets[i].interface();
    if (scan.devices().empty()) {
      code = report.error(ExitCode::kRefused, nobody_in_chain(interface, settings.patience, scan.echoes() > 0));
      continue;
    }
    ScannedChain chain{interface, {scan.devices().begin(), scan.devices().end()}, scan.frames_of_others() > 0, ""};
    if (const auto end = asking.ring_end()) {
      chain.ring_end = sockets[*end].interface();
      told[*end] = true;
    }
    tell(chain, report);
  }
  return code;
}

}  // namespace meca::cli
