// What may be wrong, on request, between a simulated robot and its host. Everything off is a healthy network. Who acts
// on it is the program that puts the robot behind a network (sim/meca_sim).
#pragma once

#include <cstdint>
#include <optional>

#include "sim/journal.hpp"

namespace meca::sim {

struct NetworkAddress {
  std::uint32_t ipv4 = 0;  // host byte order
  std::uint16_t port = 0;
  friend bool operator==(const NetworkAddress&, const NetworkAddress&) = default;
};

struct NetworkFaults {
  bool unplugged = false;  // nothing goes in or out
  bool frozen = false;     // explicit messages are answered, I/O is not handled
  Time late{};             // explicit messages and discovery are answered so much later

  // EtherNet/IP (transports/ethernet_ip/adapter.hpp says what each does)
  std::optional<std::uint16_t> refuse_open;
  std::optional<std::uint16_t> wrong_size;
  std::optional<std::uint32_t> api_us;
  bool no_socket_items = false;
  std::optional<NetworkAddress> foreign_address;
  bool stop_producing = false, duplicate = false, stale_sequence = false, corrupt = false, frozen_count = false;

  // Not a state but events: how often it was asked for.
  std::uint64_t tcp_closures = 0;

  friend bool operator==(const NetworkFaults&, const NetworkFaults&) = default;
};

}  // namespace meca::sim
