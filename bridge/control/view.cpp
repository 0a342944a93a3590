#include "bridge/control/view.hpp"

namespace meca::control {

bool safety_stop(const image::Inputs& in) noexcept {
  if (in.robot_status.e_stop || in.motion_status.p_stop2) return true;
  return in.safety_status.known && in.safety_status.stop != image::StopSignals{};
}

bool unresettable_stop(const image::Inputs& in, image::Layout layout) noexcept {
  if (in.robot_status.e_stop) return true;
  if (layout == image::Layout::kFirmware9) return in.motion_status.p_stop2 && !in.motion_status.p_stop2_resettable;
  const image::StopSignals& s = in.safety_status.stop;
  const image::StopSignals& r = in.safety_status.resettable;
  const auto stuck = [](bool stop, bool resettable) { return stop && !resettable; };
  return s.e_stop || s.reboot || stuck(s.p_stop1, r.p_stop1) || stuck(s.p_stop2, r.p_stop2) ||
         stuck(s.operation_mode_change, r.operation_mode_change) ||
         stuck(s.enabling_device_released, r.enabling_device_released) ||
         stuck(s.voltage_fluctuation, r.voltage_fluctuation) || stuck(s.redundancy_fault, r.redundancy_fault) ||
         stuck(s.standstill_fault, r.standstill_fault) || stuck(s.connection_dropped, r.connection_dropped) ||
         stuck(s.minor_error, r.minor_error);
}

}  // namespace meca::control
