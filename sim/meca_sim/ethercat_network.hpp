// Simulated robots on EtherCAT with the interface, or the two of a ring, that lead to their master. Carries frames
// between sockets and an EthercatSegment; decides nothing.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "sim/meca_sim/ethercat_narrator.hpp"
#include "sim/meca_sim/ethercat_segment.hpp"
#include "sim/meca_sim/network.hpp"
#include "transports/net/file.hpp"
#include "transports/net/raw_ethernet.hpp"

namespace meca::sim {

class EthercatNetwork final : public Network {
 public:
  // `redundant_interface`: empty for a line. One `say` for each robot. Throws std::runtime_error with a sentence.
  EthercatNetwork(const std::vector<EthercatSegment::Member>& members, ConnectionLoss on_loss,
                  const std::string& interface, const std::string& redundant_interface, Time now,
                  const std::vector<Narrator::Say>& say);

  std::size_t size() const noexcept override { return segment_.size(); }
  Robot& robot(std::size_t index) noexcept override { return segment_.robot(index).robot(); }
  NetworkFaults& faults(std::size_t index) noexcept override { return segment_.robot(index).faults(); }
  Narrator& narrator(std::size_t index) noexcept override { return *narrators_[index]; }
  std::string place(std::size_t index) const override;

  void exchange(Time now) noexcept override;
  std::size_t slots() const noexcept override { return ports_.size(); }
  void wait_for(net::Poller& poller, std::size_t first, Time now) const noexcept override;
  Time next_event(Time now) const noexcept override;
  const std::string& trouble() const noexcept override { return trouble_; }

 private:
  using Side = EthercatSegment::Side;
  static constexpr int kMostAtOnce = 64;  // frames of a port in one exchange: a flood must not stop the robots

  bool exchange_one(std::size_t port) noexcept;
  void send_late(Time now) noexcept;
  void look_at_links(Time now) noexcept;

  std::vector<net::RawEthernet> ports_;  // by Side; the second one in a ring only
  std::vector<net::File> claims_;        // of their interfaces
  EthercatSegment segment_;
  std::vector<std::unique_ptr<EthercatNarrator>> narrators_;
  Time look_at_links_at_{};
  std::string trouble_;
  std::array<std::byte, net::RawEthernet::kLongestFrame> buffer_{};
};

}  // namespace meca::sim
