// Our end of an EtherNet/IP connection: the originator, as a machine without I/O. Bytes, events and time come in;
// bytes, wishes and facts go out. Whoever owns the sockets feeds it and does what it wishes for. No allocation, no
// clock.
//
// The way of a connection: TCP -> RegisterSession -> identity (GetAttributesAll) -> Forward Open -> I/O over UDP; on
// any failure Forward Close as far as it goes, back-off, and again, with a new connection serial. The loss of TCP alone
// is no I/O fault (spec: encapsulation inactivity).
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
  std::uint32_t address = 0;        // the robot's IPv4, host byte order
  std::uint16_t io_port = kIoPort;  // where we listen; not 2222: told to the robot by a socket address item
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
    kIdentifying,  // GetAttributesAll of the Identity object
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
  bool wants_tcp() const noexcept;  // connect when true and not connected; close when false
  void tcp_connected(Time now) noexcept;
  // Connecting failed, or the connection is gone. `why`: static text ("connection refused"); empty: closed by the
  // robot.
  void tcp_closed(std::string_view why, Time now) noexcept;
  void tcp_received(Bytes bytes, Time now) noexcept;  // split and glued as they come
  Bytes tcp_output() const noexcept;                  // to be sent, as much as goes
  void tcp_sent(std::size_t count) noexcept;

  // ---- UDP
  // A datagram on our I/O port. True when it was for this connection (whatever became of it).
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
  // empty while nothing is wrong. What was last wrong stays until the connection runs.
  std::string_view trouble() const noexcept { return trouble_.view(); }
  const std::optional<Identity>& identity() const noexcept { return identity_; }
  std::uint32_t o_to_t_api_us() const noexcept { return o_to_t_api_us_; }  // 0 while not open
  std::uint32_t t_to_o_api_us() const noexcept { return t_to_o_api_us_; }
  const OriginatorCounters& counters() const noexcept { return counters_; }

 private:
  OriginatorSettings settings_;
  State state_ = State::kWaiting;
  FixedText<191> trouble_;
  std::optional<Identity> identity_;
  std::uint32_t o_to_t_api_us_ = 0, t_to_o_api_us_ = 0;
  OriginatorCounters counters_;
};

}  // namespace meca::ethernet_ip
