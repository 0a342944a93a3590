// A device at register level for the tests of our end: memory with a state machine, a mailbox and a dictionary behind
// it. It does at once what it is told, unless a test wants something else. The real one is
// transports/ethercat/device.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "transports/ethercat/mailbox.hpp"
#include "transports/ethercat/pdo_objects.hpp"
#include "transports/ethercat/registers.hpp"
#include "transports/ethercat/station.hpp"
#include "transports/wire/writer.hpp"

namespace meca::ethercat::station_test {

using namespace std::chrono_literals;
using ByteVector = std::vector<std::byte>;

inline ByteVector le(std::uint64_t value, std::size_t size) {
  ByteVector out;
  for (std::size_t i = 0; i < size; ++i) out.push_back(static_cast<std::byte>(value >> 8 * i & 0xFF));
  return out;
}
inline ByteVector text(std::string_view s) {
  const auto all = std::as_bytes(std::span(s.data(), s.size()));
  return {all.begin(), all.end()};
}

// The objects that a station asks for, as a robot with this layout has them.
class Dictionary {
 public:
  bool complete_access = true;
  std::map<std::uint32_t, std::uint32_t> refuse_read, refuse_write;  // key() -> abort code
  std::vector<std::uint32_t> written;                                // key(), in order
  std::vector<std::uint32_t> not_kept;                               // key(): written without effect

  static std::uint32_t key(std::uint16_t index, std::uint8_t sub) {
    return static_cast<std::uint32_t>(index) << 8 | sub;
  }
  explicit Dictionary(image::Layout layout) {
    set(0x1008, 0, text("Meca500"));
    set(0x100A, 0, text(layout == image::Layout::kFirmware9 ? "v9.3.3.5809" : "11.3.3.12637"));
    for (const auto& pdo : rx_pdos(layout)) set_mapping(pdo);
    for (const auto& pdo : tx_pdos(layout)) set_mapping(pdo);
    for (const std::uint16_t index : {kRxPdoAssignment, kTxPdoAssignment}) set(index, 0, le(0, 1));
    for (const std::uint16_t index : {0x1C32, 0x1C33}) set(static_cast<std::uint16_t>(index), 1, le(1, 2));
  }
  void set(std::uint16_t index, std::uint8_t sub, ByteVector value) { objects_[key(index, sub)] = std::move(value); }
  void erase(std::uint16_t index) {
    std::erase_if(objects_, [index](const auto& o) { return o.first >> 8 == index; });
  }
  void set_mapping(const Pdo& pdo) {
    set(pdo.index, 0, le(pdo.entries.size(), 1));
    for (std::size_t i = 0; i < pdo.entries.size(); ++i) {
      set(pdo.index, static_cast<std::uint8_t>(i + 1), le(pdo.entries[i], 4));
    }
  }
  std::uint32_t number(std::uint16_t index, std::uint8_t sub) const {
    std::uint32_t out = 0;
    const auto found = objects_.find(key(index, sub));
    if (found == objects_.end()) return 0;
    for (std::size_t i = found->second.size(); i-- > 0;) {
      out = out << 8 | std::to_integer<std::uint32_t>(found->second[i]);
    }
    return out;
  }
  // The value, or the abort code.
  std::uint32_t read(SdoAddress address, bool complete, ByteVector& out) const {
    const std::uint32_t at = key(address.index, address.sub);
    if (const auto refused = refuse_read.find(at); refused != refuse_read.end()) return refused->second;
    if (complete && !complete_access) return static_cast<std::uint32_t>(SdoAbort::kNoCompleteAccess);
    const auto found = objects_.find(at);
    if (found == objects_.end()) {
      return static_cast<std::uint32_t>(exists(address.index) ? SdoAbort::kNoSubindex : SdoAbort::kNoObject);
    }
    out = found->second;
    if (!complete) return 0;
    out.resize(2);
    const auto most = std::min<std::uint32_t>(number(address.index, 0), 0xFF);
    for (std::uint32_t sub = 1; sub <= most; ++sub) {
      const auto entry = objects_.find(key(address.index, static_cast<std::uint8_t>(sub)));
      if (entry != objects_.end()) out.insert(out.end(), entry->second.begin(), entry->second.end());
    }
    return 0;
  }
  std::uint32_t write(SdoAddress address, Bytes value) {
    const std::uint32_t at = key(address.index, address.sub);
    written.push_back(at);
    if (const auto refused = refuse_write.find(at); refused != refuse_write.end()) return refused->second;
    if (std::ranges::count(not_kept, at) == 0) set(address.index, address.sub, {value.begin(), value.end()});
    return 0;
  }

