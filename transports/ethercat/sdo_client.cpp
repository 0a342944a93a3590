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
  sent_size_ = std::min(data.size(), kMostDownload);
  std::copy_n(data.begin(), sent_size_, sent_.begin());
  begin_transfer(address, now);
}

void SdoClient::begin_transfer(SdoAddress address, Time now) noexcept {
  begin();
  address_ = address;
  received_ = size_ = 0;
  again_ = false;
  abort_.reset();
  send(now);
}

void SdoClient::send(Time now) noexcept {
  SdoMessage message;
  message.kind = request_;
  message.address = address_;
  message.complete_access = complete_access_;
  message.toggle = toggle_;
  if (request_ == Kind::kDownloadRequest) {
    message.data = Bytes(sent_).first(sent_size_);
    message.size = static_cast<std::uint32_t>(sent_size_);
    message.expedited = sent_size_ <= 4;
  }
  std::array<std::byte, MailboxClient::kMost> bytes;
  wire::Writer out(bytes);
  write(out, message);
  mailbox_.request(out.written(), now);
}

void SdoClient::tick(Time now) noexcept {
  if (!running()) return;
  mailbox_.tick(now);
  if (mailbox_.outcome() != Outcome::kFailed) return;
  // Nothing that is read or written here suffers from being asked twice.
  if (mailbox_.reply_lost() && !again_) {
    if (request_ == Kind::kUploadSegmentRequest) request_ = Kind::kUploadRequest;
    received_ = 0;
    again_ = true;
    return send(now);
  }
  fail(mailbox_.trouble());
}

void SdoClient::answered(std::uint16_t working_counter, Bytes data, Time now) noexcept {
  if (!running()) return;
  mailbox_.answered(working_counter, data, now);
  if (mailbox_.outcome() == Outcome::kDone) mail_arrived(now);
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
      if (!ours && !(request_ == Kind::kUploadSegmentRequest && reply.address == SdoAddress{})) return false;
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
      done();
      return true;
    case Kind::kUploadRequest:
    case Kind::kDownloadRequest:
    case Kind::kUploadSegmentRequest:
    case Kind::kDownloadSegmentRequest:
    case Kind::kDownloadSegmentResponse:
    case Kind::kUnknown:
      return false;
  }
  return false;
}

void SdoClient::value_begins(const SdoMessage& reply, Time now) noexcept {
  size_ = reply.size;
  if (size_ > kMostUpload) {
    return fail(Predicate::format("has %zu bytes in object 0x%04X:%02X, at most %zu are expected; check its firmware",
                                  size_, unsigned{address_.index}, unsigned{address_.sub}, kMostUpload));
  }
  append(reply.data);
  if (received_ >= size_) return done();
  request_ = Kind::kUploadSegmentRequest;
  toggle_ = false;
  send(now);
}

void SdoClient::segment(const SdoMessage& reply, Time now) noexcept {
  if (!append(reply.data) || (reply.last && received_ != size_) || (!reply.last && received_ >= size_)) {
    return fail(
        Predicate::format("sends object 0x%04X:%02X in another size than the %zu bytes it announced; restart it",
                          unsigned{address_.index}, unsigned{address_.sub}, size_));
  }
  if (reply.last) return done();
  toggle_ = !toggle_;
  send(now);
}

bool SdoClient::append(Bytes data) noexcept {
  if (data.size() > size_ - received_) return false;
  std::ranges::copy(data, value_.begin() + static_cast<std::ptrdiff_t>(received_));
  received_ += data.size();
  return true;
}

void SdoClient::aborted(std::uint32_t code) noexcept {
  ++counters_.sdo_aborts;
  abort_ = code;
  const std::string_view text = abort_text(code);
  const bool writing = request_ == Kind::kDownloadRequest;
  fail(Predicate::format("refuses to have object 0x%04X:%02X %s%s: abort 0x%08X, %.*s", unsigned{address_.index},
                         unsigned{address_.sub}, writing ? "written" : "read", complete_access_ ? " as a whole" : "",
                         static_cast<unsigned>(code), static_cast<int>(text.size()), text.data()));
}

}  // namespace meca::ethercat
