// One robot's cycle as a machine without threads, clocks or I/O: requests, the robot's image and the time come in;
// the next output image and the facts of this cycle go out. The loop calls it once per bus cycle.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "bridge/control/client_rules.hpp"
#include "bridge/control/messages.hpp"
#include "transports/image/codec.hpp"
#include "transports/image/image.hpp"
#include "transports/transport.hpp"

namespace meca::bridge {

using transports::Time;

enum class Quality : std::uint8_t { kUnknown, kGood, kStale, kDisconnected };

struct Stamp {
  Time now{};                // monotonic
  std::int64_t unix_ns = 0;  // wall clock, for people and for HostTime only: nothing is decided by it
};

// Limits and choices of one robot, from its configuration.
struct CycleSettings {
  Time cycle = std::chrono::milliseconds(1);
  std::endian byte_order = std::endian::little;
  Time lease = std::chrono::milliseconds(100);          // control lapses when not renewed for this long
  Time velocity_lease = std::chrono::milliseconds(50);  // velocity stream: zero velocity when not fresh
  Time stale_after = std::chrono::milliseconds(3);      // no fresh image for longer: quality STALE
  Time action_timeout = std::chrono::seconds(30);       // activate, home, ...: a missing confirmation is an answer
  Time acknowledge_timeout = std::chrono::seconds(1);   // MoveID echo
  bool monitoring_only = false;                         // this bridge never commands this robot
  bool allow_brakes = false;
  control::ClientRules clients{};                                  // priorities, policies
  transports::FirmwareVersion firmware{};                          // expected; all 0 = auto
  std::array<std::uint32_t, image::kDynamicSlots> dynamic_data{};  // types to ask for; 0 = automatic
};

struct CycleCounters {
  std::uint64_t fresh_images = 0, stale_cycles = 0;
  std::uint32_t link_losses = 0;
  std::uint64_t commands_received = 0, commands_rejected = 0;
};

// Everything the publisher needs to know of one cycle of one robot.
struct CycleRecord {
  std::uint64_t cycle = 0;
  std::int64_t receive_unix_ns = 0;  // of the image in `inputs`
  Quality quality = Quality::kDisconnected;
  transports::LinkState link = transports::LinkState::kDown;
  transports::LinkDetail link_detail;
  bool closing = false;  // the last record: the bridge has said good-bye and stops
  std::array<std::int64_t, transports::kMostCounters> transport_counters{};  // of Transport::counters()
  bool firmware_known = false;
  bool firmware_mismatch = false;  // the robot reports another layout than the configuration expects
  transports::FirmwareVersion firmware;
  image::Layout layout = image::Layout::kFirmware11;
  std::uint32_t product_type = 0;   // dynamic data type 2; 3 = Meca500 R3, 4 = R4; 0 = not known yet
  std::uint32_t serial_number = 0;  // dynamic data type 3; 0 = not known yet
  image::Inputs inputs;             // last known
  image::Outputs outputs;           // what is being sent in this cycle
  control::ControlState control;
  CycleCounters counters;
};

struct StepResult {
  static constexpr std::size_t kMaxReceipts = 256;
  CycleRecord record;
  std::array<control::Receipt, kMaxReceipts> receipts;  // the first receipt_count are of this cycle, in order
  std::size_t receipt_count = 0;
};

class Cycle {
 public:
  explicit Cycle(const CycleSettings& settings);  // allocates; nothing after it does
  ~Cycle();
  Cycle(Cycle&&) noexcept;
  Cycle& operator=(Cycle&&) noexcept;

  // Reads what the last exchange brought and the requests since the last step, writes the output bytes of the next
  // exchange (exchange.output, exchange.output_valid) and the facts of this cycle.
  void step(std::span<const control::Request> requests, transports::Exchange& exchange, Stamp stamp,
            StepResult& result) noexcept;

  // After a ShutdownRequest: the robot is stopped, its queue is cleared, and every receipt has been handed out. A
  // second ShutdownRequest ends what still waits.
  bool finished() const noexcept;

  // How many requests step() will take without filling `StepResult::receipts`: the loop hands over at most this many.
  static constexpr std::size_t kMaxRequests = 32;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace meca::bridge