 private:
  bool exists(std::uint16_t index) const {
    const auto from = objects_.lower_bound(key(index, 0));
    return from != objects_.end() && from->first >> 8 == index;
  }
  std::map<std::uint32_t, ByteVector> objects_;
};

class FakeDevice {
 public:
  explicit FakeDevice(image::Layout layout = image::Layout::kFirmware11) : dictionary(layout) { power_cycle(); }

  Dictionary dictionary;
  std::map<AlState, std::uint16_t> refuse;  // AL code of a step
  bool answers_mails = true, repeats_mails = true, takes_mails = true, drops_duplicates = true;
  std::vector<ByteVector> mails;                // that were taken, in order
  std::deque<ByteVector> before_answer;         // mails that are in the mailbox before the next answer
  std::function<ByteVector(ByteVector)> twist;  // what becomes of a mail on its way out
  std::vector<std::uint8_t> al_requests;        // low byte of 0120, in order
  std::size_t duplicates = 0;
  bool powered = true;
  std::vector<std::uint16_t> missing;  // registers that it does not have

  struct Answer {
    std::uint16_t working_counter = 0;
    ByteVector data;
  };
  Answer access(const Access& access) {
    if (!powered || std::ranges::count(missing, access.address) != 0)
      return {0, access.write ? ByteVector{} : ByteVector(access.size)};
    return access.write ? write(access) : read(access);
  }

  std::uint16_t status() const { return u16(reg::kAlStatus); }
  void set_status(std::uint16_t status, std::uint16_t code) {
    put(reg::kAlStatus, le(status, 2));
    put(reg::kAlStatusCode, le(code, 2));
  }
  void power_cycle() {
    memory_ = {};
    outbox_.clear();
    counter_ = 0;
    last_counter_ = 0;
    set_status(1, 0);
  }
  ByteVector memory(std::uint16_t address, std::size_t size) const {
    return {memory_.begin() + address, memory_.begin() + static_cast<std::ptrdiff_t>(address + size)};
  }
  void post(std::uint8_t type, ByteVector payload) {
    ByteVector mail(kMailboxSize);
    wire::Writer out(mail);
    MailboxHeader header;
    header.length = static_cast<std::uint16_t>(payload.size());
    header.type = type;
    header.counter = counter_ = next_mailbox_counter(counter_);
    ethercat::write(out, header);
    out.bytes(payload);
    outbox_.push_back(twist ? twist(std::move(mail)) : std::move(mail));
  }
  void post_emergency(std::uint16_t code) {
    ByteVector payload(2 + 8);
    wire::Writer out(payload);
    ethercat::write(out, CoeHeader{0, static_cast<std::uint8_t>(CoeService::kEmergency)});
    ethercat::write(out, Emergency{code, 0x81, {}});
    post(3, payload);
  }
  void post_sdo(const SdoMessage& message, CoeService service = CoeService::kSdoResponse) {
    ByteVector payload(kMostCoe + 2);
    wire::Writer out(payload);
    ethercat::write(out, CoeHeader{0, static_cast<std::uint8_t>(service)});
    ethercat::write(out, message);
    payload.resize(out.size());
    post(3, payload);
  }

 private:
  static constexpr std::size_t kMostCoe = kMailboxSize - kMailboxHeader - kCoeHeader;
  static constexpr std::uint16_t kMailOut = 0x1000, kMailIn = 0x1080;

  std::uint16_t u16(std::uint16_t address) const {
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(memory_[address]) |
                                      std::to_integer<unsigned>(memory_[address + 1U]) << 8);
  }
  void put(std::uint16_t address, const ByteVector& bytes) { std::ranges::copy(bytes, memory_.begin() + address); }

