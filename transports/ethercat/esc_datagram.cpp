// What each command does with a datagram that passes (ETG.1000.4, 5.4): who is meant, what is exchanged, what is
// counted.
#include "transports/ethercat/esc_state.hpp"

namespace meca::ethercat {
namespace {

enum class Addressing : std::uint8_t { kNobody, kPosition, kStation, kEverybody, kLogical };

struct Meaning {
  Addressing by;
  bool reads, writes;
  bool multiple = false;  // who is meant reads, the others write
};

constexpr std::array<Meaning, kCommands> kMeanings{{
    {Addressing::kNobody, false, false},        // NOP
    {Addressing::kPosition, true, false},       // APRD
    {Addressing::kPosition, false, true},       // APWR
    {Addressing::kPosition, true, true},        // APRW
    {Addressing::kStation, true, false},        // FPRD
    {Addressing::kStation, false, true},        // FPWR
    {Addressing::kStation, true, true},         // FPRW
    {Addressing::kEverybody, true, false},      // BRD
    {Addressing::kEverybody, false, true},      // BWR
    {Addressing::kEverybody, true, true},       // BRW
    {Addressing::kLogical, true, false},        // LRD
    {Addressing::kLogical, false, true},        // LWR
    {Addressing::kLogical, true, true},         // LRW
    {Addressing::kPosition, true, true, true},  // ARMW
    {Addressing::kStation, true, true, true},   // FRMW
}};

constexpr std::uint16_t kFeatureNoReadWrite = 0x0400;  // no BRW, APRW, FPRW
constexpr std::size_t kMostDatagramData = 0x0800;      // the length has 11 bits

bool meant(const EscState& s, Addressing by, const MutableDatagram& d) noexcept {
  switch (by) {
    case Addressing::kNobody:
    case Addressing::kLogical:
      return false;
    case Addressing::kPosition:
      return d.adp() == 0;
    case Addressing::kStation:
      return d.adp() == s.u16(reg::kStationAddress) ||
             ((s.u8(reg::kDlAliasEnable) & 1) != 0 && d.adp() == s.u16(reg::kStationAlias));
    case Addressing::kEverybody:
      return true;
  }
  return false;
}

}  // namespace

// Reading counts 1, writing 1, or 2 in a command that does both; however many bytes, at least one.
unsigned EscState::exchange(std::uint16_t address, std::span<std::byte> data, bool reads, bool writes, bool or_in,
                            Time now) noexcept {
  std::array<std::byte, kMostDatagramData> other;  // what came in, or what is to be OR-ed in
  const std::span<std::byte> came = std::span(other).first(data.size());
  if (reads && writes) std::ranges::copy(data, came.begin());
  bool has_read = false, has_written = false;
  if (reads && !or_in) has_read = read(address, data, now);
  if (reads && or_in) {
    std::array<std::byte, kMostDatagramData> own;
    std::fill_n(own.begin(), data.size(), std::byte{0});
    has_read = read(address, std::span(own).first(data.size()), now);
    for (std::size_t i = 0; i < data.size(); ++i) data[i] |= own[i];
  }
  if (writes) has_written = write(address, reads ? Bytes(came) : Bytes(data), std::byte{0xFF}, now);
  return (has_read ? 1u : 0u) + (has_written ? (reads ? 2u : 1u) : 0u);
}

unsigned EscState::serve(MutableDatagram& d, Time now) noexcept {
  if (d.raw_command() >= kCommands) return 0;
  const Meaning& meaning = kMeanings[d.raw_command()];
  const bool me = meant(*this, meaning.by, d);
  // Positions and the number of devices are counted in the ADP as the datagram passes.
  if (meaning.by == Addressing::kPosition || meaning.by == Addressing::kEverybody)
    d.set_adp(static_cast<std::uint16_t>(d.adp() + 1));
  if (meaning.by == Addressing::kLogical) {
    if (meaning.reads && meaning.writes && (settings.features & kFeatureNoLrw) != 0) return 0;
    return exchange_logical(d.address(), d.data(), meaning.reads, meaning.writes, now);
  }
  if (meaning.multiple) return exchange(d.ado(), d.data(), me, !me, false, now);
  if (!me) return 0;
  if (meaning.reads && meaning.writes && (settings.features & kFeatureNoReadWrite) != 0) return 0;
  return exchange(d.ado(), d.data(), meaning.reads, meaning.writes, meaning.by == Addressing::kEverybody, now);
}

void EscState::process(MutableDatagram& d, Time now) noexcept {
  if (const unsigned grown = serve(d, now); grown != 0)
    d.set_working_counter(static_cast<std::uint16_t>(d.working_counter() + grown));
  const std::uint16_t events = ecat_events() & u16(reg::kEcatEventMask);
  if (events != 0) d.set_irq(d.irq() | events);
}

}  // namespace meca::ethercat
