#include "cli/observer.hpp"

#include <algorithm>

#include "cli/plan.hpp"

namespace meca::cli {
namespace {

using namespace std::chrono_literals;

// Discovery of a second bridge may lag behind the first by an announcement.
constexpr auto kSettle = 250ms;
constexpr auto kGlance = 20ms;
constexpr int kBurst = 64;  // samples kept between two pumps, so that rates are counted right

std::string names_of(const Views& robots) {
  std::string names;
  for (const auto& [name, view] : robots) names += (names.empty() ? "" : ", ") + name;
  return names;
}

bool is_complete(const RobotView& view) {
  return view.bridge && view.control && view.robot_status && view.motion_status && view.joints && view.pose &&
         view.configuration && view.safety;
}

}  // namespace

Observer::Observer(Bus& bus, Interest interest) : bus_(bus) {
  bridge_ = bus.latest<meca500::BridgeStatus>("BridgeStatus");
  control_ = bus.latest<meca500::ControlStatus>("ControlStatus");
  if (interest == Interest::kControl) return;
  robot_status_ = bus.latest<meca500::RobotStatus>("RobotStatus");
  motion_status_ = bus.latest<meca500::MotionStatus>("MotionStatus");
  joints_ = bus.latest<meca500::TargetJointSet>("TargetJointSet", kBurst);
  pose_ = bus.latest<meca500::TargetEndEffectorPose>("TargetEndEffectorPose");
  configuration_ = bus.latest<meca500::TargetConfiguration>("TargetConfiguration");
  safety_ = bus.latest<meca500::SafetyStatus>("SafetyStatus");
  dynamic_data_ = bus.latest<meca500::DynamicData>("DynamicData", kBurst);
}

template <typename Sample, typename Keep>
void Observer::take_all(dds::Reader<Sample>& reader, Keep keep) {
  if (!reader) return;
  Sample sample;
  dds::SampleInfo info;
  while (reader.take(sample, info)) {
    if (info.valid_data) keep(robots_[sample.robot().c_str()], sample, info);
  }
}

bool Observer::pump(std::chrono::nanoseconds timeout) {
  const bool arrived = bus_.wait(timeout);
  const auto now = Clock::now();
  take_all(bridge_, [](RobotView& view, auto& sample, auto& info) {
    view.bridge = sample;
    view.bridge_writer = info.participant;
    ++view.bridge_samples;
  });
  take_all(control_, [](RobotView& view, auto& sample, auto&) { view.control = sample; });
  take_all(robot_status_, [](RobotView& view, auto& sample, auto&) { view.robot_status = sample; });
  take_all(motion_status_, [](RobotView& view, auto& sample, auto&) { view.motion_status = sample; });
  take_all(joints_, [now](RobotView& view, auto& sample, auto&) {
    view.joints = sample;
    view.joints_arrived = now;
    ++view.joint_samples;
  });
  take_all(pose_, [](RobotView& view, auto& sample, auto&) { view.pose = sample; });
  take_all(configuration_, [](RobotView& view, auto& sample, auto&) { view.configuration = sample; });
  take_all(safety_, [](RobotView& view, auto& sample, auto&) { view.safety = sample; });
  take_all(dynamic_data_, [](RobotView& view, auto& sample, auto&) { view.dynamic_data[sample.type_id()] = sample; });
  return arrived;
}

void Observer::discover(const std::string& wanted, std::chrono::nanoseconds timeout) {
  const auto start = Clock::now();
  auto last_new = start;
  std::size_t known = robots_.size();
  while (!interrupted) {
    if (!wanted.empty() && robots_.contains(wanted)) return;
    const auto now = Clock::now();
    if (robots_.size() != known) {
      known = robots_.size();
      last_new = now;
    }
    if (wanted.empty() && known != 0 && now - last_new >= kSettle) return;
    if (now - start >= timeout) break;
    pump(kGlance);
  }
  if (interrupted || (wanted.empty() && !robots_.empty())) return;
  if (!robots_.empty()) choose(wanted);  // throws: others are there, but not this one
  throw NoBridge("no bridge found on " + bus_.where() +
                 ". Is meca-bridge running, in the same domain (--domain) and with the same topic prefix (--prefix)? "
                 "Is this its network? A bridge in a container or a network namespace is asked from in there: 'docker "
                 "compose exec bridge meca-ctl', and './meca ctl' while './meca run ethercat' runs. Does its "
                 "configuration say dds.shared_memory: true? Then both share /dev/shm, as the same user, or neither "
                 "uses it.");
}

void Observer::fill(const std::string& wanted, std::chrono::nanoseconds patience) {
  const auto start = Clock::now();
  const auto complete = [&] {
    return std::ranges::all_of(robots_, [&](const auto& robot) {
      return (!wanted.empty() && robot.first != wanted) || is_complete(robot.second);
    });
  };
  while (!interrupted && !complete() && Clock::now() - start < patience) pump(kGlance);
}

std::string Observer::choose(const std::string& wanted) const {
  if (!wanted.empty() && robots_.contains(wanted)) return wanted;
  const std::string names = names_of(robots_);
  if (!wanted.empty()) {
    throw NoBridge("no robot '" + wanted + "' on " + bus_.where() + "; there " +
                   (robots_.size() == 1 ? "is " : "are ") + names);
  }
  if (robots_.size() != 1) throw UsageError("there are several robots, " + names + ": say which with --robot NAME");
  return robots_.begin()->first;
}

}  // namespace meca::cli
