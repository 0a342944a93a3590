#include "cli/bus_text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string_view>
#include <utility>

#include "transports/ethercat/al_status.hpp"

namespace meca::cli {
namespace {

using Counter = meca500::TransportCounter;
using Words = std::pair<std::string_view, std::string_view>;

// Endings of the names of figures that belong together, and how they are shown.
constexpr std::array<Words, 6> kFigures{{{"_p50", "p50"},
                                         {"_p99", "p99"},
                                         {"_p999", "p99.9"},
                                         {"_mean", "mean"},
                                         {"_deviation", "deviation"},
                                         {"_max", "max"}}};

// Names that read badly with blanks for underscores.
constexpr std::array<Words, 4> kNames{{{"wake_up", "wake-up"},
                                       {"dc_difference", "DC difference"},
                                       {"api_o_to_t", "API O->T"},
                                       {"api_t_to_o", "API T->O"}}};

std::string in_words(std::string_view name) {
  const auto* const known = std::ranges::find(kNames, name, &Words::first);
  if (known != kNames.end()) return std::string(known->second);
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

struct Figure {
  std::string_view of;    // "round_trip"
  std::string_view what;  // "p99"; empty: no figure of a family
};

Figure figure(const Counter& counter) {
  const std::string_view name = counter.name().c_str();
  for (const auto& [ending, what] : kFigures) {
    if (name.ends_with(ending)) return {name.substr(0, name.size() - ending.size()), what};
  }
  return {name, {}};
}

void append(std::string& text, std::string_view separator, const std::string& more) {
  if (!text.empty() && !more.empty()) text += separator;
  text += more;
}

std::string with_unit(const Counter& counter) {
  const std::string unit = counter.unit().c_str();
  return std::to_string(counter.value()) + (unit.empty() ? "" : " " + unit);
}

std::string hex(std::int64_t code) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "0x%04llX", static_cast<unsigned long long>(code));
  return text.data();
}

// What is no number to a person; empty: is one.
std::string state_text(std::string_view name, std::int64_t value) {
  const auto code = static_cast<std::uint16_t>(value);
  if (name == "al_state") {
    return std::string(ethercat::al_state_name(code)) + ((code & ethercat::kAlError) != 0 ? " with an error" : "");
  }
  if (name == "al_status_code") return "AL status " + hex(value) + ", " + std::string(ethercat::al_code_text(code));
  if (name == "emergency_code") return "last emergency " + hex(value);
  if (name == "ring_open") return "ring open";
  return {};
}

std::string family_text(std::span<const Counter> family) {
  if (std::ranges::all_of(family, [](const Counter& c) { return c.value() == 0; })) return {};
  std::string text;
  for (const Counter& counter : family) {
    const std::string value = text.empty() ? with_unit(counter) : std::to_string(counter.value());
    append(text, ", ", value + " (" + std::string(figure(counter).what) + ")");
  }
  return in_words(figure(family.front()).of) + ' ' + text;
}

}  // namespace

std::string bus_counts_text(const meca500::BridgeStatus& status) {
  std::string states, counts;
  for (const Counter& counter : status.transport_counters()) {
    if (counter.value() == 0 || !figure(counter).what.empty()) continue;
    const std::string name = counter.name().c_str();
    const std::string state = state_text(name, counter.value());
    append(states, "; ", state);
    if (state.empty()) append(counts, ", ", in_words(name) + ' ' + with_unit(counter));
  }
  append(states, "; ", counts);
  return states;
}

std::string bus_timing_text(const meca500::BridgeStatus& status) {
  const std::span<const Counter> all = status.transport_counters();
  const auto same_family = [](const Counter& a, const Counter& b) {
    return figure(a).of == figure(b).of && a.unit() == b.unit();
  };
  std::string text;
  for (std::size_t first = 0, size = 1; first < all.size(); first += size, size = 1) {
    if (figure(all[first]).what.empty()) continue;
    while (first + size < all.size() && same_family(all[first], all[first + size])) ++size;
    append(text, "; ", family_text(all.subspan(first, size)));
  }
  return text;
}

}  // namespace meca::cli
