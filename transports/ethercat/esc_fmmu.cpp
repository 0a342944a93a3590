// Logical addressing: each FMMU maps a run of bits of the logical address space to the memory, for reading, writing or
// both (ETG.1000.4, 6.6; ESC data sheet section II). What two FMMUs map to the same logical bytes is taken from the
// datagram as it came in, before inputs are put there: libethercat lays outputs over inputs.
#include "transports/ethercat/esc_state.hpp"

namespace meca::ethercat {
namespace {

// The part of a datagram that an FMMU maps, as logical bytes [from, to).
struct Overlap {
  std::uint64_t from = 0, to = 0;
  bool empty() const noexcept { return from >= to; }
};

Overlap overlap(const Fmmu& f, std::uint32_t address, std::size_t size) noexcept {
  return {std::max<std::uint64_t>(f.logical, address),
          std::min(std::uint64_t{f.logical} + f.length, std::uint64_t{address} + size)};
}

bool bit(std::byte b, unsigned n) noexcept { return (b >> n & std::byte{1}) != std::byte{0}; }

// Visits every byte of the memory of which bits lie in the datagram, as `byte(address, pairs)`; `pairs(visit)` calls
// visit(bit of that byte, byte of the datagram, bit of that byte).
template <class VisitByte>
void for_each_byte(const Fmmu& f, const Overlap& part, std::uint32_t address, VisitByte visit_byte) {
  const std::int64_t bits = std::int64_t{f.length - 1} * 8 + f.last_bit + 1 - f.first_bit;
  const auto run_bit = [&f](std::uint64_t logical_byte) {
    return static_cast<std::int64_t>(logical_byte - f.logical) * 8 - f.first_bit;
  };
  const std::int64_t from = std::max<std::int64_t>(0, run_bit(part.from)), to = std::min(bits, run_bit(part.to));
  if (from >= to) return;
  for (std::int64_t k = (f.physical_bit + from) / 8; k <= (f.physical_bit + to - 1) / 8; ++k) {
    visit_byte(static_cast<std::uint32_t>(f.physical + k), [&](auto visit_bit) {
      for (unsigned b = 0; b < 8; ++b) {
        const std::int64_t i = k * 8 + b - f.physical_bit;
        if (i < from || i >= to) continue;
        const std::uint64_t logical_bit = f.first_bit + static_cast<std::uint64_t>(i);
        visit_bit(b, static_cast<std::size_t>(f.logical - std::uint64_t{address} + logical_bit / 8),
                  static_cast<unsigned>(logical_bit % 8));
      }
    });
  }
}

bool read_bits(EscState& s, const Fmmu& f, const Overlap& part, std::uint32_t address, std::span<std::byte> data,
               Time now) noexcept {
  bool any = false;
  for_each_byte(f, part, address, [&](std::uint32_t physical, auto pairs) {
    std::byte value{};
    if (!s.read(physical, {&value, 1}, now)) return;
    any = true;
    pairs([&](unsigned from, std::size_t at, unsigned to) {
      const std::byte mask{static_cast<unsigned char>(1u << to)};
      data[at] = bit(value, from) ? data[at] | mask : data[at] & ~mask;
    });
  });
  return any;
}

bool write_bits(EscState& s, const Fmmu& f, const Overlap& part, std::uint32_t address, Bytes data, Time now) noexcept {
  bool any = false;
  for_each_byte(f, part, address, [&](std::uint32_t physical, auto pairs) {
    std::byte value{}, lanes{};
    pairs([&](unsigned to, std::size_t at, unsigned from) {
      const std::byte mask{static_cast<unsigned char>(1u << to)};
      lanes |= mask;
      if (bit(data[at], from)) value |= mask;
    });
    any |= s.write(physical, {&value, 1}, lanes, now);
  });
  return any;
}

}  // namespace

void EscState::decode_fmmu(unsigned n) noexcept {
  const std::uint16_t at = reg::fmmu(n);
  const std::uint8_t type = u8(at + 0xBu);
  fmmus[n] = {.active = (u8(at + 0xCu) & 1) != 0 && u16(at + 4u) != 0,
              .reads = (type & 1) != 0,
              .writes = (type & 2) != 0,
              .logical = u32(at),
              .length = u16(at + 4u),
              .first_bit = u8(at + 6u),
              .last_bit = u8(at + 7u),
              .physical = u16(at + 8u),
              .physical_bit = u8(at + 0xAu)};
}

unsigned EscState::exchange_logical(std::uint32_t address, std::span<std::byte> data, bool reads, bool writes,
                                    Time now) noexcept {
  bool has_read = false, has_written = false;
  const auto mapped = fmmus;  // as they were when the datagram came, though it may write to their own registers
  // Writing first takes the bytes as they came in. An FMMU of both types on plain RAM reads what it has just written;
  // a real ESC would exchange (inferred; no master does it).
  for (const Fmmu& f : mapped) {
    if (!writes || !f.active || !f.writes) continue;
    const Overlap part = overlap(f, address, data.size());
    if (part.empty()) continue;
    has_written |= f.whole_bytes() ? write(static_cast<std::uint32_t>(f.physical + (part.from - f.logical)),
                                           data.subspan(part.from - address, part.to - part.from), std::byte{0xFF}, now)
                                   : write_bits(*this, f, part, address, data, now);
  }
  for (const Fmmu& f : mapped) {
    if (!reads || !f.active || !f.reads) continue;
    const Overlap part = overlap(f, address, data.size());
    if (part.empty()) continue;
    has_read |= f.whole_bytes() ? read(static_cast<std::uint32_t>(f.physical + (part.from - f.logical)),
                                       data.subspan(part.from - address, part.to - part.from), now)
                                : read_bits(*this, f, part, address, data, now);
  }
  const unsigned grown = (has_read ? 1u : 0u) + (has_written ? (reads ? 2u : 1u) : 0u);
  if (grown == 0 || faults.working_counter == 0) return grown;
  // Modulo 2^16, as the counter itself: a fault may take away more than the device adds.
  return static_cast<unsigned>(static_cast<int>(grown) + faults.working_counter) & 0xFFFFu;
}

}  // namespace meca::ethercat
