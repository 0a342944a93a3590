// `meca-ctl scan`: asks over UDP who is there. No DDS, no bridge; a robot that has an owner answers too.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cli/plan.hpp"
#include "cli/run.hpp"
#include "cli/scan.hpp"
#include "transports/net/clock.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/udp.hpp"

namespace meca::cli {
namespace {

net::UdpSocket open_socket(std::uint32_t from) try {
  return net::UdpSocket({from, 0}, {.broadcast = true});
} catch (const std::runtime_error& error) {
  throw UsageError(error.what());
}

std::vector<net::UdpSocket> ask(std::span<const ScanTarget> targets, std::chrono::milliseconds most_delay) {
  const auto request = ethernet_ip::list_identity_request(most_delay);
  std::vector<net::UdpSocket> sockets;
  for (const ScanTarget& target : targets) {
    sockets.push_back(open_socket(target.from));
    if (!sockets.back().send({target.to, ethernet_ip::kTcpPort}, request)) {
      throw UsageError("nothing can be sent to " + net::to_string(target.to) +
                       (target.interface.empty() ? "" : " on " + target.interface) +
                       ": there is no route; check the address, and --interface");
    }
  }
  return sockets;
}

void listen(std::span<net::UdpSocket> sockets, ethernet_ip::Discovery& discovery) {
  std::array<std::byte, 1500> buffer;
  for (net::UdpSocket& socket : sockets) {
    while (const auto received = socket.receive(buffer)) {
      discovery.received(received->from.ipv4, std::span(buffer).first(std::min(received->size, buffer.size())));
    }
  }
}

// One device that was asked alone has answered: nobody else will.
bool complete(std::span<const ScanTarget> targets, const ethernet_ip::Discovery& discovery) {
  const auto devices = discovery.devices();
  return targets.size() == 1 && std::ranges::any_of(devices, [&](const auto& device) {
           return std::ranges::count(device.addresses, targets.front().to) != 0;
         });
}

}  // namespace

ExitCode run_scan(const Invocation& call, const Report& report) {
  const auto targets = scan_targets(call, net::ipv4_interfaces());
  const auto wait = call.timeout_s ? seconds_of(*call.timeout_s) : std::chrono::nanoseconds(kScanWait);
  auto sockets = ask(targets, answer_delay(wait));
  net::Poller poller(sockets.size());
  for (std::size_t i = 0; i < sockets.size(); ++i) poller.watch(i, sockets[i].descriptor());

  ethernet_ip::Discovery discovery;
  const auto end = net::monotonic() + wait;
  while (!interrupted && net::monotonic() < end && !complete(targets, discovery)) {
    poller.wait(end);
    listen(sockets, discovery);
  }
  if (interrupted) return ExitCode::kInterrupted;
  const auto devices = discovery.devices();
  if (devices.empty()) return report.error(ExitCode::kRefused, nobody_answered(targets, wait));
  report.text(scan_text(devices));
  for (const auto& device : devices) report.object(to_json(device));
  return ExitCode::kDone;
}

}  // namespace meca::cli
