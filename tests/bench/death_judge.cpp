#include "tests/bench/death_judge.hpp"

#include <iterator>

namespace meca::bench {
namespace {

using Iterator = WireImages::const_iterator;

// The first image from `from` on that is as wanted; end() at a hole.
template <typename Wanted>
Iterator first(const WireImages& images, Iterator from, Wanted wanted) {
  for (auto at = from; at != images.end() && at->second.complete(); ++at) {
    if (at != from && at->first != std::prev(at)->first + 1) break;
    if (wanted(at->second)) return at;
  }
  return images.end();
}

std::string ms(std::int64_t ns) { return std::to_string(static_cast<double>(ns) / 1e6) + " ms"; }

}  // namespace

std::optional<StopFacts> judge_stop(const WireImages& images, std::int64_t renewal_ns, bool velocity,
                                    const DeathLimits& limits) {
  const auto renewed = at_time(images, renewal_ns);
  if (renewed == images.end() || !renewed->second.complete()) return std::nullopt;
  const auto stop = first(images, renewed, [](const WireImage& i) { return i.stops(); });
  if (stop == images.end()) return std::nullopt;
  const auto sent = std::next(stop);
  if (sent == images.end() || sent->first != stop->first + 1) return std::nullopt;

  StopFacts facts;
  facts.stop_cycle = stop->first;
  facts.cycles = static_cast<std::int64_t>(sent->first - renewed->first);
  facts.on_wire_ns = sent->second.time_ns;
  const auto most = limits.most_cycles(limits.lease_ns);
  if (facts.cycles > most) {
    facts.broken.push_back("stop image on the wire after " + std::to_string(facts.cycles) + " cycles, promised " +
                           std::to_string(most));
  }
  if (stop == renewed) {
    facts.broken.push_back("stopped in the cycle that took a sign of life");
    return facts;
  }
  const std::int64_t without = std::prev(stop)->second.time_ns - renewal_ns;
  if (without > limits.lease_ns + limits.cycle_ns) {
    facts.broken.push_back("a cycle ran " + ms(without) + " after the last sign of life and did not stop");
  }
  const std::int64_t waited = stop->second.time_ns - renewal_ns;
  if (waited < limits.lease_ns - limits.cycle_ns) {
    facts.broken.push_back("stopped " + ms(waited) + " after a sign of life, before the lease was over");
  }
  if (!velocity || !renewed->second.moves_by_velocity()) return facts;
  const auto zero = first(images, renewed, [](const WireImage& i) { return !i.moves_by_velocity() && !i.set_point; });
  facts.velocity_cycles = static_cast<std::int64_t>(zero->first + 1 - renewed->first);
  const auto most_velocity = limits.most_cycles(limits.velocity_lease_ns);
  if (*facts.velocity_cycles > most_velocity) {
    facts.broken.push_back("velocity zero on the wire after " + std::to_string(*facts.velocity_cycles) +
                           " cycles, promised " + std::to_string(most_velocity));
  }
  return facts;
}

std::optional<std::vector<std::string>> judge_quiet(const WireImages& images, std::uint64_t stop_cycle,
                                                    std::uint64_t resumed, std::uint64_t commanded) {
  std::vector<std::string> broken;
  const auto say = [&](std::uint64_t cycle, const char* what) {
    broken.push_back(std::string(what) + ", " + std::to_string(cycle - stop_cycle) + " cycles after the stop image");
  };
  for (std::uint64_t cycle = stop_cycle; cycle < commanded && broken.empty(); ++cycle) {
    const auto at = images.find(cycle);
    if (at == images.end() || !at->second.complete()) return std::nullopt;
    const WireImage& image = at->second;
    if (image.set_point) say(cycle, "SetPoint before the next owner's first command");
    if (image.moves_by_velocity()) say(cycle, "a velocity before the next owner's first command");
    if (cycle >= resumed) continue;
    if (!image.pause) say(cycle, "Pause dropped before the next owner resumed");
    if (image.resume) say(cycle, "Resume before the next owner resumed");
  }
  return broken;
}

}  // namespace meca::bench
