#include "transports/ethercat/coe_server.hpp"

#include <algorithm>

namespace meca::ethercat {
namespace {

using Kind = SdoMessage::Kind;
constexpr std::size_t kMostExpedited = 4;
constexpr std::size_t kMostFirstPart = CoeServer::kMostPayload - kCoeHeader - kSdoHeader;  // 112
constexpr std::size_t kMostSegment = CoeServer::kMostPayload - kCoeHeader - 1;             // 119

void write_sdo(wire::Writer& out, CoeService service, const SdoMessage& message) noexcept {
  write(out, CoeHeader{.service = static_cast<std::uint8_t>(service)});
  write(out, message);
}

}  // namespace

void CoeServer::reset() noexcept {
  transfer_ = Transfer::kNone;
  fragments_left_ = 0;
}

std::optional<MailboxError> CoeServer::request(ObjectDictionary& objects, Bytes payload, AlState state,
                                               wire::Writer& out) noexcept {
  wire::Reader in(payload);
  const CoeHeader header = read_coe_header(in);
  if (!in.ok()) return MailboxError::kSizeTooShort;
  fragments_left_ = 0;  // who asks anew does not wait for the rest
  if (header.service == static_cast<std::uint8_t>(CoeService::kSdoInformation)) {
    if (in.remaining() < 6) return MailboxError::kSizeTooShort;
    information(objects, in, out);
    return std::nullopt;
  }
  if (header.service != static_cast<std::uint8_t>(CoeService::kSdoRequest)) return MailboxError::kServiceNotSupported;
  const auto message = parse_sdo(CoeService::kSdoRequest, in.rest());
  if (!message) return MailboxError::kSizeTooShort;
  sdo(objects, *message, state, out);
  return std::nullopt;
}

void CoeServer::sdo(ObjectDictionary& objects, const SdoMessage& message, AlState state, wire::Writer& out) noexcept {
  switch (message.kind) {
    case Kind::kUploadRequest:
      return begin_upload(objects, message, state, out);
    case Kind::kUploadSegmentRequest:
      return continue_upload(message, out);
    case Kind::kDownloadRequest:
      return begin_download(objects, message, state, out);
    case Kind::kDownloadSegmentRequest:
      return continue_download(objects, message, state, out);
    case Kind::kAbort:  // is not answered
      transfer_ = Transfer::kNone;
      return;
    case Kind::kUploadResponse:
    case Kind::kDownloadResponse:
    case Kind::kUploadSegmentResponse:
    case Kind::kDownloadSegmentResponse:
    case Kind::kUnknown:
      break;
  }
  address_ = message.address;
  abort(SdoAbort::kCommand, out);
}

void CoeServer::abort(SdoAbort code, wire::Writer& out) noexcept {
  transfer_ = Transfer::kNone;
  ++aborts_;
  // As a request: so masters know it from other devices, and ETG.1000.6 names no other service for it.
  write_sdo(out, CoeService::kSdoRequest,
            {.kind = Kind::kAbort, .address = address_, .data = {}, .abort = static_cast<std::uint32_t>(code)});
}

// ---- Upload: device -> master

void CoeServer::begin_upload(const ObjectDictionary& objects, const SdoMessage& request, AlState state,
                             wire::Writer& out) noexcept {
  transfer_ = Transfer::kNone;
  address_ = request.address;
  if (const auto code = objects.upload(address_, request.complete_access, state, value_, size_)) {
    return abort(*code, out);
  }
  at_ = std::min(size_, kMostFirstPart);
  write_sdo(out, CoeService::kSdoResponse,
            {.kind = Kind::kUploadResponse,
             .address = address_,
             .complete_access = request.complete_access,
             .expedited = size_ <= kMostExpedited,
             .size = static_cast<std::uint32_t>(size_),
             .data = Bytes(value_).first(at_)});
  if (at_ == size_) return;
  transfer_ = Transfer::kUpload;
  toggle_ = false;
}

void CoeServer::continue_upload(const SdoMessage& request, wire::Writer& out) noexcept {
  if (!in_turn(Transfer::kUpload, request, out)) return;
  const std::size_t part = std::min(size_ - at_, kMostSegment);
  const bool last = at_ + part == size_;
  write_sdo(out, CoeService::kSdoResponse,
            {.kind = Kind::kUploadSegmentResponse,
             .address = {},
             .toggle = request.toggle,
             .last = last,
             .data = Bytes(value_).subspan(at_, part)});
  at_ += part;
  if (last) transfer_ = Transfer::kNone;
}

// ---- Download: master -> device

void CoeServer::begin_download(ObjectDictionary& objects, const SdoMessage& request, AlState state,
                               wire::Writer& out) noexcept {
  transfer_ = Transfer::kNone;
  address_ = request.address;
  complete_access_ = request.complete_access;
  if (request.size > kMostValue) return abort(SdoAbort::kTooLong, out);
  size_ = request.size;
  at_ = request.data.size();
  std::ranges::copy(request.data, value_.begin());
  if (at_ == size_) {
    if (const auto code = objects.download(address_, complete_access_, state, Bytes(value_).first(size_))) {
      return abort(*code, out);
    }
  } else {
    transfer_ = Transfer::kDownload;
    toggle_ = false;
  }
  write_sdo(out, CoeService::kSdoResponse,
            {.kind = Kind::kDownloadResponse, .address = address_, .complete_access = complete_access_, .data = {}});
}

void CoeServer::continue_download(ObjectDictionary& objects, const SdoMessage& request, AlState state,
                                  wire::Writer& out) noexcept {
  if (!in_turn(Transfer::kDownload, request, out)) return;
  if (request.data.size() > size_ - at_) return abort(SdoAbort::kTooLong, out);
  std::ranges::copy(request.data, value_.begin() + static_cast<std::ptrdiff_t>(at_));
  at_ += request.data.size();
  if (request.last) {
    if (at_ != size_) return abort(SdoAbort::kLength, out);
    if (const auto code = objects.download(address_, complete_access_, state, Bytes(value_).first(size_))) {
      return abort(*code, out);
    }
    transfer_ = Transfer::kNone;
  }
  write_sdo(out, CoeService::kSdoResponse,
            {.kind = Kind::kDownloadSegmentResponse, .address = {}, .toggle = request.toggle, .data = {}});
}

// Segments belong to a transfer, and their toggle bit alternates, beginning with 0.
bool CoeServer::in_turn(Transfer transfer, const SdoMessage& request, wire::Writer& out) noexcept {
  if (transfer_ != transfer) {
    abort(SdoAbort::kCommand, out);
    return false;
  }
  if (request.toggle != toggle_) {
    abort(SdoAbort::kToggle, out);
    return false;
  }
  toggle_ = !toggle_;
  return true;
}

}  // namespace meca::ethercat
