// EtherNet/IP as a transport: one bus for all EtherNet/IP robots of a process. They share a UDP socket for the cyclic
// packets, told apart by their addresses; each has a TCP connection for explicit messages. Sending does not depend on
// the phase of the loop: while the loop waits here, every packet leaves when it is due.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "transports/ethernet_ip/originator.hpp"
#include "transports/transport.hpp"

namespace meca::ethernet_ip {

// Who we are to the robots. ODVA has assigned no vendor id to this project: this one is a choice, from the end of the
// range where none were seen. Write your own where you have one.
inline constexpr std::uint16_t kOurVendorId = 0xDD5B;

struct RobotOptions {
  std::string address;  // host name or IPv4
  std::uint16_t tcp_port = kTcpPort;
  std::uint32_t rpi_us = 10'000;          // requested packet interval, both directions
  std::uint32_t timeout_multiplier = 16;  // 4, 8 .. 512: RPI x multiplier without a packet ends the connection
  bool multicast = false;                 // T->O; needs BusOptions::bind 0
  bool large_forward_open = false;
  KeyPolicy key = KeyPolicy::kNone;
  std::uint8_t key_major = 0, key_minor = 0;
};

struct BusOptions {
  std::uint32_t bind = 0;           // own IPv4 address for UDP and TCP, host byte order; 0: all
  std::uint16_t io_port = kIoPort;  // another one than 2222 is told to the robots when a connection is opened
  std::uint16_t vendor_id = kOurVendorId;
  std::uint32_t serial_number = 0;  // 0: made of this machine's identity and `name`, the same after every start
  std::string name;                 // of the program; two of them on one machine must differ
};

// At most transports::kMostCounters counters; config/ethernet_ip.yaml says what each one means.
std::unique_ptr<transports::Transport> make_transport(std::vector<RobotOptions> robots, BusOptions options);

// The code of a multiplier for OriginatorSettings: 4 -> 0, 8 -> 1 .. 512 -> 7; others are rounded down.
std::uint8_t multiplier_code(std::uint32_t multiplier) noexcept;

}  // namespace meca::ethernet_ip
