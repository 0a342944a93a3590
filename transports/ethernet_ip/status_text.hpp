// What the status codes of EtherNet/IP mean to a person, and what to do: one table, and the sentence of a refused
// request made of it. No allocation.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "transports/ethernet_ip/cip.hpp"
#include "transports/text.hpp"

namespace meca::ethernet_ip {

// The part of a Forward Open that a status is about; named in the sentence with what was asked.
enum class Concern : std::uint8_t {
  kNothing,
  kRpi,
  kMultiplier,
  kOToTSize,  // the second extended word is the size the device wants
  kTToOSize,  // "
  kOToTType,
  kTToOType,
  kKey,
  kPath,
  kTriad,
};

struct StatusText {
  std::uint16_t code = 0;
  Concern concern = Concern::kNothing;
  std::string_view meaning;  // a clause without full stop, of the device that answered ("the robot ...")
  std::string_view remedy;   // empty: nothing that a person could do
};

// General status: CIP Vol 1, appendix B. Extended status: of the Connection Manager, behind general status 0x01. In the
// order of their codes.
std::span<const StatusText> general_status_texts() noexcept;
std::span<const StatusText> extended_status_texts() noexcept;
// nullptr: a status that no document of ours names.
const StatusText* find_general_status(std::uint8_t general) noexcept;
const StatusText* find_extended_status(std::uint16_t extended) noexcept;

// "Forward Open refused (0x01/0x0127 0x0042): O->T size 64 asked, the robot expects 66; <meaning>; <remedy>".
// `asked`: with its path; nullptr for other requests. `robot`: its identity, where it is known.
using RefusalText = FixedText<191>;
RefusalText refusal_text(std::string_view request, const Reply& reply, const ForwardOpen* asked = nullptr,
                         const std::optional<Identity>& robot = std::nullopt) noexcept;

// "192.168.0.100"; host byte order.
FixedText<15> dotted(std::uint32_t ipv4) noexcept;

}  // namespace meca::ethernet_ip