  Answer read(const Access& access) {
    if (access.address == kMailIn) {
      if (outbox_.empty()) return {0, ByteVector(access.size)};
      last_mail_ = outbox_.front();
      outbox_.pop_front();
      return {1, last_mail_};
    }
    memory_[reg::sync_manager(1) + 5U] = std::byte{outbox_.empty() ? std::uint8_t{0} : std::uint8_t{0x08}};
    return {1, memory(access.address, access.size)};
  }
  Answer write(const Access& access) {
    const ByteVector data(access.data.begin(), access.data.end());
    if (access.address == kMailOut) {
      if (!takes_mails || (status() & 0x0F) < 2) return {};
      mails.push_back(data);
      take_mail(data);
      return {1, {}};
    }
    put(access.address, data);
    if (access.address == reg::kAlControl) request_state(std::to_integer<std::uint8_t>(data[0]));
    if (access.address == reg::sync_manager(1) + 6U && repeats_mails) {
      const std::byte acknowledge = memory_[reg::sync_manager(1) + 7U];
      if (((data[0] ^ acknowledge) & std::byte{2}) != std::byte{0} && !last_mail_.empty())
        outbox_.push_front(last_mail_);
      memory_[reg::sync_manager(1) + 7U] = data[0] & std::byte{2};
    }
    return {1, {}};
  }
  void request_state(std::uint8_t control) {
    al_requests.push_back(control);
    const auto wanted = static_cast<AlState>(control & 0x0F);
    const bool acknowledges = (control & kAlAcknowledge) != 0;
    if ((status() & kAlError) != 0 && !acknowledges) return;
    const auto refused = refuse.find(wanted);
    if (refused != refuse.end() && !acknowledges)
      return set_status(static_cast<std::uint16_t>(status() | kAlError), refused->second);
    if (wanted == AlState::kInit) outbox_.clear();
    set_status(control & 0x0F, 0);
  }
  void take_mail(const ByteVector& memory) {
    const auto mail = parse_mail(memory);
    if (!mail) return;
    if (drops_duplicates && mail->header.counter == last_counter_) {
      ++duplicates;
      return;
    }
    last_counter_ = mail->header.counter;
    for (; !before_answer.empty(); before_answer.pop_front()) outbox_.push_back(before_answer.front());
    if (!answers_mails) return;
    wire::Reader in(mail->payload);
    read_coe_header(in);
    const auto request = parse_sdo(CoeService::kSdoRequest, in.rest());
    if (request) answer(*request);
  }
  void answer(const SdoMessage& request) {
    switch (request.kind) {
      case SdoMessage::Kind::kUploadRequest:
        if (const auto code = dictionary.read(request.address, request.complete_access, upload_))
          return abort(request, code);
        return begin_upload(request);
      case SdoMessage::Kind::kUploadSegmentRequest:
        return send_segment(request);
      case SdoMessage::Kind::kDownloadRequest:
        return begin_download(request);
      case SdoMessage::Kind::kDownloadSegmentRequest:
        return take_segment(request);
      default:
        return abort(request, static_cast<std::uint32_t>(SdoAbort::kCommand));
    }
  }
  static SdoMessage reply_to(const SdoMessage& request, SdoMessage::Kind kind) {
    SdoMessage reply;
    reply.kind = kind;
    reply.address = request.address;
    reply.complete_access = request.complete_access;
    reply.toggle = request.toggle;
    return reply;
  }
  void abort(const SdoMessage& request, std::uint32_t code) {
    auto reply = reply_to(request, SdoMessage::Kind::kAbort);
    reply.abort = code;
    post_sdo(reply, CoeService::kSdoRequest);
  }
  void begin_upload(const SdoMessage& request) {
    auto reply = reply_to(request, SdoMessage::Kind::kUploadResponse);
    reply.size = static_cast<std::uint32_t>(upload_.size());
    reply.expedited = upload_.size() <= 4;
    sent_ = std::min<std::size_t>(upload_.size(), 112);
    reply.data = Bytes(upload_).first(sent_);
    post_sdo(reply);
  }
  void send_segment(const SdoMessage& request) {
    auto reply = reply_to(request, SdoMessage::Kind::kUploadSegmentResponse);
    const std::size_t size = std::min<std::size_t>(upload_.size() - sent_, 119);
    reply.data = Bytes(upload_).subspan(sent_, size);
    sent_ += size;
    reply.last = sent_ == upload_.size();
    post_sdo(reply);
  }

  void begin_download(const SdoMessage& request) {
    download_.assign(request.data.begin(), request.data.end());
    downloading_ = request;
    if (download_.size() < request.size) return post_sdo(reply_to(request, SdoMessage::Kind::kDownloadResponse));
    finish_download(reply_to(request, SdoMessage::Kind::kDownloadResponse));
  }
  void take_segment(const SdoMessage& request) {
    download_.insert(download_.end(), request.data.begin(), request.data.end());
    const auto reply = reply_to(request, SdoMessage::Kind::kDownloadSegmentResponse);
    request.last ? finish_download(reply) : post_sdo(reply);
  }
  void finish_download(const SdoMessage& reply) {
    const auto code = download_.size() == downloading_.size ? dictionary.write(downloading_.address, download_)
                                                            : static_cast<std::uint32_t>(SdoAbort::kLength);
    code != 0 ? abort(downloading_, code) : post_sdo(reply);
  }

  std::array<std::byte, 0x3000> memory_{};
  std::deque<ByteVector> outbox_;
  ByteVector last_mail_, upload_, download_;
  SdoMessage downloading_;  // without its data
  std::size_t sent_ = 0;
  std::uint8_t counter_ = 0, last_counter_ = 0;
};

}  // namespace meca::ethercat::station_test
