// Velocity mode: MoveJointsVel, MoveLinVelWrf and MoveLinVelTrf. No errors at limits: the arm halts slightly before a
// joint limit, and before a singularity that it would have to cross (manual, MoveJointsVel and MoveLinVelWrf).
#pragma once

#include "sim/journal.hpp"
#include "sim/settings.hpp"

namespace meca::sim {

class VelocityMode {
 public:
  // A fresh command; its time-out starts anew.
  void command(const Command& command) noexcept;
  // Ramps down to rest; active() until then.
  void cancel() noexcept { cancelled_ = true; }
  // At once, without a ramp: motors off.
  void halt() noexcept;

  // Moves the joints by `seconds` (already time-scaled). Runs the time-out.
  void step(double seconds, const Settings& settings, const JointLimits& limits, bool recovery_mode,
            Joints& joints) noexcept;

  // Where the arm comes to rest if it is cancelled after one more step.
  Joints rest_ahead(double seconds, const Settings& settings, bool recovery_mode, const Joints& joints) const noexcept;

  bool active() const noexcept { return active_; }
  bool moving() const noexcept { return moving_; }
  bool accelerating() const noexcept { return accelerating_; }  // speeding up, slowing down or turning

 private:
  Command command_;
  bool active_ = false, cancelled_ = false, moving_ = false, accelerating_ = false;
  double age_ = 0;     // s since the last command
  Joints velocity_{};  // deg/s, now
  Joints change_{};    // deg/s, in the last step, before limits took some of it

  Joints slope(const Dynamics& d) const noexcept;
  Joints wanted(const Settings& settings, const Dynamics& d, const Joints& q) const noexcept;
};

}  // namespace meca::sim
