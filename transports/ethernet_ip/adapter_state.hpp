// The inside of the adapter, for its own files (adapter*.cpp) only: what it remembers, and which file does what.
#pragma once

#include "transports/ethernet_ip/adapter.hpp"

namespace meca::ethernet_ip {

inline constexpr std::size_t kMostRequest = 1024;  // data of a message we look at; a longer one is skipped and refused
inline constexpr std::size_t kMostReply = 640;     // data of the longest reply: an assembly, or the link object

struct TcpPeer {
  bool used = false, closing = false;
  std::uint32_t ipv4 = 0;
  std::uint32_t session = 0;  // 0: not registered
  Time last_heard{};
  std::array<std::byte, kHeaderSize + kMostRequest> in{};
  std::size_t in_size = 0, to_skip = 0;  // to_skip: of a message that is too long
  std::array<std::byte, 4 * (kHeaderSize + kMostReply)> out{};
  std::size_t out_size = 0;
};

// The one class 1 connection that this device has: exclusive owner, 150 -> 100.
struct IoConnection {
  bool open = false;
  ConnectionTriad triad;
  std::uint32_t originator = 0;  // IPv4
  std::uint32_t o_to_t_id = 0, t_to_o_id = 0;
  SocketAddress to;
  bool multicast = false;
  Time watchdog{};  // API x multiplier of O->T
  Time deadline{};  // of the next O->T packet
  // O->T
  bool heard = false, run = false, fresh = false;
  std::uint32_t sequence = 0;
  std::uint16_t count = 0;
  // T->O
  Time period{}, next_send{};
  std::uint32_t sent_sequence = 0;
  std::uint16_t sent_count = 0;
  std::size_t input_size = kInputSize;
  bool stale_turn = false;   // of AdapterFaults::stale_sequence
  bool repeat_last = false;  // of AdapterFaults::duplicate
};

// Who may come back after a time-out (OwnershipPolicy::kKeep).
struct Owner {
  std::uint16_t vendor = 0;
  std::uint32_t serial = 0;
  friend bool operator==(const Owner&, const Owner&) = default;
};

struct AdapterState {
  explicit AdapterState(const AdapterSettings& s) noexcept;

  AdapterSettings settings;
  AdapterFaults faults;
  AdapterCounters counters;
  image::InputBytes input{};
  image::OutputBytes output{};
  std::array<TcpPeer, Adapter::kMostConnections> peers;
  std::uint32_t last_session = 0;    // handles are never given twice: an old one is always wrong
  std::uint32_t last_connection_id;  // the same for connection ids
  std::uint32_t random;              // state of the delay of broadcast answers
  IoConnection io;
  std::optional<Owner> kept_owner;
  std::array<std::byte, kIoOverhead + 1024> io_packet{};
  std::size_t io_packet_size = 0;
  std::array<std::byte, kHeaderSize + kMostReply> udp_answer{};
};

// ---- adapter_session.cpp: encapsulation
void receive_tcp(AdapterState& s, TcpPeer& peer, Bytes bytes, Time now) noexcept;
Adapter::Answer answer_udp(AdapterState& s, Bytes datagram, bool broadcast) noexcept;

// ---- adapter_objects.cpp: explicit messages
// Socket address items that go beside a reply of the Connection Manager.
struct SocketItems {
  std::optional<SocketAddress> o_to_t, t_to_o;
};
// `items`: the whole request; `cip`: its unconnected data. False: this is not a request, and nothing was written.
bool answer_request(AdapterState& s, const TcpPeer& peer, const Items& items, Bytes cip, Time now, wire::Writer& out,
                    SocketItems& socket_items) noexcept;
// The extended status that says what of the key does not fit; nothing: it fits.
std::optional<std::uint16_t> check_key(const AdapterSettings& s, const ElectronicKey& key) noexcept;

// ---- adapter_connection.cpp: the Connection Manager
void forward_open(AdapterState& s, const TcpPeer& peer, const Items& items, const Request& request, Time now,
                  wire::Writer& out, SocketItems& socket_items) noexcept;
void forward_close(AdapterState& s, const TcpPeer& peer, const Request& request, wire::Writer& out) noexcept;
// The default allocation of multicast groups: 239.192.1.0 + 32 x (host part - 1), ten bits of it (CIP Vol 2, 3-5.3).
std::uint32_t multicast_group(const AdapterSettings& s) noexcept;

// ---- adapter_io.cpp: class 1
void consume(AdapterState& s, const SocketAddress& from, Bytes datagram, Time now) noexcept;
std::optional<Adapter::Datagram> produce(AdapterState& s, Time now) noexcept;
// Ends the connection when O->T has been silent for too long.
void check_watchdog(AdapterState& s, Time now) noexcept;
void end_connection(AdapterState& s) noexcept;

}  // namespace meca::ethernet_ip
