#include "transports/ethercat/al_status.hpp"

#include <algorithm>
#include <iterator>

namespace meca::ethercat {
namespace {

template <class Code>
struct Text {
  Code code;
  std::string_view text;
};

// ETG.1000.6, table of AL status codes, and ETG.1020 for 0060h and after. Sorted.
constexpr Text<std::uint16_t> kAlCodes[] = {
    {0x0000, "no error"},
    {0x0001, "an error that the device does not name"},
    {0x0002, "no memory left in the device"},
    {0x0003, "invalid device setup: its configuration in the SII or its hardware is not as its firmware expects"},
    {0x0004, "invalid revision: another firmware than the configuration is for"},
    {0x0006, "SII and firmware do not match"},
    {0x0007, "firmware update failed: the old one goes on"},
    {0x000E, "licence error"},
    {0x0011, "invalid state change: the requested state cannot be reached from this one"},
    {0x0012, "unknown state requested"},
    {0x0013, "bootstrap is not supported"},
    {0x0014, "no valid firmware"},
    {0x0015, "invalid mailbox configuration for bootstrap"},
    {0x0016, "invalid mailbox configuration: sync managers 0 and 1 are not as the device has its mailbox"},
    {0x0017, "invalid sync manager configuration"},
    {0x0018, "no valid inputs available"},
    {0x0019, "no valid outputs: none were received yet"},
    {0x001A,
     "synchronization error: process data and SYNC0 lost each other; the master stopped, or its cycle does not "
     "follow the reference clock"},
    {0x001B, "sync manager watchdog: no outputs arrived in time; the master stopped, is late, or the cable was pulled"},
    {0x001C, "invalid sync manager types"},
    {0x001D, "invalid output configuration: sync manager 2 does not have the length of the PDO assignment"},
    {0x001E, "invalid input configuration: sync manager 3 does not have the length of the PDO assignment"},
    {0x001F, "invalid watchdog configuration: the watchdog of the outputs is off or too short"},
    {0x0020, "the device needs a cold start: switch its power off and on"},
    {0x0021, "the device needs INIT first"},
    {0x0022, "the device needs PREOP first"},
    {0x0023, "the device needs SAFEOP first"},
    {0x0024, "invalid input mapping: the PDO assignment does not give the length of the input sync manager"},
    {0x0025, "invalid output mapping: the PDO assignment does not give the length of the output sync manager"},
    {0x0026, "inconsistent settings"},
    {0x0027, "free run is not supported: choose SM or DC synchronization"},
    {0x0028, "this synchronization is not supported: choose another"},
    {0x0029, "free run needs buffered sync managers"},
    {0x002A, "watchdog of the device's own application"},
    {0x002B, "no valid inputs and outputs"},
    {0x002C, "fatal synchronization error: SYNC0 is not received any more"},
    {0x002D,
     "no synchronization: SYNC0 was not received at all; the distributed clocks are not set up, or process data "
     "started too late"},
    {0x002E, "cycle time too small, or invalid input FMMU: devices differ"},
    {0x0030, "invalid DC SYNC configuration: SYNC0 is not switched on as the synchronization needs it"},
    {0x0031, "invalid DC latch configuration"},
    {0x0032, "DC PLL error: the device could not lock on to the master's cycle"},
    {0x0033, "DC synchronization I/O error"},
    {0x0034, "DC synchronization timeout: too many SYNC events were missed"},
    {0x0035, "invalid DC cycle time: choose one that the device supports"},
    {0x0036, "invalid SYNC0 cycle time: choose one that the device supports"},
    {0x0037, "invalid SYNC1 cycle time: choose one that the device supports"},
    {0x0041, "AoE mailbox error"},
    {0x0042, "EoE mailbox error"},
    {0x0043, "CoE mailbox error"},
    {0x0044, "FoE mailbox error"},
    {0x0045, "SoE mailbox error"},
    {0x004F, "VoE mailbox error"},
    {0x0050, "the device has no access to its SII: the master has not given it back"},
    {0x0051, "SII error: the device cannot read its own data"},
    {0x0052, "hardware outside of the device's controller is not ready"},
    {0x0060, "the device restarted by itself"},
    {0x0061, "the device's identification changed"},
    {0x0070, "the modules found are not the ones configured"},
};

// ETG.1000.6, 5.6.2.7.
constexpr Text<std::uint32_t> kAborts[] = {
    {0x05030000, "toggle bit did not change"},
    {0x05040000, "SDO timeout"},
    {0x05040001, "unknown SDO command"},
    {0x05040005, "out of memory"},
    {0x06010000, "access not supported"},
    {0x06010001, "object can only be written"},
    {0x06010002, "object can only be read"},
    {0x06010003, "entry cannot be written while subindex 0 is not 0"},
    {0x06010004, "no complete access: the object has entries of variable length"},
    {0x06010005, "object is longer than the mailbox"},
    {0x06010006, "object is mapped into a receive PDO, so it cannot be written by SDO"},
    {0x06020000, "object does not exist"},
    {0x06040041, "object cannot be mapped into a PDO"},
    {0x06040042, "mapped objects are longer than the PDO"},
    {0x06040043, "parameters are incompatible"},
    {0x06040047, "incompatible inside the device"},
    {0x06060000, "access failed for a hardware error"},
    {0x06070010, "value has the wrong length"},
    {0x06070012, "value is too long"},
    {0x06070013, "value is too short"},
    {0x06090011, "subindex does not exist"},
    {0x06090030, "value is out of range"},
    {0x06090031, "value is too large"},
    {0x06090032, "value is too small"},
    {0x06090036, "maximum is less than minimum"},
    {0x08000000, "general error"},
    {0x08000020, "value cannot be transferred or stored"},
    {0x08000021, "value cannot be transferred or stored: the device is under local control"},
    {0x08000022, "value cannot be transferred or stored in this AL state"},
    {0x08000023, "no object dictionary"},
};

template <class Code>
constexpr bool ascending(const Text<Code>* begin, const Text<Code>* end) noexcept {
  return std::adjacent_find(begin, end, [](const auto& a, const auto& b) { return a.code >= b.code; }) == end;
}
static_assert(ascending(std::begin(kAlCodes), std::end(kAlCodes)));
static_assert(ascending(std::begin(kAborts), std::end(kAborts)));

template <class Code, std::size_t kSize>
std::string_view find(const Text<Code> (&texts)[kSize], Code code) noexcept {
  const auto* const end = std::end(texts);
  const auto* const found =
      std::lower_bound(std::begin(texts), end, code, [](const auto& text, Code wanted) { return text.code < wanted; });
  return found != end && found->code == code ? found->text : "not known";
}

}  // namespace

std::string_view al_state_name(std::uint16_t al_status) noexcept {
  switch (static_cast<AlState>(al_status & kAlStateMask)) {
    case AlState::kInit:
      return "INIT";
    case AlState::kPreop:
      return "PREOP";
    case AlState::kBoot:
      return "BOOT";
    case AlState::kSafeop:
      return "SAFEOP";
    case AlState::kOp:
      return "OP";
  }
  return "an unknown state";
}

std::string_view al_code_text(std::uint16_t code) noexcept { return find(kAlCodes, code); }

std::string_view abort_text(std::uint32_t code) noexcept { return find(kAborts, code); }

}  // namespace meca::ethercat
