// Our end of a device's mailbox: one CoE request at a time and the mails that answer it (ETG.1000.4, 11;
// spec 5.8). A mail that is lost on its way to the device is written again with the same counter, so that
// the device drops it if it has it; a mail that is lost on its way to us is asked for again.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "transports/ethercat/access_machine.hpp"
#include "transports/ethercat/mailbox.hpp"

namespace meca::ethercat {

class MailboxClient final : public AccessMachine {
 public:
  struct Timeouts {
    Time request, response;
  };
  MailboxClient(Timeouts timeouts, StationCounters& counters) noexcept : timeouts_(timeouts), counters_(counters) {}

  // Most bytes of a mail after its CoE header.
  static constexpr std::size_t kMost = kMailboxSize - kMailboxHeader - kCoeHeader;

  // Reads and forgets whatever the device still has for us (but emergencies count); done when that is nothing.
  void drain(Time now) noexcept;
  // Sends an SDO request (`sdo`: what stands after the CoE header, at most kMost bytes), done with the next mail of the
  // SDO services.
  void request(Bytes sdo, Time now) noexcept;
  // Sends an SDO service that nobody answers (an abort): done when the device has it in its mailbox.
  void notify(Bytes sdo, Time now) noexcept;
  // The mail was none that answers the request: done with the next one.
  void wait_for_another(Time now) noexcept;

  void tick(Time now) noexcept override;
  std::optional<Access> next(Time now) noexcept override;
  void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept override;
  void lost(Time now) noexcept override;
  Time next_event() const noexcept override { return due_; }

  // Of the mail that is there when done, until the next call; aborts come as service request.
  CoeService service() const noexcept { return service_; }
  Bytes sdo() const noexcept { return Bytes(in_).subspan(sdo_at_, sdo_size_); }
  // Failed because the answer was lost and the device does not give it again: the request may be made anew.
  bool reply_lost() const noexcept { return reply_lost_; }
  const std::optional<Emergency>& last_emergency() const noexcept { return emergency_; }

 private:
  enum class Step : std::uint8_t {
    kWrite,       // into sync manager 0; by turns with kStatus while that is full
    kStatus,      // is there a mail in sync manager 1?
    kRead,        // out of it
    kFindRepeat,  // a mail may have been lost: how do request and acknowledge of a repeat stand?
    kRepeat,      // request it
    kRepeated,    // wait for the acknowledge
  };
  void begin_mail(Bytes sdo, Time now) noexcept;
  void wrote(std::uint16_t working_counter, Time now) noexcept;
  void status_read(std::uint8_t status, Time now) noexcept;
  void mail_read(Bytes memory, Time now) noexcept;
  void repeat_read(std::uint8_t activate, std::uint8_t pdi, Time now) noexcept;
  bool coe_received(Bytes payload) noexcept;
  void go(Step step, Time due) noexcept {
    step_ = step;
    due_ = due;
  }

  Timeouts timeouts_;
  StationCounters& counters_;
  Step step_ = Step::kStatus;
  bool draining_ = false, answered_ = true, heard_ = false;  // answered: the mail is one that the device answers
  bool written_ = false;                                     // the mail lies in sync manager 0, or did
  bool maybe_written_ = false;                               // a writing of it was lost
  bool maybe_taken_ = false;                                 // a reading of sync manager 1 was lost
  bool reply_lost_ = false;
  std::uint8_t counter_ = 0;
  std::array<std::byte, kMailboxSize> out_{}, in_{};
  std::array<std::byte, 1> activate_{};
  std::size_t sdo_at_ = 0, sdo_size_ = 0;
  CoeService service_ = CoeService::kSdoResponse;
  std::optional<Emergency> emergency_;
  Time due_{}, deadline_{}, repeat_deadline_{};
};

}  // namespace meca::ethercat
