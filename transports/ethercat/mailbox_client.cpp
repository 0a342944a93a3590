#include "transports/ethercat/mailbox_client.hpp"

#include <algorithm>
#include <utility>

namespace meca::ethercat {
namespace {

constexpr std::uint16_t kSm1 = reg::sync_manager(1);
constexpr std::uint16_t kSm1Status = kSm1 + 5, kSm1Activate = kSm1 + 6;  // +7: PDI control
constexpr std::uint8_t kFull = 0x08, kEnable = 0x01, kRepeatBit = 0x02;

long long milliseconds(Time t) noexcept { return static_cast<long long>(t / std::chrono::milliseconds(1)); }

const char* error_text(std::uint16_t error) noexcept {
  switch (static_cast<MailboxError>(error)) {
    case MailboxError::kSyntax:
      return "syntax of the header";
    case MailboxError::kUnsupportedProtocol:
      return "protocol not supported";
    case MailboxError::kInvalidChannel:
      return "invalid channel";
    case MailboxError::kServiceNotSupported:
      return "service not supported";
    case MailboxError::kInvalidHeader:
      return "invalid header";
    case MailboxError::kSizeTooShort:
      return "too short";
    case MailboxError::kNoMoreMemory:
      return "no memory left";
    case MailboxError::kInvalidSize:
      return "invalid size";
  }
  return "not known";
}

}  // namespace

void MailboxClient::drain(Time now) noexcept {
  begin();
  draining_ = written_ = true;
  heard_ = maybe_taken_ = reply_lost_ = false;
  deadline_ = now + timeouts_.response;
  go(Step::kStatus, now);
}

void MailboxClient::request(Bytes sdo, Time now) noexcept {
  answered_ = true;
  begin_mail(sdo, now);
}

void MailboxClient::notify(Bytes sdo, Time now) noexcept {
  answered_ = false;
  begin_mail(sdo, now);
}

void MailboxClient::begin_mail(Bytes sdo, Time now) noexcept {
  begin();
  draining_ = heard_ = written_ = maybe_written_ = maybe_taken_ = reply_lost_ = false;
  counter_ = next_mailbox_counter(counter_);
  out_ = {};
  wire::Writer out(out_);
  MailboxHeader header;
  header.length = static_cast<std::uint16_t>(kCoeHeader + sdo.size());
  header.type = static_cast<std::uint8_t>(MailboxType::kCoe);
  header.counter = counter_;
  write(out, header);
  write(out, CoeHeader{0, static_cast<std::uint8_t>(CoeService::kSdoRequest)});
  out.bytes(sdo);
  deadline_ = now + timeouts_.request;
  go(Step::kWrite, now);
}

void MailboxClient::wait_for_another(Time now) noexcept {
  begin();
  go(Step::kStatus, now);
}

void MailboxClient::tick(Time now) noexcept {
  if (!running() || now < deadline_) return;
  if (!heard_) return fail(Predicate("does not answer; check its power and the cables to it"));
  if (draining_) return fail(Predicate("has ever more mails in its mailbox; restart it"));
  fail(!written_
           ? Predicate::format("does not take a mail out of its mailbox within %lld ms; restart it",
                               milliseconds(timeouts_.request))
           : Predicate::format("does not answer an SDO within %lld ms; restart it", milliseconds(timeouts_.response)));
}

std::optional<Access> MailboxClient::next(Time now) noexcept {
  if (!running() || now < due_) return std::nullopt;
  due_ = deadline_;
  switch (step_) {
    case Step::kWrite:
      return Access{kSyncManagers[0].start, kMailboxSize, true, out_};
    case Step::kStatus:
      return Access{kSm1Status, 1, false, {}};
    case Step::kRead:
      return Access{kSyncManagers[1].start, kMailboxSize, false, {}};
    case Step::kFindRepeat:
    case Step::kRepeated:
      return Access{kSm1Activate, 2, false, {}};
    case Step::kRepeat:
      return Access{kSm1Activate, 1, true, activate_};
  }
  return std::nullopt;
}

void MailboxClient::answered(std::uint16_t working_counter, Bytes data, Time now) noexcept {
  if (step_ == Step::kWrite) return wrote(working_counter, now);
  constexpr std::size_t kSizes[] = {0, 1, kMailboxSize, 2, 0, 2};
  if (working_counter == 0 || data.size() < kSizes[static_cast<std::size_t>(step_)]) return lost(now);
  heard_ = true;
  switch (step_) {
    case Step::kWrite:
      return;
    case Step::kStatus:
      return status_read(u8_at(data, 0), now);
    case Step::kRead:
      maybe_taken_ = false;
      return mail_read(data, now);
    case Step::kFindRepeat:
    case Step::kRepeated:
      return repeat_read(u8_at(data, 0), u8_at(data, 1), now);
    case Step::kRepeat:
      repeat_deadline_ = now + timeouts_.request;
      return go(Step::kRepeated, now);
  }
}

// Nobody counts a write into a mailbox that is full. A device may leave it full until its last answer is read: that of
// a writing that was lost on its way back to us, perhaps.
void MailboxClient::wrote(std::uint16_t working_counter, Time now) noexcept {
  heard_ = true;
  written_ = working_counter != 0;
  if (written_) deadline_ = now + timeouts_.response;
  go(Step::kStatus, now);
  if (written_ && !answered_) done();
}

void MailboxClient::status_read(std::uint8_t status, Time now) noexcept {
  if ((status & kFull) != 0) return go(Step::kRead, now);
  if (draining_) return done();
  if (maybe_taken_) {
    ++counters_.mailbox_repeats;
    return go(Step::kFindRepeat, now);
  }
  go(written_ ? Step::kStatus : Step::kWrite, now + kPollPeriod);
}

// A repeat is requested by making the request bit differ from the acknowledge, and is there when they agree again.
void MailboxClient::repeat_read(std::uint8_t activate, std::uint8_t pdi, Time now) noexcept {
  if (step_ == Step::kFindRepeat) {
    activate_[0] = static_cast<std::byte>(kEnable | (~pdi & kRepeatBit));
    return go(Step::kRepeat, now);
  }
  if (((activate ^ pdi) & kRepeatBit) == 0) {
    maybe_taken_ = false;
    return go(Step::kStatus, now);
  }
  if (now < repeat_deadline_) return go(Step::kRepeated, now + kPollPeriod);
  reply_lost_ = true;
  fail(Predicate("does not repeat a mail that was lost on the way; check the cables"));
}

void MailboxClient::mail_read(Bytes memory, Time now) noexcept {
  std::ranges::copy(memory.first(kMailboxSize), in_.begin());
  go(Step::kStatus, now);
  const auto mail = parse_mail(in_);
  if (!mail) return;
  if (mail->header.type == static_cast<std::uint8_t>(MailboxType::kError) && !draining_) {
    const auto error = parse_mailbox_error(mail->payload);
    if (error) {
      fail(Predicate::format("refuses a mail: mailbox error 0x%04X, %s; restart it", unsigned{*error},
                             error_text(*error)));
    }
    return;
  }
  if (mail->header.type != static_cast<std::uint8_t>(MailboxType::kCoe)) return;
  if (coe_received(mail->payload) && !draining_ && answered_ && (written_ || maybe_written_)) done();
}

// True for a mail of the SDO services. Emergencies come whenever they want.
bool MailboxClient::coe_received(Bytes payload) noexcept {
  wire::Reader in(payload);
  const CoeHeader header = read_coe_header(in);
  if (!in.ok()) return false;
  service_ = static_cast<CoeService>(header.service);
  if (service_ == CoeService::kEmergency) {
    const auto emergency = parse_emergency(in.rest());
    if (!emergency) return false;
    ++counters_.emergencies;
    emergency_ = emergency;
    return false;
  }
  sdo_size_ = in.remaining();
  sdo_at_ = static_cast<std::size_t>(in.rest().data() - in_.data());
  return service_ == CoeService::kSdoRequest || service_ == CoeService::kSdoResponse;
}

void MailboxClient::lost(Time now) noexcept {
  ++counters_.lost_accesses;
  if (step_ == Step::kWrite && !std::exchange(maybe_written_, true)) deadline_ = now + timeouts_.response;
  if (step_ == Step::kRead) maybe_taken_ = true;
  go(step_ == Step::kRead ? Step::kStatus : step_, now);
}

}  // namespace meca::ethercat
