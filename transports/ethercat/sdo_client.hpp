// Reads and writes objects of a device by SDO (ETG.1000.6, 5.6.2): expedited, normal and segmented uploads, also of a
// whole object (Complete Access); expedited and normal downloads.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "transports/ethercat/access_machine.hpp"
#include "transports/ethercat/mailbox_client.hpp"

namespace meca::ethercat {

class SdoClient final : public AccessMachine {
 public:
  static constexpr std::size_t kMostUpload = 1024;
  static constexpr std::size_t kMostDownload = MailboxClient::kMost - kSdoHeader;  // 112, in one mail

  SdoClient(MailboxClient& mailbox, StationCounters& counters) noexcept : mailbox_(mailbox), counters_(counters) {}

  void upload(SdoAddress address, bool complete_access, Time now) noexcept;
  // `data`: at most kMostDownload bytes.
  void download(SdoAddress address, Bytes data, Time now) noexcept;

  void tick(Time now) noexcept override;
  std::optional<Access> next(Time now) noexcept override { return mailbox_.next(now); }
  void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept override;
  void lost(Time now) noexcept override;
  Time next_event() const noexcept override { return mailbox_.next_event(); }

  // When done: what was uploaded, until the next call.
  Bytes value() const noexcept { return Bytes(value_).first(received_); }
  // When failed: the code, where the device said no.
  std::optional<std::uint32_t> abort() const noexcept { return abort_; }
  SdoAddress address() const noexcept { return address_; }

 private:
  void begin_transfer(SdoAddress address, Time now) noexcept;
  void send(Time now) noexcept;
  void mail_arrived(Time now) noexcept;
  bool take(const SdoMessage& reply, Time now) noexcept;
  void value_begins(const SdoMessage& reply, Time now) noexcept;
  void segment(const SdoMessage& reply, Time now) noexcept;
  void aborted(std::uint32_t code) noexcept;
  bool append(Bytes data) noexcept;

  MailboxClient& mailbox_;
  StationCounters& counters_;
  SdoMessage::Kind request_ = SdoMessage::Kind::kUploadRequest;
  SdoAddress address_;
  bool complete_access_ = false, toggle_ = false, again_ = false;
  std::array<std::byte, kMostUpload> value_{};
  std::array<std::byte, kMostDownload> sent_{};
  std::size_t sent_size_ = 0, received_ = 0, size_ = 0;
  std::optional<std::uint32_t> abort_;
};

}  // namespace meca::ethercat
