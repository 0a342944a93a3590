// A robot that is up, activated, homed and standing still, for the tests of what meca-ctl shows.
#pragma once

#include <cstdint>

#include "cli/view.hpp"

namespace meca::cli {

inline meca500::Header good_header() {
  meca500::Header header;
  header.cycle(1000);
  header.robot_time_us(5'000'000);
  header.receive_time_ns(1'700'000'000'000'000'000);
  header.quality(meca500::Quality::GOOD);
  return header;
}

template <typename Sample>
Sample with_header() {
  Sample sample;
  sample.robot("arm1");
  sample.header(good_header());
  return sample;
}

inline meca500::TransportCounter counter(const char* name, std::int64_t value, const char* unit = "") {
  meca500::TransportCounter sample;
  sample.name(name);
  sample.value(value);
  sample.unit(unit);
  return sample;
}

inline RobotView standing_robot() {
  RobotView view;
  meca500::BridgeStatus bridge;
  bridge.robot("arm1");
  bridge.transport("builtin");
  bridge.link(meca500::LinkState::LINK_UP);
  bridge.firmware_known(true);
  bridge.firmware("11.3.0.1");
  bridge.layout("11.x");
  bridge.product("Meca500 R4");
  bridge.serial_number(4711);
  bridge.ready(true);
  bridge.cycle_us(1000);
  view.bridge = bridge;

  meca500::ControlStatus control;
  control.robot("arm1");
  control.lease_ms(100);
  view.control = control;

  view.robot_status = with_header<meca500::RobotStatus>();
  view.robot_status->activated(true);
  view.robot_status->homed(true);
  view.motion_status = with_header<meca500::MotionStatus>();
  view.motion_status->fifo_space(13000);
  view.motion_status->eob(true);
  view.motion_status->eom(true);
  view.joints = with_header<meca500::TargetJointSet>();
  view.joints->joints({-10, 0, 0.5F, 0, 0, 720.25F});
  view.pose = with_header<meca500::TargetEndEffectorPose>();
  view.pose->x(190);
  view.pose->z(308);
  view.pose->beta(90);
  view.configuration = with_header<meca500::TargetConfiguration>();
  view.configuration->shoulder(1);
  view.safety = with_header<meca500::SafetyStatus>();
  view.safety->known(true);
  view.safety->vmotor_on(true);
  return view;
}

}  // namespace meca::cli
