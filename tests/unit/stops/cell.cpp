#include "tests/unit/stops/cell.hpp"

#include <algorithm>
#include <cmath>

#include "bridge/diagnosis.hpp"
#include "bridge/mapping.hpp"
#include "cli/format.hpp"
#include "cli/plan.hpp"

namespace meca::test {
namespace {

constexpr const char* kRobot = "arm1";

template <typename Section, typename Sample>
std::optional<Sample> sample_of(const bridge::CycleRecord& record, const Section& section) {
  Sample sample;
  sample.robot(kRobot);
  bridge::fill_header(record, sample.header());
  bridge::fill(section, sample);
  return sample;
}

}  // namespace

Cell::Cell(const CycleSettings& s, const sim::RobotOptions& o) : Bench(s, o.layout), options(o), model(o) {
  sim = &model;
}

cli::RobotView Cell::view() const {
  const bridge::CycleRecord& record = result->record;
  const image::Inputs& in = record.inputs;
  cli::RobotView view;
  view.bridge.emplace();
  view.bridge->robot(kRobot);
  bridge::fill(record, bridge::diagnose(record), {.transport = "builtin", .cycle = settings.cycle, .unix_ns = unix_ns},
               *view.bridge);
  view.control.emplace();
  view.control->robot(kRobot);
  bridge::fill(record.control, *view.control);
  view.robot_status = sample_of<image::RobotStatus, meca500::RobotStatus>(record, in.robot_status);
  view.motion_status = sample_of<image::MotionStatus, meca500::MotionStatus>(record, in.motion_status);
  view.joints = sample_of<image::TargetJointSet, meca500::TargetJointSet>(record, in.target_joint_set);
  view.pose = sample_of<image::Pose, meca500::TargetEndEffectorPose>(record, in.target_end_effector_pose);
  view.safety = sample_of<image::SafetyStatus, meca500::SafetyStatus>(record, in.safety_status);
  return view;
}

std::string Cell::status() const { return cli::status_text(kRobot, view(), unix_ns); }

std::string Cell::why_not_ready() const {
  const std::string text = status(), label = "\n  Ready    ";
  const auto begin = text.find(label);
  if (begin == std::string::npos) return "";
  const auto start = begin + label.size();
  return text.substr(start, text.find('\n', start) - start);
}

bool Cell::ready() const { return why_not_ready() == "yes"; }

// ---------------------------------------------------------------- what is typed

CommandRequest Cell::typed(std::string_view verb, const ClientName& who, const ParticipantId& from) {
  const auto verbs = cli::action_verbs();
  const auto found = std::ranges::find(verbs, verb, &cli::ActionVerb::name);
  if (found == verbs.end()) {
    ADD_FAILURE() << "there is no 'meca-ctl " << verb << "'";
    return {};
  }
  const cli::CommandPlan plan = cli::plan_action(*found, "");
  meca500::Command sample;
  sample.robot(kRobot);
  sample.client(std::string(who.view()).c_str());
  sample.command_id(++last_id);
  sample.kind(plan.kind);
  sample.on_loss(meca500::LossPolicy::FINISH_MOTION);
  return std::get<CommandRequest>(bridge::to_request(sample, from));
}

Receipt Cell::answer(const CommandRequest& request, bool renews) {
  send(request);
  std::uint64_t renewal = 0;
  for (int i = 0; i < 60'000 && !terminal(request.command_id); ++i) {
    if (renews) pending.push_back(LeaseRenewal{request.client, request.participant, ++renewal});
    step();
  }
  return last(request.command_id);
}

Receipt Cell::meca_ctl(std::string_view verb) {
  const ClientName who("meca-ctl@bench:" + std::to_string(++calls_));
  const ParticipantId from = participant(100 + calls_);
  const Receipt receipt = answer(typed(verb, who, from), true);
  answer(typed("release", who, from), true);
  return receipt;
}

Receipt Cell::owner_does(std::string_view verb) { return answer(typed(verb, client, participant(1)), false); }

bool Cell::a_command_moves_the_arm() {
  const ControlState& control = result->record.control;
  const bool owners = control.owned && control.owner == client;
  const float from = joint1();
  const float to = from + (from > 0 ? -7.0F : 7.0F);
  CommandRequest request = motion(image::kMoveJoints, {to}, true);
  request.argument_count = 6;
  const auto& joints = result->record.inputs.target_joint_set.joints;
  std::copy(joints.begin() + 1, joints.end(), request.arguments.begin() + 1);
  if (!owners) {
    request.client = ClientName("meca-ctl@bench:" + std::to_string(++calls_));
    request.participant = participant(100 + calls_);
  }
  const Receipt receipt = answer(request, !owners);
  EXPECT_EQ(static_cast<int>(receipt.state), static_cast<int>(ReceiptState::kCompleted)) << describe(receipt);
  return std::abs(joint1() - to) < 1e-3F;
}

// ---------------------------------------------------------------- what hands and programs do

void Cell::make_ready() {
  connect();
  for (const char* verb : {"activate", "home"}) {
    const Receipt receipt = meca_ctl(verb);
    ASSERT_EQ(static_cast<int>(receipt.state), static_cast<int>(ReceiptState::kCompleted)) << describe(receipt);
  }
  ASSERT_TRUE(ready()) << status();
}

void Cell::owner_moves(double q1) {
  move(q1);
  steps(200);
  ASSERT_GT(joint1(), 1) << "the arm is not under way";
  ASSERT_LT(joint1(), q1 - 1) << "the arm is there already";
}

void Cell::cut_link(std::string_view detail) {
  link_up = false;
  exchange.link_detail = detail;
  steps(10);
}

void Cell::power_off(std::string_view detail) {
  cut_link(detail);
  model = sim::Robot(options);
}

void Cell::lose_images(int cycles) {
  for (int i = 0; i < cycles; ++i) {
    lose_input = true;
    step();
  }
}

void Cell::restart_bridge(const CycleSettings& changed) {
  pending.push_back(ShutdownRequest{});
  ASSERT_TRUE(until([&] { return cycle->finished(); }));
  settings = changed;
  cycle = std::make_unique<bridge::Cycle>(changed);
  exchange = {};
  for (int i = 0; i < 100; ++i) model.step_without_outputs(settings.cycle);
  steps(50);
}

}  // namespace meca::test
