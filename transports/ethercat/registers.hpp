// Registers of an EtherCAT slave controller (ESC) and what is written there (ETG.1000.4, 6; ESC data sheet section II;
// spec 5.3, 5.5, 5.6). Both ends use these names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace meca::ethercat {

namespace reg {
inline constexpr std::uint16_t kType = 0x0000, kFmmuCount = 0x0004, kSyncManagerCount = 0x0005, kRamSize = 0x0006,
                               kPortDescriptor = 0x0007, kFeatures = 0x0008;
inline constexpr std::uint16_t kStationAddress = 0x0010, kStationAlias = 0x0012;
inline constexpr std::uint16_t kDlControl = 0x0100, kDlLoopControl = 0x0101, kDlAliasEnable = 0x0103,
                               kDlStatus = 0x0110;
inline constexpr std::uint16_t kAlControl = 0x0120, kAlStatus = 0x0130, kAlStatusCode = 0x0134;
inline constexpr std::uint16_t kPdiControl = 0x0140;
inline constexpr std::uint16_t kEcatEventMask = 0x0200, kEcatEvent = 0x0210, kAlEvent = 0x0220;
inline constexpr std::uint16_t kRxErrors = 0x0300, kForwardedErrors = 0x0308, kProcessingErrors = 0x030C,
                               kPdiErrors = 0x030D, kLostLinks = 0x0310;  // kRxErrors: per port invalid frames, errors
inline constexpr std::uint16_t kErrorCountersSize = 0x14;
inline constexpr std::uint16_t kWatchdogDivider = 0x0400, kPdiWatchdog = 0x0410, kSmWatchdog = 0x0420,
                               kSmWatchdogStatus = 0x0440, kSmWatchdogExpiries = 0x0442, kPdiWatchdogExpiries = 0x0443;
inline constexpr std::uint16_t kSiiOwner = 0x0500, kSiiPdiAccess = 0x0501, kSiiControl = 0x0502, kSiiAddress = 0x0504,
                               kSiiData = 0x0508;
inline constexpr std::uint16_t kFmmu = 0x0600, kFmmuSize = 16;
inline constexpr std::uint16_t kSyncManager = 0x0800, kSyncManagerSize = 8;  // +5: status, +6: activate, +7: PDI
inline constexpr std::uint16_t kDcReceiveTimes = 0x0900, kDcSystemTime = 0x0910, kDcReceiveTimePu = 0x0918,
                               kDcOffset = 0x0920, kDcDelay = 0x0928, kDcDifference = 0x092C, kDcSpeedStart = 0x0930,
                               kDcFilterDepths = 0x0934, kDcCyclicUnit = 0x0980, kDcActivation = 0x0981,
                               kDcStartTime = 0x0990, kDcSync0Cycle = 0x09A0, kDcSync1Cycle = 0x09A4;
inline constexpr std::uint16_t kProcessRam = 0x1000;

constexpr std::uint16_t fmmu(unsigned n) noexcept { return static_cast<std::uint16_t>(kFmmu + n * kFmmuSize); }
constexpr std::uint16_t sync_manager(unsigned n) noexcept {
  return static_cast<std::uint16_t>(kSyncManager + n * kSyncManagerSize);
}
}  // namespace reg

// AL control and AL status, low nibble.
enum class AlState : std::uint8_t { kInit = 1, kPreop = 2, kBoot = 3, kSafeop = 4, kOp = 8 };
inline constexpr std::uint16_t kAlStateMask = 0x000F;
inline constexpr std::uint16_t kAlError = 0x0010;        // AL status: an error indication stands
inline constexpr std::uint16_t kAlAcknowledge = 0x0010;  // AL control: acknowledges it

// Features, register 0008.
inline constexpr std::uint16_t kFeatureDc = 0x0004, kFeatureDc64 = 0x0008, kFeatureEnhancedDc = 0x0100,
                               kFeatureNoLrw = 0x0200;

// How a Meca500 lays out its memory (vendor's ESI; spec 5.6). Start, length and control byte of each sync
// manager; 0 mailbox to the device, 1 mailbox from the device, 2 outputs, 3 inputs.
struct SyncManagerLayout {
  std::uint16_t start, length;
  std::uint8_t control;
};
inline constexpr std::uint16_t kMailboxSize = 128, kOutputSize = 60, kInputSize = 252;
inline constexpr std::array<SyncManagerLayout, 4> kSyncManagers{{
    {0x1000, kMailboxSize, 0x26},
    {0x1080, kMailboxSize, 0x22},
    {0x1100, kOutputSize, 0x64},  // 0x40 of it: writing it feeds the watchdog
    {0x1400, kInputSize, 0x20},
}};
constexpr std::array<std::byte, reg::kSyncManagerSize> sync_manager_bytes(unsigned n, bool enable) noexcept {
  const SyncManagerLayout& sm = kSyncManagers[n];
  return {static_cast<std::byte>(sm.start & 0xFF),
          static_cast<std::byte>(sm.start >> 8),
          static_cast<std::byte>(sm.length & 0xFF),
          static_cast<std::byte>(sm.length >> 8),
          static_cast<std::byte>(sm.control),
          std::byte{0},
          std::byte{enable},
          std::byte{0}};
}

// Whole bytes of the logical address space onto the start of sync manager 2 (outputs, written) or 3 (inputs, read).
constexpr std::array<std::byte, reg::kFmmuSize> fmmu_bytes(std::uint32_t logical, bool outputs) noexcept {
  const SyncManagerLayout& sm = kSyncManagers[outputs ? 2 : 3];
  std::array<std::byte, reg::kFmmuSize> out{};
  for (unsigned i = 0; i < 4; ++i) out[i] = static_cast<std::byte>(logical >> 8 * i & 0xFF);
  out[4] = static_cast<std::byte>(sm.length & 0xFF);
  out[5] = static_cast<std::byte>(sm.length >> 8);
  out[7] = std::byte{7};  // last bit
  out[8] = static_cast<std::byte>(sm.start & 0xFF);
  out[9] = static_cast<std::byte>(sm.start >> 8);
  out[11] = outputs ? std::byte{2} : std::byte{1};
  out[12] = std::byte{1};
  return out;
}

// Who a Meca500 is, whatever its firmware (vendor's ESI).
inline constexpr std::uint32_t kMecademicVendor = 0x00ECADE1, kMeca500Product = 0x0004D500, kMeca500Revision = 1;

}  // namespace meca::ethercat
