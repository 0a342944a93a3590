#include "transports/ethercat/sdo_client.hpp"

#include <algorithm>

#include "transports/ethercat/al_status.hpp"

namespace meca::ethercat {

using Kind = SdoMessage::Kind;

void SdoClient::upload(SdoAddress address, bool complete_access, Time now) noexcept {
  request_ = Kind::kUploadRequest;
  complete_access_ = complete_access;
  begin_transfer(address, now);
}

void SdoClient::download(SdoAddress address, Bytes data, Time now) noexcept {
  request_ = Kind::kDownloadRequest;
  complete_access_ = false;
  if (data.size() > kMostValue) {
    begin();
    address_ = address;
    abort_.reset();
    return fail(Predicate::format("is to have %zu bytes written to object 0x%04X:%02X, at most %zu can be", data.size(),
                                  unsigned{address.index}, unsigned{address.sub}, kMostValue));
  }
  size_ = data.size();
  std::ranges::copy(data, value_.begin());
  begin_transfer(address, now);
}

void SdoClient::begin_transfer(SdoAddress address, Time now) noexcept {
  begin();
  address_ = address;
  again_ = giving_up_ = false;
  abort_.reset();
  send_first(now);
}

void SdoClient::send_first(Time now) noexcept {
  request_ = reads() ? Kind::kUploadRequest : Kind::kDownloadRequest;
  at_ = 0;
  if (reads()) size_ = 0;
  send(now);
}

void SdoClient::send(Time now) noexcept {
  SdoMessage message;
  message.kind = request_;
  message.address = address_;
  message.complete_access = complete_access_;
  message.toggle = toggle_;
  if (!reads()) {
    const std::size_t part = std::min(size_ - at_, in_segments() ? kMostSegment : kMostFirstPart);
    message.data = Bytes(value_).subspan(at_, part);
    message.size = static_cast<std::uint32_t>(size_);
    message.expedited = size_ <= 4;
    at_ += part;
    message.last = at_ == size_;
  }
  std::array<std::byte, MailboxClient::kMost> bytes;
  wire::Writer out(bytes);
  write(out, message);
  mailbox_.request(out.written(), now);
}

void SdoClient::go_on(Kind segments, Time now) noexcept {
  request_ = segments;
  toggle_ = false;
  send(now);
}

void SdoClient::tick(Time now) noexcept {
  if (!running()) return;
  mailbox_.tick(now);
  if (mailbox_.outcome() != Outcome::kFailed) return;
  if (giving_up_) return fail(why_);
  // Nothing that is read or written here suffers from being asked twice.
  if (mailbox_.reply_lost() && !again_) {
    again_ = true;
    return send_first(now);
  }
  fail(mailbox_.trouble());
}

void SdoClient::answered(std::uint16_t working_counter, Bytes data, Time now) noexcept {
  if (!running()) return;
  mailbox_.answered(working_counter, data, now);
  if (mailbox_.outcome() == Outcome::kDone) {
    if (giving_up_) return fail(why_);
    mail_arrived(now);
  }
  tick(now);
}

void SdoClient::lost(Time now) noexcept {
  if (running()) mailbox_.lost(now);
}

void SdoClient::mail_arrived(Time now) noexcept {
  const auto reply = parse_sdo(mailbox_.service(), mailbox_.sdo());
  if (!reply || !take(*reply, now)) mailbox_.wait_for_another(now);
}

// False: it does not answer what was asked; an earlier question perhaps.
bool SdoClient::take(const SdoMessage& reply, Time now) noexcept {
  const bool ours = reply.address == address_;
  switch (reply.kind) {
    case Kind::kAbort:  // of a segment: some devices do not name the object
      if (!ours && !(in_segments() && reply.address == SdoAddress{})) return false;
      aborted(reply.abort);
      return true;
    case Kind::kUploadResponse:
      if (request_ != Kind::kUploadRequest || !ours) return false;
      value_begins(reply, now);
      return true;
    case Kind::kUploadSegmentResponse:
      if (request_ != Kind::kUploadSegmentRequest || reply.toggle != toggle_) return false;
      segment(reply, now);
      return true;
    case Kind::kDownloadResponse:
      if (request_ != Kind::kDownloadRequest || !ours) return false;
      at_ == size_ ? done() : go_on(Kind::kDownloadSegmentRequest, now);
      return true;
    case Kind::kDownloadSegmentResponse:
      if (request_ != Kind::kDownloadSegmentRequest) return false;
      segment_taken(reply, now);
      return true;
    case Kind::kUploadRequest:
    case Kind::kDownloadRequest:
    case Kind::kUploadSegmentRequest:
    case Kind::kDownloadSegmentRequest:
    case Kind::kUnknown:
      return false;
  }
  return false;
}

void SdoClient::value_begins(const SdoMessage& reply, Time now) noexcept {
  size_ = reply.size;
  if (size_ > kMostValue) {
    return give_up(
        SdoAbort::kMemory,
        Predicate::format("has %zu bytes in object 0x%04X:%02X, at most %zu are expected; check its firmware", size_,
                          unsigned{address_.index}, unsigned{address_.sub}, kMostValue),
        now);
  }
  append(reply.data);
  at_ >= size_ ? done() : go_on(Kind::kUploadSegmentRequest, now);
}

void SdoClient::segment(const SdoMessage& reply, Time now) noexcept {
  if (!append(reply.data) || reply.last != (at_ == size_)) {
    return give_up(
        SdoAbort::kLength,
        Predicate::format("sends object 0x%04X:%02X in another size than the %zu bytes it announced; restart it",
                          unsigned{address_.index}, unsigned{address_.sub}, size_),
        now);
  }
  if (reply.last) return done();
  toggle_ = !toggle_;
  send(now);
}

// No answer to an earlier segment can still come: each was there before the next segment was sent.
void SdoClient::segment_taken(const SdoMessage& reply, Time now) noexcept {
  if (reply.toggle != toggle_) {
    return give_up(
        SdoAbort::kToggle,
        Predicate::format("answers a segment of object 0x%04X:%02X that was not sent (toggle bit); restart it",
                          unsigned{address_.index}, unsigned{address_.sub}),
        now);
  }
  if (at_ == size_) return done();
  toggle_ = !toggle_;
  send(now);
}

bool SdoClient::append(Bytes data) noexcept {
  if (data.size() > size_ - at_) return false;
  std::ranges::copy(data, value_.begin() + static_cast<std::ptrdiff_t>(at_));
  at_ += data.size();
  return true;
}

// ETG.1000.6, 5.6.2.7: who aborts tells the other end, which does not answer.
void SdoClient::give_up(SdoAbort code, const Predicate& why, Time now) noexcept {
  giving_up_ = true;
  why_ = why;
  std::array<std::byte, MailboxClient::kMost> bytes;
  wire::Writer out(bytes);
  write(out, {.kind = Kind::kAbort, .address = address_, .abort = static_cast<std::uint32_t>(code)});
  mailbox_.notify(out.written(), now);
}

void SdoClient::aborted(std::uint32_t code) noexcept {
  ++counters_.sdo_aborts;
  abort_ = code;
  const std::string_view text = abort_text(code);
  fail(Predicate::format("refuses to have object 0x%04X:%02X %s%s: abort 0x%08X, %.*s", unsigned{address_.index},
                         unsigned{address_.sub}, reads() ? "read" : "written", complete_access_ ? " as a whole" : "",
                         static_cast<unsigned>(code), static_cast<int>(text.size()), text.data()));
}

}  // namespace meca::ethercat
