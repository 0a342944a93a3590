// Our end of an EtherNet/IP connection: the originator, as a machine without I/O. Bytes, events and time come in;
// bytes, wishes and facts go out. Whoever owns the sockets feeds it and does what it wishes for. No allocation, no
// clock.
//
// The way of a connection: TCP -> RegisterSession -> identity (GetAttributesAll, or ListIdentity where a device does
// not offer that) -> Forward Open -> I/O over UDP; on any failure Forward Close as far as it goes, back-off, and again,
// with a new connection serial. The loss of TCP alone is no I/O fault (devices close idle sessions while I/O goes on);
// a new one is opened when it is needed to close.
//
// Once a cycle, in this order: what has arrived (TCP, UDP), tick(), wants_tcp(), produce(), tcp_output().
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include "transports/ethernet_ip/cip.hpp"
#include "transports/ethernet_ip/io_packet.hpp"
#include "transports/image/image.hpp"
#include "transports/text.hpp"

namespace meca::ethernet_ip {

using Time = std::chrono::nanoseconds;  // monotonic

// The Meca500 as the vendor's EDS 11.3 and Omron projects describe it.
inline constexpr std::uint16_t kMecademicVendor = 1565, kRobotDeviceType = 43, kMeca500ProductCode = 500;
inline constexpr std::uint8_t kOutputPoint = 150, kInputPoint = 100;
inline constexpr std::uint16_t kOutputSize = 66;  // sequence count 2, run/idle header 4, image 60
inline constexpr std::uint16_t kInputSize = 254;  // sequence count 2, image 252

enum class KeyPolicy : std::uint8_t {
  kNone,        // no electronic key: the identity that was read is checked by us alone
  kCompatible,  // vendor, type, product, and a revision that the device can stand in for
  kExact,       // and exactly this revision
};

struct OriginatorSettings {
  std::uint32_t o_to_t_rpi_us = 10'000, t_to_o_rpi_us = 10'000;
  std::uint8_t multiplier_code = 2;  // x16: 160 ms at 10 ms; x4 is tight for a general purpose system
  bool multicast = false;            // T->O
  bool large = false;                // Large Forward Open; never needed for these sizes
  KeyPolicy key = KeyPolicy::kNone;
  std::uint8_t major = 0, minor = 0;  // of the key
  std::uint16_t vendor_id = 0;        // ours; with the serial number the owner of the robot's outputs
  std::uint32_t serial_number = 0;  // ours; the same after a restart, so that a robot that kept our ownership knows us
  std::uint16_t incarnation = 0;    // upper half of the connection ids we choose: random, so that packets of an earlier
                                    // life are not taken for ours
  std::uint32_t address = 0;        // the robot's IPv4, host byte order
  std::uint16_t tcp_port = kTcpPort;  // of the robot; for the sentences only: the owner of the socket connects
  std::uint16_t io_port = kIoPort;    // where we listen; not 2222: told to the robot by a socket address item
  Time reply_timeout = std::chrono::seconds(2);          // TCP connect, and each explicit reply
  Time first_packet_timeout = std::chrono::seconds(10);  // at least; the watchdog where that is longer
  Time shortest_backoff = std::chrono::milliseconds(200), longest_backoff = std::chrono::seconds(10);
  Time tick = std::chrono::milliseconds(1);  // how often produce() is asked: what is due within half of it is due now
};

// Monotonic counters since construction.
struct OriginatorCounters {
  std::uint64_t sent = 0, received = 0;   // I/O packets; received: accepted as new data
  std::uint64_t lost = 0;                 // gaps in the robot's encapsulation sequence
  std::uint64_t stale = 0;                // older than, or the same as, one seen already
  std::uint64_t repeated = 0;             // alive, but the same sequence count: no new data
  std::uint64_t foreign = 0;              // right connection, wrong sender; or wrong connection from the robot
                                          // (its last packets of an earlier connection too)
  std::uint64_t malformed = 0;            // of a size or form that the connection does not have
  std::uint64_t watchdog_trips = 0;       // no packet for API x multiplier
  std::uint64_t opens = 0, refusals = 0;  // Forward Opens that succeeded, that were refused
  std::uint64_t skipped_sends = 0;        // periods in which nobody asked us to produce
};

class Originator {
 public:
  enum class State : std::uint8_t {
    kWaiting,      // until the back-off is over
    kConnecting,   // TCP
    kRegistering,  // RegisterSession
    kIdentifying,  // GetAttributesAll of the Identity object, or ListIdentity
    kOpening,      // Forward Open
    kRunning,      // I/O in both directions
    kClosing,      // Forward Close on the way out, or after a fault
    kClosed,       // after close(): for ever
  };

