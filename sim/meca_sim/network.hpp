// What a station turns, whatever the bus: simulated robots, and the sockets that put them on a network.
#pragma once

#include <cstddef>
#include <string>

#include "sim/meca_sim/narrator.hpp"
#include "sim/network_faults.hpp"
#include "transports/net/poller.hpp"

namespace meca::sim {

class Network {
 public:
  virtual ~Network() = default;

  virtual std::size_t size() const noexcept = 0;  // robots
  virtual Robot& robot(std::size_t index) noexcept = 0;
  virtual NetworkFaults& faults(std::size_t index) noexcept = 0;
  virtual Narrator& narrator(std::size_t index) noexcept = 0;
  // "EtherNet/IP at 127.0.0.1"
  virtual std::string place(std::size_t index) const = 0;

  // What has arrived goes to the robots, what they answer goes out, and they live until `now`. Does not block.
  virtual void exchange(Time now) noexcept = 0;
  // What exchange() waits for, in slots() slots of the poller from `first` on.
  virtual std::size_t slots() const noexcept = 0;
  virtual void wait_for(net::Poller& poller, std::size_t first, Time now) const noexcept = 0;
  virtual Time next_event(Time now) const noexcept = 0;  // when exchange() has something to do by itself

  // What could not be had, of all of them, and is tried again. Empty: nothing.
  virtual const std::string& trouble() const noexcept = 0;
};

}  // namespace meca::sim
