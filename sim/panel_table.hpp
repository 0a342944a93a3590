// The table of words behind panel.hpp, for its own files only: panel_robot.cpp, panel_network.cpp and one file for each
// fieldbus have the rows, panel.cpp reads lines by them.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "sim/panel.hpp"

namespace meca::sim {

struct Number {
  enum class Form : std::uint8_t {
    kReal,
    kWhole,
    kCode,     // whole, decimal or 0x...
    kAddress,  // A.B.C.D:PORT, as ipv4 * 65536 + port, which a double holds exactly
  };
  std::string_view name;
  double minimum, maximum;  // inclusive
  Form form = Form::kReal;
  double otherwise = std::numeric_limits<double>::quiet_NaN();  // when left out; NaN: it must be given
  bool optional() const { return !std::isnan(otherwise); }
};

struct Row {
  std::string_view words;
  std::span<const Number> numbers;
  std::string_view about;
  // One of the two, by what the word is about.
  void (*apply)(Robot&, const PanelRequest&, PanelAnswer&) noexcept;
  std::string (*check)(const PanelRequest&) = nullptr;  // a complaint beyond the ranges, or nothing
  void (*apply_to_network)(NetworkFaults&, const PanelRequest&, PanelAnswer&) noexcept = nullptr;
};

// A row about the network: its word only sets something, and says so.
using ApplyToNetwork = void (*)(NetworkFaults&, const PanelRequest&, PanelAnswer&) noexcept;
constexpr Row network_row(std::string_view words, std::span<const Number> numbers, std::string_view about,
                          ApplyToNetwork apply) {
  return {words, numbers, about, nullptr, nullptr, apply};
}

// A request's word is the number of its row, through these tables one after the other.
std::span<const Row> robot_rows() noexcept;
std::span<const Row> network_rows() noexcept;  // on any bus
std::span<const Row> ethernet_ip_rows() noexcept;
std::span<const Row> ethercat_rows() noexcept;

inline void done(PanelAnswer& answer, std::string_view sentence) noexcept {
  answer.kind = PanelAnswer::Kind::kDone;
  answer.sentence = sentence;
}
inline void refused(PanelAnswer& answer, std::string_view sentence) noexcept {
  answer.kind = PanelAnswer::Kind::kRefused;
  answer.sentence = sentence;
}

}  // namespace meca::sim