  // `first_connection_serial`: something that was not used lately (from the clock or random), never 1 after every
  // start.
  Originator(const OriginatorSettings& settings, std::uint16_t first_connection_serial) noexcept;

  void tick(Time now) noexcept;  // time-outs, back-off, watchdog; at least once a cycle
  // The orderly good-bye: Forward Close, UnregisterSession. Done when state() is kClosed (within reply_timeout).
  void close(Time now) noexcept;

  // ---- TCP, for the owner of the socket
  // Connect (or keep) when true, close when false. Look after every tick(): a connection that is to be replaced shows
  // as one look that is false.
  bool wants_tcp() const noexcept;
  // `own_ipv4`: our address on this connection, host byte order; the robot may name it as where it sends to.
  void tcp_connected(Time now, std::uint32_t own_ipv4 = 0) noexcept;
  // Connecting failed, or the connection is gone; not needed for one that was closed because wants_tcp() said so.
  // `why`: "connection refused"; empty: closed by the robot.
  void tcp_closed(std::string_view why, Time now) noexcept;
  void tcp_received(Bytes bytes, Time now) noexcept;  // split and glued as they come
  Bytes tcp_output() const noexcept;                  // to be sent, as much as goes
  void tcp_sent(std::size_t count) noexcept;

  // ---- UDP
  // A datagram on our I/O port. True when it came from this robot (whatever became of it).
  bool io_received(const SocketAddress& from, Bytes datagram, Time now) noexcept;
  // The multicast group to be a member of, host byte order; 0: none. The owner says when joining failed.
  std::uint32_t group() const noexcept;
  void join_failed(std::string_view why, Time now) noexcept;

  // The next O->T packet when it is due, else empty. `run`: false while there is nothing to say: idle keeps the
  // connection alive and the robot ignores the data. Absolute deadlines; what was missed is skipped and counted.
  struct Datagram {
    SocketAddress to;
    Bytes bytes;  // until the next call
  };
  std::optional<Datagram> produce(const image::OutputBytes& outputs, bool run, Time now) noexcept;
  // When the next packet is due; nothing while not running.
  std::optional<Time> next_send() const noexcept;

  // ---- Facts
  State state() const noexcept { return state_; }
  bool running() const noexcept;                    // the connection is open and its first packet has arrived
  const image::InputBytes& input() const noexcept;  // last accepted
  bool take_fresh() noexcept;                       // a new image since the last call
  // Why it is not running, a sentence without full stop that names what was asked, what the robot said and what to do;
  // empty while nothing is wrong. What was last wrong stays until the connection runs; then it is what the robot
  // granted, if that is not what was asked.
  std::string_view trouble() const noexcept { return trouble_.view(); }
  const std::optional<Identity>& identity() const noexcept { return identity_; }
  std::uint32_t o_to_t_api_us() const noexcept { return o_to_t_api_us_; }  // 0 while not open
  std::uint32_t t_to_o_api_us() const noexcept { return t_to_o_api_us_; }
  const OriginatorCounters& counters() const noexcept { return counters_; }

 private:
  // What the robot has not answered yet; one at a time.
  enum class Pending : std::uint8_t {
    kNothing,
    kRegisterSession,
    kIdentity,
    kListIdentity,
    kForwardOpen,
    kForwardClose
  };
  using Text = FixedText<191>;

