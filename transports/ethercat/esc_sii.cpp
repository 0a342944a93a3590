// The SII as ECAT reaches it: owner 0500, control and status 0502, word address 0504, data 0508 (ETG.1000.4, 6.4; ESC
// data sheet section II). A command takes its time; until then bit 15 stands and the registers hold still.
#include "transports/ethercat/esc_state.hpp"
#include "transports/ethercat/sii.hpp"

namespace meca::ethercat {
using namespace esc;
namespace {

enum SiiCommand : std::uint8_t { kNop = 0, kRead = 1, kWrite = 2, kReload = 4 };

constexpr std::size_t kConfigured = 16;  // bytes of the configuration area, with its checksum in byte 14
constexpr std::uint32_t kPdiConfiguration = 0x0150, kSyncPulse = 0x0982;

}  // namespace

void EscState::show_sii() noexcept {
  unsigned status = sii_errors | (settings.sii_reads_8_bytes ? kSii8Bytes : 0u);
  if (sii_busy()) status |= kSiiBusy | static_cast<unsigned>(sii_command_running) << 8;
  put(reg::kSiiControl, 2, status);
}

void EscState::sii_command(std::uint8_t command, bool write_enable, Time now) noexcept {
  sii_errors &= kSiiChecksumError | kSiiNotLoaded;  // any command clears the errors of the one before
  switch (command) {
    case kNop:
      break;
    case kWrite:
      if (!write_enable) {
        sii_errors |= kSiiWriteEnableError;
        break;
      }
      [[fallthrough]];
    case kRead:
    case kReload:
      sii_command_running = command;
      sii_ready = now + settings.sii_busy;
      break;
    default:
      sii_errors |= kSiiCommandError;
  }
  show_sii();
}

void EscState::sii_finish() noexcept {
  const std::uint64_t at = std::uint64_t{u32(reg::kSiiAddress)} * 2;
  std::vector<std::byte>& image = settings.sii;
  switch (sii_command_running) {
    case kRead:
      for (unsigned i = 0; i < (settings.sii_reads_8_bytes ? 8u : 4u); ++i)
        memory[reg::kSiiData + i] = at + i < image.size() ? image[at + i] : std::byte{0xFF};
      break;
    case kWrite:
      if (at + 2 <= image.size()) {
        std::copy_n(memory.begin() + reg::kSiiData, 2, image.begin() + static_cast<std::ptrdiff_t>(at));
      } else {
        sii_errors |= kSiiCommandError;  // nobody acknowledges
      }
      break;
    case kReload:
      sii_load(false);
      break;
    default:
      break;
  }
  sii_command_running = kNop;
  show_sii();
}

// Words 0 to 7 configure the ESC. The alias is taken at power-on only, so that it does not change under a master.
void EscState::sii_load(bool with_alias) noexcept {
  const Bytes image = settings.sii;
  const bool right =
      image.size() >= kConfigured && sii_checksum(image.first(14)) == std::to_integer<std::uint8_t>(image[14]);
  sii_errors = right ? 0 : kSiiChecksumError | kSiiNotLoaded;
  set_bits(reg::kDlStatus, 1, right);  // PDI operational
  if (right) {
    const auto load = [&](std::uint32_t to, std::size_t word) {
      std::copy_n(image.begin() + static_cast<std::ptrdiff_t>(word * 2), 2, memory.begin() + to);
    };
    load(reg::kPdiControl, 0);
    load(kPdiConfiguration, 1);
    load(kSyncPulse, 2);
    load(kPdiConfiguration + 2, 3);
    if (with_alias) load(reg::kStationAlias, sii::kAlias);
  }
  show_sii();
}

bool Esc::sii_belongs_to_pdi() const noexcept { return (state_->u8(reg::kSiiOwner) & 1) != 0; }

}  // namespace meca::ethercat
