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

enum class Fieldbus : std::uint8_t { kEthernetIp, kEthercat };

struct NetworkFaults {
  Fieldbus bus = Fieldbus::kEthernetIp;  // which this network is; not a fault

  bool unplugged = false;  // nothing goes in or out; EtherCAT: neither by the cable before nor by the one behind it
  bool without_power = false;
  bool frozen = false;  // explicit messages and mails are answered, I/O is not handled
  Time late{};          // explicit messages and discovery are answered so much later; EtherCAT: every frame
  bool duplicate = false, corrupt = false;  // T->O packets, or frames, come twice; have not all their bytes

  // EtherCAT (transports/ethercat/device.hpp says what most of them do)
  bool cut = false;              // the cable before this robot, towards the master
  bool cut_behind = false;       // the one behind it; of the last robot of a ring: back to the master
  std::uint32_t lose_next = 0;   // so many frames do not come back; counted down by who loses them
  std::uint32_t lose_every = 0;  // one of so many frames does not come back; 0: none
  int working_counter = 0;
  std::optional<std::uint16_t> refuse_state;
  bool lose_mails = false, no_mailbox = false;
  std::int32_t clock_drift = 0;  // ppm, on top of what its clock drifts by itself
  bool foreign = false;          // another maker's device is in its place

  // EtherNet/IP (transports/ethernet_ip/adapter.hpp says what each does)
  std::optional<std::uint16_t> refuse_open;
  std::optional<std::uint16_t> wrong_size;
  std::optional<std::uint32_t> api_us;
  bool no_socket_items = false;
  std::optional<NetworkAddress> foreign_address;
  bool stop_producing = false, stale_sequence = false, frozen_count = false;

  // Not states but events: how often each was asked for, and with which code last.
  struct Events {
    std::uint64_t tcp_closures = 0, al_errors = 0, emergencies = 0;
    std::uint16_t al_error = 0, emergency = 0;
    friend bool operator==(const Events&, const Events&) = default;
  };
  Events events;

  friend bool operator==(const NetworkFaults&, const NetworkFaults&) = default;
};

}  // namespace meca::sim
