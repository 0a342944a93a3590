// Turns one motion command into a segment that can be followed in time, or says with the robot's error code why not.
// Nothing here keeps state or allocates.
#pragma once

#include <array>
#include <cstdint>

#include "sim/inverse.hpp"
#include "sim/kinematics.hpp"
#include "sim/profile.hpp"
#include "sim/settings.hpp"

namespace meca::sim {

// Where a move starts and under which rules.
struct Situation {
  Joints start;
  JointLimits limits;
  bool recovery_mode = false;
};

class Segment {
 public:
  enum class Kind : std::uint8_t { kJoints, kLinear, kDelay };

  Kind kind() const noexcept { return kind_; }
  const Joints& start() const noexcept { return start_; }
  const Joints& end() const noexcept { return end_; }
  double duration() const noexcept { return kind_ == Kind::kDelay ? delay_ : profile_.duration(); }  // s
  double ramp() const noexcept { return kind_ == Kind::kDelay ? 0 : profile_.ramp(); }               // s
  const Profile& profile() const noexcept { return profile_; }

  // The joints at `seconds` since the start. Joint 6 of a linear segment keeps its turn from call to call, so time must
  // not jump back.
  Joints at(double seconds) noexcept;

 private:
  friend class Planner;
  Kind kind_ = Kind::kDelay;
  Joints start_{}, end_{};
  Profile profile_;
  double delay_ = 0;
  // Linear only: the tool in the base frame at the start, and how it moves.
  Transform tool_start_, tool_inverse_;
  Vec3 travel_{};
  AxisAngle turn_{};
  Joints last_{};
  // The posture from a position on: the first from the start; the others where the line leaves a singularity it started
  // in, or goes exactly through one.
  struct Stretch {
    double from = 0;
    Posture posture;
  };
  std::array<Stretch, 3> stretches_{};
  std::size_t stretch_count_ = 0;

  Transform flange_at(double position) const noexcept;
  bool joints_at(double position, const Posture& posture, const Joints& previous, Joints& out) const noexcept;
  Posture nearest_posture(double position, const Posture& posture, const Joints& previous) const noexcept;
  bool change_posture(double before, double after, const Posture& now, const Posture& next,
                      const Joints& previous) noexcept;
};

class Planner {
 public:
  Planner(const Settings& settings, const Situation& situation) noexcept
      : settings_(settings), situation_(situation), dynamics_(dynamics(settings, situation.recovery_mode)) {}

  // Plans commands 1..6 and 29. 0, or an error code; the segment is then not to be used.
  std::uint16_t plan(const Command& command, Segment& segment) const noexcept;

  // The joint set MovePose goes to: of all that reach the pose, that keep SetConf and SetConfTurn and the limits, the
  // one reached soonest.
  std::uint16_t choose_joints(const Transform& flange, Joints& out) const noexcept;

 private:
  const Settings& settings_;
  const Situation& situation_;
  Dynamics dynamics_;

  std::uint16_t plan_joints(const Joints& target, Segment& segment) const noexcept;
  std::uint16_t plan_linear(const Transform& tool_target, Segment& segment) const noexcept;
  // Walks the line from end to end; the shortest time the joints allow comes out in `cruise`.
  std::uint16_t walk(Segment& segment, double& cruise, int samples) const noexcept;
  std::uint16_t walk_to(Segment& segment, double before, double after, int steps, Joints& q,
                        double& cruise) const noexcept;
  // The profile of a move that could be done in `cruise` at full speed; in time-based mode it lasts SetMoveDuration.
  std::uint16_t give_time(double cruise, double ramp, Segment& segment) const noexcept;
  bool start_is_in_conf() const noexcept;
  double joint_time(const Joints& target) const noexcept;
};

}  // namespace meca::sim
