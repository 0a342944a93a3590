// Reads the state topics into one view per robot: what status, watch and health show.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "cli/bus.hpp"
#include "cli/view.hpp"

namespace meca::cli {

// What to read besides BridgeStatus and ControlStatus.
enum class Interest : std::uint8_t { kControl, kState };

// No bridge, or not the robot that was meant; what() is a letter to the user.
struct NoBridge : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Observer {
 public:
  Observer(Bus& bus, Interest interest);

  // Waits up to `timeout` for something to arrive, then takes everything that has. False: nothing came.
  bool pump(std::chrono::nanoseconds timeout);

  const Views& robots() const { return robots_; }

  // Waits until a robot shows up and for a moment more, so that those of a second bridge are in as well.
  // `wanted` not empty: returns as soon as that one is there. Throws NoBridge when the time is over.
  void discover(const std::string& wanted, std::chrono::nanoseconds timeout);

  // Waits until every section of that robot, or of all, has come; a bridge may have some switched off, so not for ever.
  void fill(const std::string& wanted, std::chrono::nanoseconds patience);

  // The robot meant by `wanted`, or the only one. Throws UsageError when there are
  // several, NoBridge when the one is not there; both name those there are.
  std::string choose(const std::string& wanted) const;

 private:
  template <typename Sample, typename Keep>
  void take_all(dds::Reader<Sample>& reader, Keep keep);

  Bus& bus_;
  Views robots_;
  dds::Reader<meca500::BridgeStatus> bridge_;
  dds::Reader<meca500::ControlStatus> control_;
  dds::Reader<meca500::RobotStatus> robot_status_;
  dds::Reader<meca500::MotionStatus> motion_status_;
  dds::Reader<meca500::TargetJointSet> joints_;
  dds::Reader<meca500::TargetEndEffectorPose> pose_;
  dds::Reader<meca500::TargetConfiguration> configuration_;
  dds::Reader<meca500::SafetyStatus> safety_;
  dds::Reader<meca500::DynamicData> dynamic_data_;
};

}  // namespace meca::cli
