#include "transports/ethercat/in_flight.hpp"

#include <algorithm>

namespace meca::ethercat {
namespace {

constexpr std::uint8_t kNone = 0xFF;

bool logical(Command command) noexcept {
  return command == Command::kLrd || command == Command::kLwr || command == Command::kLrw;
}
// F commands and logical ones come back with the address they were sent with.
bool keeps_address(Command command) noexcept {
  return logical(command) || command == Command::kFprd || command == Command::kFpwr || command == Command::kFprw ||
         command == Command::kFrmw;
}

}  // namespace

InFlight::InFlight(const MacAddress& source) : source_(source), frames_(kMostFrames) { slot_of_index_.fill(kNone); }

bool InFlight::begin(Use use, std::uint64_t cycle) noexcept {
  open_ = nullptr;
  const auto free = std::ranges::find(frames_, false, &Frame::in_flight);
  if (free == frames_.end()) return false;
  while (slot_of_index_[next_index_] != kNone) ++next_index_;  // fewer frames than indices: there is one
  open_ = &*free;
  open_->use = use;
  open_->cycle = cycle;
  open_->index = next_index_;
  open_->count = open_->arrived = 0;
  open_->size = 0;
  open_->seen = {};
  writer_.emplace(buffer_, source_);
  return true;
}

std::size_t InFlight::room() const noexcept {
  return open_ == nullptr || open_->count == kMostDatagrams ? 0 : writer_->room();
}

bool InFlight::add(const Request& request) noexcept {
  if (request.size > room()) return false;
  const auto data = writer_->add(request.command, open_->index, request.address, request.size);
  if (data.empty()) return false;
  std::ranges::copy(request.data.first(std::min<std::size_t>(request.data.size(), request.size)), data.begin());
  open_->datagrams[open_->count++] = {request.command, request.address, request.size, request.purpose};
  return true;
}

Bytes InFlight::finish(const Copies& copies, Time now) noexcept {
  if (open_ == nullptr || open_->count == 0) return {};
  Frame& frame = *open_;
  open_ = nullptr;
  frame.in_flight = true;
  frame.awaited = copies.count;
  frame.from = copies.from;
  frame.sent = now;
  slot_of_index_[frame.index] = static_cast<std::uint8_t>(&frame - frames_.data());
  ++next_index_;  // an index rests as long as possible
  ++used_;
  return writer_->finish();
}

InFlight::Frame* InFlight::of_index(std::uint8_t index) noexcept {
  const std::uint8_t slot = slot_of_index_[index];
  return slot == kNone ? nullptr : &frames_[slot];
}

bool InFlight::matches(const Frame& frame, Bytes bytes) const noexcept {
  DatagramWalk<const std::byte> walk(bytes);
  for (std::size_t i = 0; i < frame.count; ++i) {
    const Frame::Expected& expected = frame.datagrams[i];
    const auto datagram = walk.next();
    if (!datagram || datagram->index() != frame.index || datagram->command() != expected.command ||
        datagram->data().size() != expected.size)
      return false;
    const bool same = keeps_address(expected.command) ? datagram->address() == expected.address
                                                      : datagram->ado() == expected.address >> 16;
    if (!same) return false;
  }
  return !walk.next();
}

void InFlight::merge(Frame& into, Bytes copy) noexcept {
  DatagramWalk<std::byte> mine(std::span(into.merged).first(into.size));
  DatagramWalk<const std::byte> other(copy);
  for (std::size_t i = 0; i < into.count; ++i) {
    auto a = mine.next();
    const auto b = other.next();
    if (!a || !b) return;  // both match what was sent
    const auto to = a->data();
    const auto from = b->data();
    for (std::size_t k = 0; k < to.size(); ++k) to[k] |= from[k];
    a->set_working_counter(static_cast<std::uint16_t>(a->working_counter() + b->working_counter()));
  }
}

InFlight::Arrival InFlight::received(std::size_t port, Bytes bytes) noexcept {
  DatagramWalk<const std::byte> walk(bytes);
  const auto first = walk.next();
  if (!first) return {Verdict::kMalformed, nullptr, {}};
  while (walk.next()) {
  }
  if (!walk.ok() || bytes.size() > kLongestFrame) return {Verdict::kMalformed, nullptr, {}};
  Frame* frame = of_index(first->index());
  if (frame == nullptr || frame->seen[port] || !matches(*frame, bytes)) return {Verdict::kUnexpected, frame, {}};
  frame->seen[port] = true;
  if (frame->from && *frame->from != port) return {Verdict::kOtherEnd, frame, {}};
  if (++frame->arrived == 1) {
    if (frame->awaited <= 1) return {Verdict::kComplete, frame, bytes};
    frame->size = bytes.size();
    std::ranges::copy(bytes, frame->merged.begin());
    return {Verdict::kFirstCopy, frame, bytes};
  }
  merge(*frame, bytes);
  return {Verdict::kComplete, frame, Bytes(frame->merged).first(frame->size)};
}

InFlight::Frame* InFlight::overdue(const Timeouts& timeouts, Time now) noexcept {
  if (used_ == 0) return nullptr;
  for (Frame& frame : frames_)
    if (frame.in_flight && now - frame.sent >= timeouts.of(frame.use)) return &frame;
  return nullptr;
}

void InFlight::release(Frame& frame) noexcept {
  frame.in_flight = false;
  slot_of_index_[frame.index] = kNone;
  --used_;
}

void InFlight::await_one_copy() noexcept {
  for (Frame& frame : frames_) {
    frame.awaited = 1;
    frame.from.reset();
  }
}

std::optional<Time> InFlight::next_overdue(const Timeouts& timeouts) const noexcept {
  if (used_ == 0) return std::nullopt;
  std::optional<Time> out;
  for (const Frame& frame : frames_) {
    if (!frame.in_flight) continue;
    const Time end = frame.sent + timeouts.of(frame.use);
    if (!out || end < *out) out = end;
  }
  return out;
}

}  // namespace meca::ethercat
