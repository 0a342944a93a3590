// Reads and writes objects of a device by SDO (ETG.1000.6, 5.6.2): expedited, normal and segmented, uploads also of a
// whole object (Complete Access). A transfer that cannot go on is aborted, so that the device need not wait for the
// rest of it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "transports/ethercat/access_machine.hpp"
#include "transports/ethercat/mailbox_client.hpp"

namespace meca::ethercat {

class SdoClient final : public AccessMachine {
 public:
  static constexpr std::size_t kMostValue = 1024;                                   // that is read or written
  static constexpr std::size_t kMostFirstPart = MailboxClient::kMost - kSdoHeader;  // 112: in the mail that begins it
  static constexpr std::size_t kMostSegment = MailboxClient::kMost - 1;             // 119

  SdoClient(MailboxClient& mailbox, StationCounters& counters) noexcept : mailbox_(mailbox), counters_(counters) {}

  void upload(SdoAddress address, bool complete_access, Time now) noexcept;
  // `data` of more than kMostValue bytes fails at once.
  void download(SdoAddress address, Bytes data, Time now) noexcept;

  void tick(Time now) noexcept override;
  std::optional<Access> next(Time now) noexcept override { return mailbox_.next(now); }
  void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept override;
  void lost(Time now) noexcept override;
  Time next_event() const noexcept override { return mailbox_.next_event(); }

  // When done: what was uploaded, until the next call.
  Bytes value() const noexcept { return reads() ? Bytes(value_).first(at_) : Bytes{}; }
  // When failed: the code, where the device said no.
  std::optional<std::uint32_t> abort() const noexcept { return abort_; }
  SdoAddress address() const noexcept { return address_; }

 private:
  bool reads() const noexcept {
    return request_ == SdoMessage::Kind::kUploadRequest || request_ == SdoMessage::Kind::kUploadSegmentRequest;
  }
  bool in_segments() const noexcept {
    return request_ == SdoMessage::Kind::kUploadSegmentRequest || request_ == SdoMessage::Kind::kDownloadSegmentRequest;
  }
  void begin_transfer(SdoAddress address, Time now) noexcept;
  void send_first(Time now) noexcept;
  void send(Time now) noexcept;
  void go_on(SdoMessage::Kind segments, Time now) noexcept;
  void mail_arrived(Time now) noexcept;
  bool take(const SdoMessage& reply, Time now) noexcept;
  void value_begins(const SdoMessage& reply, Time now) noexcept;
  void segment(const SdoMessage& reply, Time now) noexcept;
  void segment_taken(const SdoMessage& reply, Time now) noexcept;
  void aborted(std::uint32_t code) noexcept;
  void give_up(SdoAbort code, const Predicate& why, Time now) noexcept;
  bool append(Bytes data) noexcept;

  MailboxClient& mailbox_;
  StationCounters& counters_;
  SdoMessage::Kind request_ = SdoMessage::Kind::kUploadRequest;
  SdoAddress address_;
  bool complete_access_ = false, toggle_ = false, again_ = false;
  bool giving_up_ = false;  // the abort is on its way
  Predicate why_;           // then
  std::array<std::byte, kMostValue> value_{};
  std::size_t size_ = 0, at_ = 0;  // of the value; how much of it was read, or sent
  std::optional<std::uint32_t> abort_;
};

}  // namespace meca::ethercat
