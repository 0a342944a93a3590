// AL states, AL status codes and SDO abort codes in words (ETG.1000.6, 5.3 and 5.6.2.7; ETG.1020). For people: what the
// device says, and for the codes that masters cause also what to do.
#pragma once

#include <cstdint>
#include <string_view>

#include "transports/ethercat/registers.hpp"

namespace meca::ethercat {

// "INIT", "PREOP", "BOOT", "SAFEOP", "OP"; of the low nibble, anything else: "an unknown state".
std::string_view al_state_name(std::uint16_t al_status) noexcept;

// "invalid output mapping: the PDO assignment does not give the length of the output sync manager"; without full stop.
// Codes that are not known: "not known".
std::string_view al_code_text(std::uint16_t code) noexcept;

// "object does not exist"; without full stop, "not known" for others.
std::string_view abort_text(std::uint32_t code) noexcept;

}  // namespace meca::ethercat