  // originator.cpp: the life of a connection
  void connect(Time now) noexcept;
  void fail(const Text& why, Time now) noexcept;
  void begin_closing(Time now) noexcept;
  void end_session() noexcept;
  void closed() noexcept;
  void drop_tcp() noexcept;
  void tick_closing(Time now) noexcept;
  const char* name_of_pending() const noexcept;
  Text no_answer() const noexcept;

  // originator_open.cpp: messages over TCP
  void send_register_session(Time now) noexcept;
  void send_identity_request(Time now) noexcept;
  void send_list_identity(Time now) noexcept;
  void send_forward_open(Time now) noexcept;
  void send_forward_close(Time now) noexcept;
  void send_unregister_session() noexcept;
  void send_encapsulated(Command command, Bytes data) noexcept;
  void send_unconnected(Bytes message, bool with_own_port) noexcept;
  void expect(Pending answer, Time now) noexcept;
  void oversized(std::size_t size, Time now) noexcept;
  void message_received(const Header& header, Bytes data, Time now) noexcept;
  void session_registered(std::uint32_t session, Time now) noexcept;
  void reply_received(Bytes data, Time now) noexcept;
  void identity_received(const Reply& reply, Time now) noexcept;
  void identified(const std::optional<Identity>& identity, Time now) noexcept;
  void open_answered(const Reply& reply, const Items& items, Time now) noexcept;
  void open_refused(const Reply& reply, Time now) noexcept;
  void close_answered(Time now) noexcept;
  std::optional<Text> check(const ForwardOpenReply& reply) const noexcept;
  std::optional<Text> accept_destination(const Items& items) noexcept;
  std::optional<Text> accept_source(const Items& items) noexcept;

  // originator_io.cpp: the connection itself
  void run(const ForwardOpenReply& reply, Time now) noexcept;
  void packet_received(const IoPacket& packet, Time now) noexcept;
  Time watchdog() const noexcept;
  Text silence() const noexcept;
  Text other_intervals() const noexcept;

  OriginatorSettings settings_;
  State state_ = State::kWaiting;
  Text trouble_;
  std::optional<Identity> identity_;
  std::uint32_t o_to_t_api_us_ = 0, t_to_o_api_us_ = 0;
  OriginatorCounters counters_;

  // The way there and back
  Pending pending_ = Pending::kNothing;
  Time deadline_{};      // of connecting, of what is pending, of closing
  Time next_attempt_{};  // while waiting
  bool started_ = false;
  bool for_good_ = false;      // close() was called
  bool maybe_open_ = false;    // the robot may hold the connection of open_.triad
  bool duplicate_ = false;     // in this attempt, a connection that was open already has been closed
  bool reconnected_ = false;   // TCP was lost while closing, and is tried once more
  std::uint8_t hold_off_ = 0;  // ticks until TCP may be wanted again
  unsigned failures_ = 0;      // in a row
  ForwardOpen open_;           // as it was asked last
  std::uint16_t next_serial_;
  std::array<std::byte, 16> path_{};
  std::size_t path_size_ = 0;

  // TCP
  bool tcp_up_ = false;
  std::uint32_t session_ = 0;  // 0: none
  std::uint32_t own_address_ = 0;
  std::array<std::byte, kHeaderSize + kMaxData> received_{};
  std::size_t received_size_ = 0;
  std::array<std::byte, 2 * (kHeaderSize + kMaxData)> output_{};
  std::size_t output_begin_ = 0, output_end_ = 0;

  // I/O
  SocketAddress destination_;
  std::uint32_t group_ = 0;
  std::uint32_t o_to_t_id_ = 0, t_to_o_id_ = 0;
  Time next_send_{}, watchdog_at_{}, first_packet_at_{};
  std::uint32_t sent_sequence_ = 0, received_sequence_ = 0;
  std::uint16_t sent_count_ = 0, received_count_ = 0;
  bool receiving_ = false;           // the first packet has arrived
  std::size_t unexpected_size_ = 0;  // of the data of the last packet, where it was wrong
  std::array<std::byte, kIoOverhead + kOutputSize> packet_{};
  image::InputBytes input_{};
  bool fresh_ = false;
};

}  // namespace meca::ethernet_ip
