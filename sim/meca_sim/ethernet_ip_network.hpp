// A simulated robot on EtherNet/IP with its sockets.
#pragma once

#include "sim/meca_sim/ethernet_ip_narrator.hpp"
#include "sim/meca_sim/ethernet_ip_sockets.hpp"
#include "sim/meca_sim/network.hpp"

namespace meca::sim {

// `bind`: an address of this machine or the name of an interface. Throws std::runtime_error with a sentence.
net::Interface find_own_interface(const std::string& bind);

class EthernetIpNetwork final : public Network {
 public:
  // Opens the sockets at `own`. Throws std::runtime_error with a sentence.
  EthernetIpNetwork(const RobotOptions& model, ethernet_ip::AdapterSettings adapter, ConnectionLoss on_loss,
                    const net::Interface& own, Time now, Narrator::Say say);

  std::size_t size() const noexcept override { return 1; }
  Robot& robot(std::size_t) noexcept override { return robot_.robot(); }
  NetworkFaults& faults(std::size_t) noexcept override { return robot_.faults(); }
  Narrator& narrator(std::size_t) noexcept override { return narrator_; }
  std::string place(std::size_t) const override { return "EtherNet/IP at " + net::to_string(own_.address); }

  void exchange(Time now) noexcept override;
  std::size_t slots() const noexcept override { return EthernetIpSockets::kSlots; }
  void wait_for(net::Poller& poller, std::size_t first, Time now) const noexcept override {
    sockets_.wait_for(poller, first, now);
  }
  Time next_event(Time now) const noexcept override;
  const std::string& trouble() const noexcept override { return sockets_.trouble(); }

 private:
  net::Interface own_;
  EthernetIpRobot robot_;
  EthernetIpSockets sockets_;
  EthernetIpNarrator narrator_;
};

}  // namespace meca::sim
