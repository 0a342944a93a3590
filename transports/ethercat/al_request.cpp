#include "transports/ethercat/al_request.hpp"

#include "transports/ethercat/al_status.hpp"

namespace meca::ethercat {
namespace {

constexpr std::uint16_t kStatusSize = 6;  // 0130 to 0135: status, -, code

constexpr std::uint16_t state_before(AlState target) noexcept {
  return static_cast<std::uint16_t>(target == AlState::kPreop ? AlState::kInit
                                    : target == AlState::kOp  ? AlState::kSafeop
                                                              : AlState::kPreop);
}
int length(std::string_view s) noexcept { return static_cast<int>(s.size()); }

}  // namespace

void AlRequest::start(AlState target, Time timeout, Time now) noexcept {
  begin();
  target_ = target;
  step_ = target == AlState::kInit ? Step::kRequest : Step::kLook;
  acknowledged_ = heard_ = false;
  timeout_ = timeout;
  due_ = now;
  deadline_ = now + timeout;
}

void AlRequest::tick(Time now) noexcept {
  if (running() && now >= deadline_) fail(why_not());
}

Predicate AlRequest::why_not() const noexcept {
  const std::string_view target = al_state_name(static_cast<std::uint16_t>(target_)), state = al_state_name(status_);
  if (!heard_) return {"does not answer; check its power and the cables to it"};
  if ((status_ & kAlError) != 0) {
    const std::string_view text = al_code_text(code_);
    return Predicate::format(
        "stays in %.*s with an error that cannot be acknowledged: AL status code 0x%04X, %.*s; "
        "restart it",
        length(state), state.data(), unsigned{code_}, length(text), text.data());
  }
  return Predicate::format("stays in %.*s, %.*s was not reached within %lld ms; restart it if it stays so",
                           length(state), state.data(), length(target), target.data(),
                           static_cast<long long>(timeout_ / std::chrono::milliseconds(1)));
}

std::optional<Access> AlRequest::next(Time now) noexcept {
  if (!running() || now < due_) return std::nullopt;
  due_ = deadline_;
  std::uint16_t value = 0;
  switch (step_) {
    case Step::kLook:
    case Step::kPoll:
      return Access{reg::kAlStatus, kStatusSize, false, {}};
    case Step::kAcknowledge:
      value = static_cast<std::uint16_t>((status_ & kAlStateMask) | kAlAcknowledge);
      break;
    case Step::kRequest:
      value = static_cast<std::uint16_t>(target_);
      if (target_ == AlState::kInit) value |= kAlAcknowledge;
      break;
  }
  control_ = {static_cast<std::byte>(value & 0xFF), static_cast<std::byte>(value >> 8)};
  return Access{reg::kAlControl, 2, true, control_};
}

void AlRequest::answered(std::uint16_t working_counter, Bytes data, Time now) noexcept {
  const bool reading = step_ == Step::kLook || step_ == Step::kPoll;
  if (working_counter == 0 || (reading && data.size() < kStatusSize)) return lost(now);
  due_ = now;
  heard_ = true;
  if (!reading) {
    step_ = step_ == Step::kAcknowledge ? Step::kLook : Step::kPoll;
    return;
  }
  status_ = u16_at(data, 0);
  code_ = u16_at(data, 4);
  step_ == Step::kLook ? look(now) : poll(now);
}

void AlRequest::look(Time now) noexcept {
  const std::uint16_t state = status_ & kAlStateMask;
  if ((status_ & kAlError) != 0) {
    if (acknowledged_) {
      due_ = now + kPollPeriod;
    } else {
      acknowledged_ = true;
      step_ = Step::kAcknowledge;
    }
    return;
  }
  if (state == static_cast<std::uint16_t>(AlState::kBoot) || state < state_before(target_)) {
    const std::string_view name = al_state_name(status_), target = al_state_name(static_cast<std::uint16_t>(target_));
    return fail(Predicate::format("went to %.*s on its way to %.*s: it was restarted, or another master is at work",
                                  length(name), name.data(), length(target), target.data()));
  }
  if (state >= static_cast<std::uint16_t>(target_)) return done();
  step_ = Step::kRequest;
}

void AlRequest::poll(Time now) noexcept {
  const std::uint16_t state = status_ & kAlStateMask;
  const bool error = (status_ & kAlError) != 0;
  // An error is an answer to the request, for none stood before; INIT was asked for with an error that may still stand.
  if (error && target_ != AlState::kInit) {
    const std::string_view target = al_state_name(static_cast<std::uint16_t>(target_)), text = al_code_text(code_);
    return fail(Predicate::format("refuses %.*s: AL status code 0x%04X, %.*s", length(target), target.data(),
                                  unsigned{code_}, length(text), text.data()));
  }
  const auto wanted = static_cast<std::uint16_t>(target_);
  if (!error && (target_ == AlState::kInit ? state == wanted : state >= wanted)) return done();
  due_ = now + kPollPeriod;
}

void AlRequest::lost(Time now) noexcept {
  due_ = now;
  ++counters_.lost_accesses;
}

}  // namespace meca::ethercat
