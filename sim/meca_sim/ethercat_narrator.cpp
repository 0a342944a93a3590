#include "sim/meca_sim/ethercat_narrator.hpp"

#include <array>
#include <cstdio>

#include "transports/ethercat/al_status.hpp"

namespace meca::sim {
namespace {

using ethercat::AlState;

constexpr auto kOperational = static_cast<std::uint16_t>(AlState::kOp);

std::uint16_t al_code(const ethercat::Esc& esc) {
  const unsigned low = esc.peek(ethercat::reg::kAlStatusCode), high = esc.peek(ethercat::reg::kAlStatusCode + 1);
  return static_cast<std::uint16_t>(low | high << 8);
}

std::string in_hex(std::uint16_t code) {
  std::array<char, 8> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), "0x%04X", unsigned{code});
  return {buffer.data(), static_cast<std::size_t>(length)};
}

}  // namespace

// The steps of the way up are not told: they are many, and only OP or an error is worth a look.
void EthercatNarrator::look_at_connection() {
  const ethercat::Esc& esc = robot_.device().esc();
  const std::uint16_t now = esc.al_status(), before = std::exchange(al_status_, now);
  // A robot without power is in INIT, whatever it was in before; that it is away was said.
  if (now != before && robot_.powered()) {
    const std::string name(ethercat::al_state_name(now));
    if ((now & ethercat::kAlError) != 0) {
      const std::uint16_t code = al_code(esc);
      say_(Level::kWarning,
           "in " + name + " with error " + in_hex(code) + ": " + std::string(ethercat::al_code_text(code)));
    } else if (now == kOperational) {
      ++operational_;
      say_(Level::kInfo, "the master brought it to OP: outputs are applied");
    } else if (before == kOperational) {
      say_(Level::kInfo, "it left OP and is in " + name);
    }
  }
  const ethercat::DeviceCounters& counters = robot_.device().counters();
  if (std::exchange(aborts_, counters.aborts) == 0 && counters.aborts != 0) {
    say_(Level::kInfo, "an SDO was aborted; more are only counted");
  }
  if (std::exchange(strict_, counters.strict) == 0 && counters.strict != 0) {
    say_(Level::kWarning,
         "the master did what a careful one does not (transports/ethercat/README.md lists it); more is only counted");
  }
}

std::string EthercatNarrator::connection_summary() const {
  const ethercat::DeviceCounters& c = robot_.device().counters();
  const auto part = [](const char* what, std::uint64_t count) { return what + std::to_string(count); };
  return part("OP reached: ", operational_) + part("; output images: ", c.outputs) +
         part("; expired watchdogs: ", c.watchdog_expiries) + part("; sync errors: ", c.sync_errors) +
         part("; refused states: ", c.refused_states) + part("; mails: ", c.mails) +
         part(", of them twice: ", c.duplicate_mails) + part("; aborted SDOs: ", c.aborts) +
         part("; careless acts of the master: ", c.strict);
}

}  // namespace meca::sim
