// The memory as ECAT sees it: registers, and process RAM of which enabled sync managers guard parts.
#include "transports/ethercat/esc_state.hpp"

namespace meca::ethercat {
namespace {

constexpr unsigned kNobody = Esc::kSyncManagers;

// The run of bytes from `address` on that one sync manager guards, or nobody does. Of two, the lower one.
struct Piece {
  unsigned sync_manager = kNobody;
  std::uint32_t end = 0;
};

Piece piece_at(const EscState& s, std::uint32_t address, std::uint32_t end) noexcept {
  for (unsigned n = 0; n < s.sync_managers.size(); ++n) {
    const SyncManagerChannel& sm = s.sync_managers[n];
    if (!sm.guards()) continue;
    if (address >= sm.start && address < sm.end) return {n, std::min(end, sm.end)};
    if (address < sm.start) end = std::min(end, sm.start);
  }
  return {kNobody, end};
}

// Calls registers(address, offset, size), guarded(n, ..) and free(..) for the pieces of an access.
template <class Registers, class Guarded, class Free>
bool for_each_piece(const EscState& s, std::uint32_t address, std::size_t size, Registers registers, Guarded guarded,
                    Free unguarded) {
  const auto last = static_cast<std::uint32_t>(std::min<std::uint64_t>(std::uint64_t{address} + size, Esc::kMemory));
  bool any = false;
  for (std::uint32_t at = address; at < last;) {
    const std::size_t offset = at - address;
    if (at < esc::kRegisters) {
      const std::uint32_t end = std::min(last, esc::kRegisters);
      registers(at, offset, end - at);
      any = true;
      at = end;
      continue;
    }
    const Piece piece = piece_at(s, at, last);
    if (piece.sync_manager == kNobody) {
      unguarded(at, offset, piece.end - at);
      any = true;
    } else {
      any |= guarded(piece.sync_manager, at, offset, piece.end - at);
    }
    at = piece.end;
  }
  return any;
}

}  // namespace

bool EscState::read(std::uint32_t address, std::span<std::byte> out, Time now) noexcept {
  return for_each_piece(
      *this, address, out.size(),
      [&](std::uint32_t at, std::size_t offset, std::size_t size) {
        refresh_registers(at, size, now);
        std::copy_n(memory.begin() + at, size, out.begin() + static_cast<std::ptrdiff_t>(offset));
        registers_were_read(at, size);
      },
      [&](unsigned n, std::uint32_t at, std::size_t offset, std::size_t size) {
        return read_guarded(n, at, out.subspan(offset, size));
      },
      [&](std::uint32_t at, std::size_t offset, std::size_t size) {
        std::copy_n(memory.begin() + at, size, out.begin() + static_cast<std::ptrdiff_t>(offset));
      });
}

bool EscState::write(std::uint32_t address, Bytes in, std::byte lanes, Time now) noexcept {
  return for_each_piece(
      *this, address, in.size(),
      [&](std::uint32_t at, std::size_t offset, std::size_t size) {
        write_registers(at, in.subspan(offset, size), lanes, now);
      },
      [&](unsigned n, std::uint32_t at, std::size_t offset, std::size_t size) {
        return write_guarded(n, at, in.subspan(offset, size), lanes, now);
      },
      [&](std::uint32_t at, std::size_t offset, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) memory[at + i] = (memory[at + i] & ~lanes) | (in[offset + i] & lanes);
      });
}

}  // namespace meca::ethercat
