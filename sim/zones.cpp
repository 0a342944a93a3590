#include "sim/zones.hpp"

#include <algorithm>
#include <utility>

#include "sim/error.hpp"

namespace meca::sim {
namespace {

using Group = Part::Group;

constexpr double kTolerance = 0.01;  // mm a path along the border may wander

void deepen(Breach& worst, double depth, const Part& first, const Part& second) noexcept {
  if (depth > worst.depth) worst = {depth, first, second};
}

// How far the capsule reaches out of the box.
double reach_out(const WorkZone& zone, const Capsule& c) noexcept {
  double out = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    out = std::max({out, zone.minimum[i] - std::min(c.a[i], c.b[i]) + c.radius,
                    std::max(c.a[i], c.b[i]) + c.radius - zone.maximum[i]});
  }
  return out;
}

// Links that can meet; what joint limits keep apart is not here.
constexpr std::pair<std::size_t, std::size_t> kMeet[] = {{0, 3}, {0, 4}, {0, 5}, {0, 6}, {1, 4},
                                                         {1, 5}, {1, 6}, {2, 5}, {2, 6}, {3, 6}};
constexpr std::size_t kLastLinkTheToolMeets = 4;

constexpr Part link(std::size_t i) noexcept { return {Group::kRobot, static_cast<int>(i)}; }

}  // namespace

Breach work_zone_breach(const WorkZone& zone, const ArmShape& arm) noexcept {
  constexpr Part kZone{Group::kWorkZone, 0};
  const bool has_tool = arm.tool.radius > 0;
  Breach out;
  if (zone.mode != WorkZone::Mode::kFlange && has_tool) deepen(out, reach_out(zone, arm.tool), {Group::kTool}, kZone);
  if (zone.mode == WorkZone::Mode::kToolAndLinks) {
    for (std::size_t i = 1; i < arm.links.size(); ++i) deepen(out, reach_out(zone, arm.links[i]), link(i), kZone);
  }
  if (zone.mode == WorkZone::Mode::kFlange || (zone.mode == WorkZone::Mode::kTool && !has_tool)) {
    deepen(out, reach_out(zone, {arm.flange, arm.flange, 0}), {Group::kFlange}, kZone);
  }
  return out;
}

Breach collision(const ArmShape& arm, const std::optional<Capsule>& obstacle) noexcept {
  constexpr Part kTool{Group::kTool}, kObstacle{Group::kEnvironment};
  Breach out;
  for (const auto& [i, j] : kMeet) deepen(out, -gap(arm.links[i], arm.links[j]), link(i), link(j));
  const bool has_tool = arm.tool.radius > 0;
  for (std::size_t i = 0; has_tool && i <= kLastLinkTheToolMeets; ++i) {
    deepen(out, -gap(arm.tool, arm.links[i]), kTool, link(i));
  }
  if (!obstacle) return out;
  for (std::size_t i = 1; i < arm.links.size(); ++i) deepen(out, -gap(*obstacle, arm.links[i]), link(i), kObstacle);
  if (has_tool) deepen(out, -gap(*obstacle, arm.tool), kTool, kObstacle);
  return out;
}

bool Watch::look(const Breach& breach, int level) noexcept {
  last_ = breach;
  const double depth = std::max(breach.depth, 0.0);
  if (depth <= accepted_ + kTolerance) {
    accepted_ = std::min(accepted_, depth);
    if (level == severity::kWarning && depth <= 0) event_ = false;
    return false;
  }
  shown_ = breach;
  return !std::exchange(event_, true);
}

void Watch::accept() noexcept {
  event_ = false;
  accepted_ = std::max(last_.depth - kTolerance, 0.0);  // else each time would let pass a little more
}

std::uint16_t Zones::watch(const Configuration& c, const Joints& rest) noexcept {
  if (!watching(c) || (rest == seen_ && !stale_)) return error::kNone;
  seen_ = rest;
  stale_ = false;
  const ArmShape arm = arm_shape(rest, c.tool_sphere);
  std::uint16_t code = error::kNone;
  if (c.work_zone.severity != severity::kSilent &&
      work_zone_.look(work_zone_breach(c.work_zone, arm), c.work_zone.severity) &&
      c.work_zone.severity == severity::kError) {
    code = error::kWorkZone;
  }
  if (c.collision_severity != severity::kSilent && collision_.look(collision(arm, obstacle_), c.collision_severity) &&
      c.collision_severity == severity::kError) {
    code = error::kCollision;  // the more serious one where both arise
  }
  return code;
}

void Zones::accept() noexcept {
  collision_.accept();
  work_zone_.accept();
}

void Zones::restart() noexcept {
  collision_.restart();
  work_zone_.restart();
  stale_ = true;
}

void Zones::place_obstacle(const std::optional<Capsule>& obstacle) noexcept {
  obstacle_ = obstacle;
  stale_ = true;
}

}  // namespace meca::sim
