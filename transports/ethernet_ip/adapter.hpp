// The robot's end of EtherNet/IP: an adapter with the identity and assemblies of a Meca500, as a machine without I/O
// and stricter than adapters have to be. Bytes, events and time come in; bytes go out. No clock; allocates only in the
// constructor.
//
// What it answers in odd cases, and what of that is inferred: transports/ethernet_ip/README.md.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "transports/ethernet_ip/cip.hpp"
#include "transports/ethernet_ip/io_packet.hpp"
#include "transports/ethernet_ip/originator.hpp"
#include "transports/image/image.hpp"

namespace meca::ethernet_ip {

struct AdapterState;

// Which electronic keys open a connection. A key without the compatibility bit always means this very revision.
enum class AdapterKeyPolicy : std::uint8_t {
  kExact,                // a compatible key is read as an exact one
  kCompatibleSameMajor,  // a compatible key may name an older minor revision
  kCompatibleAnyOlder,   // a compatible key may name any older revision
  kOff,                  // keys are not looked at
};
enum class OwnershipPolicy : std::uint8_t {
  kReleaseOnTimeout,
  kKeep,  // like some real adapters: after a time-out only the same originator (vendor, serial) may come back
};

struct AdapterSettings {
  Identity identity;          // 1565 / 43 / 500, revision = firmware
  std::uint32_t address = 0;  // own IPv4, host byte order
  std::uint32_t netmask = 0xFFFFFF00;
  // Where it takes O->T, UDP: told in the socket address items. Another port than 2222 is for a device on the machine
  // of its originator, whose socket has that port already.
  std::uint16_t io_port = kIoPort;
  AdapterKeyPolicy key_policy = AdapterKeyPolicy::kCompatibleSameMajor;
  OwnershipPolicy ownership = OwnershipPolicy::kReleaseOnTimeout;
  bool lenient_rpi = false;  // false: 10 ms to 10 s as the EDS says; true: 1 ms and more
  // Socket address items in Forward Open replies. The group of a multicast connection is told in any case: nobody could
  // find it otherwise.
  bool socket_items = true;
  // TCP/IP Interface object, attribute 13: a TCP connection silent for so long is closed. 0: never.
  std::chrono::seconds inactivity_timeout{120};
};

// Faults on request; everything off is a healthy robot. Each acts from the moment it is set.
struct AdapterFaults {
  std::optional<std::uint16_t> refuse_open;  // extended status of every Forward Open
  std::optional<std::uint16_t> wrong_size;   // accept only this T->O size (0x0128 with it otherwise)
  std::optional<std::uint32_t> api_us;       // API of both directions, whatever RPI was asked; at least 1 ms is kept
  std::optional<SocketAddress> foreign_address;  // what the socket address items say; T->O goes where it always goes
  bool stop_producing = false;                   // connection open, no T->O
  bool duplicate = false;                        // every T->O packet twice
  bool stale_sequence = false;                   // every second packet carries an old sequence number
  bool corrupt = false;                          // T->O packets of a wrong length
  bool frozen_count = false;                     // the sequence count of class 1 stands still: no new data
  bool no_socket_items = false;                  // as with AdapterSettings::socket_items off
};

// What a test or a person may want to know; monotonic.
struct AdapterCounters {
  std::uint64_t consumed = 0;   // O->T packets with new data, run or idle
  std::uint64_t produced = 0;   // T->O packets, those that a fault spoils or repeats among them
  std::uint64_t stale = 0;      // O->T of an old encapsulation sequence: dropped, do not feed the watchdog
  std::uint64_t repeated = 0;   // O->T of a sequence count that is not newer: alive, no new data
  std::uint64_t foreign = 0;    // O->T of another connection id, or from another address than the opener's
  std::uint64_t malformed = 0;  // O->T of a wrong form or length
  std::uint64_t idle = 0;       // of `consumed`
  std::uint64_t opens = 0, refusals = 0, closes = 0, timeouts = 0;  // of connections
  std::uint64_t sessions = 0;                                       // registered
  std::uint64_t discarded = 0;  // encapsulation messages without an answer (options, status, session, command over UDP)
};

class Adapter {
 public:
  explicit Adapter(const AdapterSettings& settings);
  ~Adapter();
  Adapter(Adapter&&) noexcept;
  Adapter& operator=(Adapter&&) noexcept;

  static constexpr std::size_t kMostConnections = 8;  // of TCP; the owner refuses more

  // ---- TCP 44818. `id`: chosen by the owner, below kMostConnections.
  void tcp_accepted(std::size_t id, std::uint32_t peer_ipv4, Time now) noexcept;
  void tcp_closed(std::size_t id, Time now) noexcept;  // I/O goes on
  void tcp_received(std::size_t id, Bytes bytes, Time now) noexcept;
  Bytes tcp_output(std::size_t id) const noexcept;
  void tcp_sent(std::size_t id, std::size_t count) noexcept;
  bool wants_closed(std::size_t id) const noexcept;  // the owner closes when everything has been sent

  // ---- UDP 44818: ListIdentity, ListServices; everything else is not answered. Empty: no answer.
  // `delay`: a broadcast is answered after a random part of what the asker allows; the owner waits for it.
  struct Answer {
    Bytes bytes;  // until the next call
    Time delay{};
  };
  Answer udp_received(Bytes datagram, bool broadcast) noexcept;

  // ---- UDP 2222
  void io_received(const SocketAddress& from, Bytes datagram, Time now) noexcept;
  // The next T->O packet when one is due, else empty; call until empty. Absolute deadlines, no bursts.
  struct Datagram {
    SocketAddress to;  // unicast, or a group
    bool multicast = false;
    Bytes bytes;  // until the next call
  };
  std::optional<Datagram> produce(Time now) noexcept;
  std::optional<Time> next_event() const noexcept;  // when produce() or tick() has something to do
  void tick(Time now) noexcept;                     // watchdogs

  // ---- The robot behind it
  void set_input(const image::InputBytes& input) noexcept;  // what T->O carries from now on
  // The outputs of the owner: valid while it is connected and says run; fresh once for every new packet that says run.
  bool connected() const noexcept;
  bool run() const noexcept;
  std::uint32_t originator() const noexcept;  // IPv4 of the owner, host byte order; 0 while nobody is connected
  bool take_fresh() noexcept;
  const image::OutputBytes& output() const noexcept;

  // ---- Faults, and what only a fault can do
  AdapterFaults& faults() noexcept;
  void close_tcp_connections() noexcept;  // as a device that tidies up would
  // Sessions, connection and ownership are forgotten, and nothing is sent any more. Settings, faults, counters and the
  // robot's input stay: they are not the adapter's memory.
  void power_cycle() noexcept;
  const AdapterCounters& counters() const noexcept;

 private:
  std::unique_ptr<AdapterState> state_;
};

}  // namespace meca::ethernet_ip
