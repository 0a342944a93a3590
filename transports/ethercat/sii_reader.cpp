#include "transports/ethercat/sii_reader.hpp"

#include <algorithm>

#include "transports/ethercat/access_machine.hpp"

namespace meca::ethercat {
namespace {

// Register 0502 (ETG.1000.4, 6.4; spec 5.4).
constexpr std::uint16_t kReadCommand = 0x0100, kEightBytes = 0x0040, kCommandError = 0x2000, kBusy = 0x8000;
// So many answers in a row that nobody counted: nobody has the address any more, a device that was switched off.
constexpr unsigned kMostUncounted = 20;

}  // namespace

void SiiReader::start(Time now) noexcept {
  identity_ = {};
  trouble_ = {};
  refused_ = heard_ = busy_ = false;
  uncounted_ = 0;
  at_ = 0;
  deadline_ = now + timeout_;
  go(Step::kForce, now);
}

void SiiReader::tick(Time now) noexcept {
  const bool gone = uncounted_ > kMostUncounted;
  if (step_ == Step::kIdle || done() || failed() || (now < deadline_ && !gone)) return;
  step_ = Step::kFailed;
  trouble_ = !heard_ || gone ? "it does not answer when its SII is read; check its power and the cables to it"
             : refused_      ? "its SII refuses to be read; restart it"
             : busy_         ? "its SII stays busy; restart it"
                             : "its SII does not give what is asked for; restart it";
}

std::optional<Access> SiiReader::next(Time now) noexcept {
  if (now < due_) return std::nullopt;
  const auto write = [this](std::uint16_t address, std::uint16_t size, std::uint16_t value) {
    out_ = {static_cast<std::byte>(value & 0xFF), static_cast<std::byte>(value >> 8), static_cast<std::byte>(at_)};
    return Access{address, size, true, Bytes(out_).first(size)};
  };
  switch (step_) {
    case Step::kIdle:
    case Step::kDone:
    case Step::kFailed:
      return std::nullopt;
    case Step::kForce:
      return write(reg::kSiiOwner, 1, 2);
    case Step::kOwn:
      return write(reg::kSiiOwner, 1, 0);
    case Step::kWait:
    case Step::kPoll:
      return Access{reg::kSiiControl, kStatusSize, false, {}};
    case Step::kAsk:
      return write(reg::kSiiControl, 6, kReadCommand);
    case Step::kClear:
      return write(reg::kSiiControl, 2, 0);
    case Step::kReturn:
      return write(reg::kSiiOwner, 1, 1);
  }
  return std::nullopt;
}

void SiiReader::answered(std::uint16_t working_counter, Bytes data, Time now) noexcept {
  if (working_counter == 0) {
    ++uncounted_;
    return;
  }
  heard_ = true;
  uncounted_ = 0;
  switch (step_) {
    case Step::kIdle:
    case Step::kDone:
    case Step::kFailed:
      return;
    case Step::kForce:
      return go(Step::kOwn, now);
    case Step::kOwn:
      return go(Step::kWait, now);
    case Step::kWait:
    case Step::kPoll:
      if (data.size() >= kStatusSize) status_read(data, now);
      return;
    case Step::kAsk:
      return go(Step::kPoll, now);
    case Step::kClear:
      return go(Step::kAsk, now);
    case Step::kReturn:
      return go(Step::kDone, now);
  }
}

void SiiReader::lost(Time) noexcept {}  // everything here may be said twice

void SiiReader::status_read(Bytes data, Time now) noexcept {
  const std::uint16_t status = u16_at(data, 0);
  busy_ = (status & kBusy) != 0;
  if (busy_) return go(step_, now + kPollPeriod);
  refused_ = (status & kCommandError) != 0;
  if (refused_) return go(Step::kClear, now + kPollPeriod);
  // Another address: the command was not taken, the SII may have been busy.
  const bool ours = u16_at(data, 2) == at_ && u16_at(data, 4) == 0;
  if (step_ == Step::kWait || !ours) return go(Step::kAsk, now);
  take(data.subspan(6, (status & kEightBytes) != 0 ? 8 : 4), now);
}

void SiiReader::take(Bytes words, Time now) noexcept {
  const std::size_t byte = 2U * at_, size = std::min(words.size(), words_.size() - byte);
  std::ranges::copy(words.first(size), words_.begin() + static_cast<std::ptrdiff_t>(byte));
  at_ = static_cast<std::uint16_t>(at_ + size / 2);
  deadline_ = now + timeout_;
  if (at_ < SiiIdentity::kWords) return go(Step::kAsk, now);
  if (const auto identity = parse_sii_identity(words_)) identity_ = *identity;
  go(Step::kReturn, now);
}

}  // namespace meca::ethercat
