#include "sim/safety.hpp"

namespace meca::sim {

void Safety::reset_resettable() noexcept {
  if (p_stop2_ == Stop::kResettable) p_stop2_ = Stop::kReset;
  if (connection_ == Stop::kResettable) connection_ = Stop::kReset;
}

bool Safety::present() const noexcept {
  return !motors_allowed() || p_stop2_ == Stop::kPresent || connection_ == Stop::kPresent;
}

bool Safety::stops_motion() const noexcept {
  return !motors_allowed() || p_stop2_ != Stop::kReset || connection_ != Stop::kReset;
}

bool Safety::clears_motion() const noexcept {
  // inferred: a dropped connection clears like a P-Stop 2 does by default.
  return (p_stop2_ != Stop::kReset && p_stop2_severity_ == StopSeverity::kClear) || connection_ != Stop::kReset;
}

void Safety::report(image::Layout layout, image::Inputs& inputs) const noexcept {
  const bool e_stop_reported = product_ == Product::kMeca500R4;
  const auto on = [](Stop s) { return s != Stop::kReset; };
  const auto resettable = [](Stop s) { return s == Stop::kResettable; };
  inputs.robot_status.e_stop = e_stop_reported && on(e_stop_);
  inputs.motion_status.p_stop2 = on(p_stop2_);
  inputs.motion_status.p_stop2_resettable = layout == image::Layout::kFirmware9 && resettable(p_stop2_);

  image::SafetyStatus& out = inputs.safety_status;
  out = {};
  if (layout == image::Layout::kFirmware9) return;  // no safety section; known stays false
  out.known = true;
  out.stop.e_stop = e_stop_reported && on(e_stop_);
  out.stop.p_stop2 = on(p_stop2_);
  out.stop.connection_dropped = on(connection_);
  out.stop.reboot = on(reboot_);
  out.resettable.e_stop = e_stop_reported && resettable(e_stop_);
  out.resettable.p_stop2 = resettable(p_stop2_);
  out.resettable.connection_dropped = resettable(connection_);
  out.resettable.reboot = resettable(reboot_);
  out.reset_ready = e_stop_reported && e_stop_ != Stop::kPresent && (resettable(e_stop_) || resettable(reboot_));
  // inferred: the motors' supply, which is there unless an E-Stop or the Reboot stop took it, activated or not.
  out.vmotor_on = motors_allowed();
}

}  // namespace meca::sim
