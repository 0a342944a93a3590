// Frames of ours that are on their way: what stands in each, so that a reply finds back to the one who asked, exactly
// once, or its loss does. Replies are matched by index, command, length and address: of A and B commands without the
// ADP, which the devices change. With two ports (a ring) the two copies of a frame are merged into one reply.
// No allocation after construction, no clock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transports/ethercat/frame.hpp"

namespace meca::ethercat {

// What a datagram is for. `of`: robot, device or position; `step`: of the one who asked, to tell an old answer.
struct Purpose {
  enum class Kind : std::uint8_t {
    kProcessData,  // of a robot, both ways
    kInputs,
    kOutputs,
    kChainState,     // count of devices, OR of their AL states
    kReferenceTime,  // of the clock that all follow
    kStation,        // what the station asked for
    kAlStatus,
    kErrorCounters,
    kClearErrorCounters,
    kClockDifference,
    kScan,
    kClocks,
  };
  Kind kind = Kind::kChainState;
  std::uint8_t step = 0;
  std::uint16_t of = 0;
};

// One datagram to be sent.
struct Request {
  Command command = Command::kNop;
  std::uint32_t address = 0;
  std::uint16_t size = 0;
  Bytes data{};  // `size` bytes, or none: zeros
  Purpose purpose;
};

class InFlight {
 public:
  static constexpr std::size_t kMostFrames = 64;     // in flight at the same time
  static constexpr std::size_t kMostDatagrams = 48;  // in one frame

  enum class Use : std::uint8_t { kCyclic, kService };
  struct Timeouts {
    Time cyclic{}, service{};
    Time of(Use use) const noexcept { return use == Use::kCyclic ? cyclic : service; }
  };

  struct Frame {
    Use use = Use::kCyclic;
    std::uint64_t cycle = 0;
    Time sent{};
    bool in_flight = false;
    std::uint8_t index = 0;
    unsigned awaited = 1, arrived = 0;  // copies
    std::optional<std::size_t> from;    // the only port whose copy counts
    std::array<bool, 2> seen{};         // by port
    std::size_t count = 0;              // of datagrams
    struct Expected {
      Command command;
      std::uint32_t address;
      std::uint16_t size;
      Purpose purpose;
    };
    std::array<Expected, kMostDatagrams> datagrams;
    std::size_t size = 0;  // of what arrived
    std::array<std::byte, kLongestFrame> merged;
  };

  explicit InFlight(const MacAddress& source);

  // ---- Sending: begin, add, finish.
  // False: too many frames are in flight, nothing can be sent.
  bool begin(Use use, std::uint64_t cycle) noexcept;
  // False: does not fit; the frame is as before.
  bool add(const Request& request) noexcept;
  std::size_t room() const noexcept;  // bytes of data that one more datagram may have
  // The frame, which is in flight from now on and comes back as often as `copies` says; valid until the next begin().
  // Empty when nothing was added.
  struct Copies {
    unsigned count = 1;
    std::optional<std::size_t> from{};  // with one: the port that it has to come from
  };
  Bytes finish(const Copies& copies, Time now) noexcept;

  // ---- Receiving
  enum class Verdict : std::uint8_t {
    kComplete,    // `reply` holds it; release() it
    kFirstCopy,   // the other one is awaited
    kOtherEnd,    // one that was not waited for (Copies::from)
    kUnexpected,  // of nobody here: foreign, too late, or for the second time
    kMalformed,
  };
  // `port`: 0 or 1. The bytes of a complete reply are `frame` itself, or, where several copies came, Frame::merged.
  struct Arrival {
    Verdict verdict = Verdict::kMalformed;
    Frame* frame = nullptr;
    Bytes reply;
  };
  Arrival received(std::size_t port, Bytes frame) noexcept;
  // One that has been under way for too long: release() it. If a copy of it did arrive, that is in its merged bytes.
  Frame* overdue(const Timeouts& timeouts, Time now) noexcept;
  void release(Frame& frame) noexcept;
  // No more copies than one are to be waited for: a port has no carrier any more.
  void await_one_copy() noexcept;

  // When the next frame is overdue; empty when nothing is in flight.
  std::optional<Time> next_overdue(const Timeouts& timeouts) const noexcept;

 private:
  Frame* of_index(std::uint8_t index) noexcept;
  bool matches(const Frame& frame, Bytes bytes) const noexcept;
  static void merge(Frame& into, Bytes copy) noexcept;

  MacAddress source_;
  std::vector<Frame> frames_;
  std::array<std::uint8_t, 256> slot_of_index_;  // kNone, or in frames_
  std::array<std::byte, kLongestFrame> buffer_{};
  std::optional<FrameWriter> writer_;
  Frame* open_ = nullptr;
  std::uint8_t next_index_ = 0;
  std::size_t used_ = 0;
};

}  // namespace meca::ethercat
