// Work zone and collisions: what is in breach for one position of the arm, and the events that come of it.
//
// inferred: a robot looks where the arm would come to rest if it were held now, so with severity 4 it stops on its path
// before the breach. What only gets better is no event: an arm that stands in a breach can leave it once ResumeMotion
// has accepted how deep it is in.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "sim/configuration.hpp"
#include "sim/shape.hpp"

namespace meca::sim {

// As dynamic data 37 and 38 name them (spec 2.2).
struct Part {
  enum class Group : std::uint8_t { kRobot = 0, kFlange = 1, kTool = 2, kEnvironment = 3, kWorkZone = 4 };
  Group group = Group::kRobot;
  int id = 0;  // of the robot: 0 the base, 1..6 its links
  friend bool operator==(const Part&, const Part&) = default;
};

struct Breach {
  double depth = -std::numeric_limits<double>::infinity();  // mm; positive: in breach, negative: room left
  Part first, second;
};

// The deepest breach. Without a tool sphere, mode 2 looks at the flange centre (inferred). The base cannot move, so it
// is never outside (inferred).
Breach work_zone_breach(const WorkZone& zone, const ArmShape& arm) noexcept;

// Links with links that are not neighbours, the tool with everything up to link 4 (behind it only the wrist moves it),
// and an obstacle with all of them but the base.
Breach collision(const ArmShape& arm, const std::optional<Capsule>& obstacle) noexcept;

// One kind of event: arises when a breach gets deeper than accepted, and then stays until ResumeMotion, or (with
// severity 1) until there is no breach.
class Watch {
 public:
  // True in the moment the event arises.
  bool look(const Breach& breach, int level) noexcept;  // one of severity::
  void accept() noexcept;  // ResumeMotion clears collision and work zone events (manual, ResumeMotion)
  void restart() noexcept { *this = {}; }

  bool event() const noexcept { return event_; }
  const Breach& breach() const noexcept { return shown_; }  // while event()

 private:
  bool event_ = false;
  Breach last_, shown_;
  double accepted_ = 0;  // mm
};

class Zones {
 public:
  // `rest`: where the arm would come to rest. 0, or the error code of an event that has just arisen. Costs next to
  // nothing while nothing is configured or nothing changes.
  std::uint16_t watch(const Configuration& configuration, const Joints& rest) noexcept;
  static bool watching(const Configuration& c) noexcept {
    return c.work_zone.severity != severity::kSilent || c.collision_severity != severity::kSilent;
  }
  void accept() noexcept;
  void restart() noexcept;  // at activation, or with another configuration
  void place_obstacle(const std::optional<Capsule>& obstacle) noexcept;

  const Watch& collision_watch() const noexcept { return collision_; }
  const Watch& work_zone_watch() const noexcept { return work_zone_; }

 private:
  Watch collision_, work_zone_;
  std::optional<Capsule> obstacle_;
  Joints seen_{};
  bool stale_ = true;  // `seen_` was judged under other conditions
};

}  // namespace meca::sim
