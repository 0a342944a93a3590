// What is read and written through the mailbox in PREOP: name and firmware (1008h, 100Ah), the PDO assignment, which is
// always written and then read back down to the bits, and the sync type (spec 5.8).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "transports/ethercat/array_reader.hpp"
#include "transports/ethercat/mailbox_client.hpp"
#include "transports/ethercat/pdo_objects.hpp"
#include "transports/ethercat/sdo_client.hpp"

namespace meca::ethercat {

// "v9.3.3.5809", "10.2.1": as many of the four numbers as there are, two at least; else unknown.
transports::FirmwareVersion parse_firmware(std::string_view text) noexcept;

class CoeConfiguration final : public AccessMachine {
 public:
  using Name = FixedText<63>;

  // `dc`: SYNC0, else SM-synchronous.
  CoeConfiguration(MailboxClient& mailbox, bool dc, StationCounters& counters);

  void start(Time now) noexcept;
  void forget() noexcept;  // name and firmware: it may be another device next time

  void tick(Time now) noexcept override;
  std::optional<Access> next(Time now) noexcept override { return active().next(now); }
  void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept override;
  void lost(Time now) noexcept override { active().lost(now); }
  Time next_event() const noexcept override;

  const Name& name() const noexcept { return name_; }
  transports::FirmwareVersion firmware() const noexcept { return firmware_; }
  std::uint16_t object() const noexcept { return sdo_.address().index; }  // that it is at

 private:
  enum class Step : std::uint8_t {
    kDrain,
    kName,
    kFirmware,
    kSafety,          // is there a 1A11h?
    kAssign,          // writes 1C12h and 1C13h
    kReadAssignment,  // and reads them
    kReadMapping,     // and what they map
    kSyncType,
  };
  struct Direction {  // of process data
    std::uint16_t assignment;
    std::uint32_t bits;
    const char* name;
  };
  static constexpr std::array<Direction, 2> kDirections{{
      {kRxPdoAssignment, kOutputSize * 8U, "outputs"},
      {kTxPdoAssignment, kInputSize * 8U, "inputs"},
  }};

  AccessMachine& active() noexcept;
  const AccessMachine& active() const noexcept { return const_cast<CoeConfiguration*>(this)->active(); }
  void proceed(Time now) noexcept;
  bool may_refuse() const noexcept;
  void finish_step(Time now) noexcept;
  void begin_step(Step step, Time now) noexcept;
  void write_assignment(Time now) noexcept;
  void assignment_read(Time now) noexcept;
  void mapping_read(Time now) noexcept;
  void direction_done(Time now) noexcept;
  void write_sync_type(Time now) noexcept;
  std::span<const std::uint16_t> wanted(std::size_t direction) const noexcept;
  std::uint32_t expected_bits(std::size_t direction, std::size_t pdo) const noexcept;

  MailboxClient& mailbox_;
  SdoClient sdo_;
  ArrayReader array_;
  const bool dc_;
  const std::array<std::vector<Pdo>, 2> rx_, tx_;  // without and with 1A11h
  Step step_ = Step::kDrain;
  bool safety_ = false;
  std::size_t direction_ = 0, item_ = 0;
  std::uint32_t bits_ = 0;
  FixedText<64> difference_;  // the first PDO that is not as expected
  Name name_;
  transports::FirmwareVersion firmware_;
};

}  // namespace meca::ethercat
