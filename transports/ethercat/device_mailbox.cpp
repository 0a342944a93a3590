// Mails in and out: one request at a time, counters, repetition, error replies, emergencies (ETG.1000.4, 6.7;
// ETG.1000.6, 5.6).
#include <algorithm>
#include <utility>

#include "transports/ethercat/device_state.hpp"

namespace meca::ethercat {
namespace {

// The address stays 0, as in the mails of every device that was captured.
void prepare(DeviceState& s, MailboxType type, Bytes payload, Time ready) noexcept {
  MailboxState& box = s.mailbox;
  box.counter = next_mailbox_counter(box.counter);
  box.before = box.reply;
  wire::Writer out(box.reply.bytes);
  write(out, MailboxHeader{.length = static_cast<std::uint16_t>(payload.size()),
                           .type = static_cast<std::uint8_t>(type),
                           .counter = box.counter});
  out.bytes(payload);
  box.reply.size = out.size();
  box.waiting = true;
  box.ready = ready;
}

void prepare_error(DeviceState& s, MailboxError error, Time ready) noexcept {
  std::array<std::byte, 4> payload{};
  wire::Writer out(payload);
  out.u16(1);
  out.u16(static_cast<std::uint16_t>(error));
  prepare(s, MailboxType::kError, payload, ready);
}

void prepare_emergency(DeviceState& s, Time now) noexcept {
  MailboxState& box = s.mailbox;
  std::array<std::byte, 10> payload{};
  wire::Writer out(payload);
  write(out, CoeHeader{.service = static_cast<std::uint8_t>(CoeService::kEmergency)});
  write(out, box.emergencies.front());
  std::shift_left(box.emergencies.begin(), box.emergencies.end(), 1);
  --box.emergency_count;
  prepare(s, MailboxType::kCoe, payload, now);
}

void answer(DeviceState& s, Bytes memory, Time now) noexcept {
  const Time ready = now + s.settings.mailbox_reply;
  const auto mail = parse_mail(memory);
  if (!mail) return prepare_error(s, MailboxError::kInvalidSize, ready);
  const std::uint8_t counter = mail->header.counter;
  if (counter != 0 && counter == s.mailbox.last_request) {  // sent again by one who missed our working counter
    ++s.counters.duplicate_mails;
    return;
  }
  s.mailbox.last_request = counter;
  ++s.counters.mails;
  if (s.faults.no_mailbox) return;
  if (mail->header.type != static_cast<std::uint8_t>(MailboxType::kCoe)) {
    return prepare_error(s, MailboxError::kUnsupportedProtocol, ready);
  }
  std::array<std::byte, CoeServer::kMostPayload> payload;
  wire::Writer out(payload);
  const auto error = s.coe.request(s.objects, mail->payload, state_of(s), out);
  s.counters.aborts = s.coe.aborts();
  if (error) return prepare_error(s, *error, ready);
  if (out.size() > 0) prepare(s, MailboxType::kCoe, out.written(), ready);
}

// What comes without being asked for: the rest of a list, emergencies.
void prepare_next(DeviceState& s, Time now) noexcept {
  std::array<std::byte, CoeServer::kMostPayload> payload;
  wire::Writer out(payload);
  s.coe.next_fragment(s.objects, out);
  if (out.size() > 0) return prepare(s, MailboxType::kCoe, out.written(), now);
  if (s.mailbox.emergency_count > 0) prepare_emergency(s, now);
}

bool is_full(const Esc& esc, unsigned sync_manager) noexcept {
  constexpr std::uint16_t kStatus = 5;
  constexpr std::uint8_t kFull = 0x08;
  return (esc.peek(reg::sync_manager(sync_manager) + kStatus) & kFull) != 0;
}

// A master that has not read the last answer and writes the next mail has lost its place.
void judge(DeviceState& s) noexcept {
  const bool written = is_full(s.esc, 0);
  if (written && !s.mailbox.blamed) ++s.counters.strict;
  s.mailbox.blamed = written;
}

// The last mail that was read once more. One that was not read meanwhile stays where it is, and the repetition follows.
void repeat(DeviceState& s) noexcept {
  MailboxState& box = s.mailbox;
  box.again = box.before.size > 0 && (box.waiting || is_full(s.esc, 1));
  if (!box.again && box.reply.size > 0) s.esc.post_mail(box.reply.view());
  s.esc.acknowledge_repeat();
}

}  // namespace

void reset_mailbox(DeviceState& s) noexcept {
  s.mailbox = {};
  s.coe.reset();
}

void queue_emergency(DeviceState& s, const Emergency& emergency) noexcept {
  MailboxState& box = s.mailbox;
  if (box.emergency_count == box.emergencies.size()) return;  // the oldest say what began it
  box.emergencies[box.emergency_count++] = emergency;
}

void serve_mailbox(DeviceState& s, Time now) noexcept {
  if (state_of(s) == AlState::kInit) return;
  MailboxState& box = s.mailbox;
  if (s.esc.take_repeat_request()) repeat(s);
  if (is_full(s.esc, 1)) return judge(s);
  box.blamed = false;
  if (std::exchange(box.again, false) && s.esc.post_mail(box.before.view())) return;
  if (!box.waiting) prepare_next(s, now);
  if (!box.waiting) {
    if (const auto memory = s.esc.take_mail()) answer(s, *memory, now);
  }
  if (box.waiting && now >= box.ready && s.esc.post_mail(box.reply.view())) {
    box.waiting = false;
  }
}

}  // namespace meca::ethercat
