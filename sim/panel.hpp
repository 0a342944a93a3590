// What a person or a test says to a simulated robot, and what comes back: one line of words, a request that may cross
// to the thread that steps the robot, an answer that may cross back, text again. A new word is one row of a table: in
// panel_robot.cpp what concerns the robot, in panel_network.cpp what concerns the network between it and its host, in
// panel_ethernet_ip.cpp and panel_ethercat.cpp what there is on that bus only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "sim/network_faults.hpp"
#include "sim/robot.hpp"

namespace meca::sim {

struct PanelRequest {
  static constexpr std::size_t kMostNumbers = 8;
  std::uint8_t word = 0;  // row of the table
  std::array<double, kMostNumbers> numbers{};
};

// The request, or a sentence without full stop that says what is wrong and what instead. Capitals, and how many blanks
// stand between words, do not matter.
std::variant<PanelRequest, std::string> parse_panel_line(std::string_view line);

// Why these words are none on this bus, without full stop; empty where they are.
std::string_view misplaced(const PanelRequest& request, Fieldbus bus) noexcept;

// Facts as of the robot's last step; stops and the two modes as of now.
struct PanelStatus {
  StopSignals stops{};
  bool present = true, monitoring = false, activated = false, homed = false;
  std::uint16_t error = 0;
  std::uint16_t queued = 0;  // commands waiting in the motion queue
  std::uint64_t executed = 0, discarded = 0, refused = 0;
  std::uint64_t violations = 0;
};

struct PanelAnswer {
  enum class Kind : std::uint8_t { kDone, kRefused, kStatus, kJournal, kViolations, kHelp, kFaults };
  static constexpr std::size_t kMostListed = 64;
  Kind kind = Kind::kDone;
  std::string_view sentence;  // kDone, kRefused: static text without full stop
  PanelStatus status;         // kStatus
  std::uint64_t total = 0;    // kJournal, kViolations: ever; the `listed` last of them follow, oldest first
  std::size_t listed = 0;
  std::array<JournalEntry, kMostListed> commands{};
  std::array<Violation, kMostListed> violations{};
  NetworkFaults faults;  // kFaults
};

// Does what is asked. Only the thread that steps the robot may call it; does not allocate, lock or throw. `network`:
// nullptr when there is none between this robot and its host, and its words are refused, as are those of another bus.
void apply(const PanelRequest& request, Robot& robot, NetworkFaults* network, PanelAnswer& answer) noexcept;

// "ok: ..." or "error: ...", then the lines of a list, two blanks before each. Every line ends with '\n', none is
// empty.
std::string to_text(const PanelAnswer& answer);
std::string panel_error(std::string_view sentence);  // "error: ..." in the same form

// The words, one a line: "press e-stop        the emergency stop ...".
std::string panel_help();

}  // namespace meca::sim
