// The test bench: one Cycle, one TinyRobot, a link between them that a test can cut, and time moved by hand.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bridge/control/receipt_text.hpp"
#include "bridge/cycle.hpp"
#include "sim/robot.hpp"
#include "tests/unit/control/tiny_robot.hpp"
#include "transports/image/codec.hpp"

namespace meca::test {

using namespace meca::control;
using bridge::CycleSettings;
using bridge::Quality;
using image::Layout;
using transports::LinkState;
using namespace std::chrono_literals;

inline ParticipantId participant(int n) {
  ParticipantId id{};
  id[0] = static_cast<std::byte>(n);
  return id;
}

class Bench {
 public:
  explicit Bench(CycleSettings settings = {}, Layout layout = Layout::kFirmware11)
      : settings(settings),
        robot(layout),
        layout(layout),
        result(std::make_unique<bridge::StepResult>()),
        cycle(std::make_unique<bridge::Cycle>(settings)) {}

  // --- one bus cycle: the bridge steps, then the frames cross.
  void step() {
    step_bridge();
    exchange_frames();
  }
  void step_bridge() {
    now += settings.cycle;
    unix_ns += settings.cycle.count();
    if (keep_alive) pending.push_back(LeaseRenewal{client, participant(1), ++renewals});
    std::vector<Request> batch;
    const std::size_t count = std::min(pending.size(), bridge::Cycle::kMaxRequests);
    batch.assign(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(count));
    pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(count));
    cycle->step(batch, exchange, {now, unix_ns}, *result);
    for (std::size_t i = 0; i < result->receipt_count; ++i) receipts.push_back(result->receipts[i]);
    out = image::decode_outputs(exchange.output, {layout});
  }
  void exchange_frames() {
    if (wire) return wire();
    const bool up = link_up && (!sim || sim->present());
    exchange.link = up ? LinkState::kUp : LinkState::kDown;
    exchange.fresh = false;
    if (!up) {
      if (sim) sim->step_without_outputs(settings.cycle);
      return;
    }
    const bool arrives = exchange.output_valid && !lose_output;
    lose_output = false;
    if (sim) {
      arrives ? sim->step(out, settings.cycle) : sim->step_without_outputs(settings.cycle);
      if (arrives && repeat_output) sim->step(out, 1us);
      repeat_output = false;
    } else if (arrives) {
      robot.step(out);
    } else {
      robot.step_without_outputs();
    }
    if (lose_input) {
      lose_input = false;
      return;
    }
    exchange.fresh = true;
    if (repeat_input) {  // the image before this one comes in its place
      repeat_input = false;
      return;
    }
    image::encode_inputs(sim ? sim->inputs() : robot.in, {layout}, exchange.input);
  }
  void steps(int n) {
    for (int i = 0; i < n; ++i) step();
  }
  bool until(const std::function<bool()>& condition, int most = 2000) {
    for (int i = 0; i < most; ++i) {
      if (condition()) return true;
      step();
    }
    return condition();
  }
  // Link up, firmware known, and no dynamic data slot borrowed any more.
  void connect() {
    link_up = true;
    ASSERT_TRUE(until([&] {
      return result->record.quality == Quality::kGood && result->record.serial_number != 0 &&
             out.dynamic_data_configuration.type_ids == settings.dynamic_data;
    }));
  }
  void connect_ready() {
    robot.ready();
    connect();
  }

  // --- requests
  CommandRequest request(CommandKind kind, std::initializer_list<double> arguments = {}) {
    CommandRequest r;
    r.client = client;
    r.participant = participant(1);
    r.command_id = ++last_id;
    r.kind = kind;
    std::copy(arguments.begin(), arguments.end(), r.arguments.begin());
    r.argument_count = static_cast<std::uint8_t>(arguments.size());
    r.on_loss = policy;
    return r;
  }
  CommandRequest motion(std::uint32_t id, std::initializer_list<double> arguments, bool report_completion = false) {
    CommandRequest r = request(CommandKind::kMotion, arguments);
    r.motion_command_id = id;
    r.report_completion = report_completion;
    return r;
  }
  // Hands over a request for the next step; returns the command id.
  std::uint64_t send(const CommandRequest& r) {
    pending.push_back(r);
    return r.command_id;
  }
  std::uint64_t send(CommandKind kind, std::initializer_list<double> arguments = {}) {
    return send(request(kind, arguments));
  }
  std::uint64_t move(double q1, bool report_completion = true) {
    return send(motion(image::kMoveJoints, {q1, 0, 0, 0, 0, 0}, report_completion));
  }
  VelocityRequest velocity(float w1) {
    VelocityRequest v;
    v.client = client;
    v.participant = participant(1);
    v.sequence_number = ++velocities;
    v.velocity = {w1, 0, 0, 0, 0, 0};
    return v;
  }

  // --- receipts
  std::vector<ReceiptState> states(std::uint64_t id) const {
    std::vector<ReceiptState> s;
    for (const Receipt& r : receipts) {
      if (r.command_id == id) s.push_back(r.state);
    }
    return s;
  }
  // The last receipt of a command; state kAccepted and reason kNone when there is none: tests compare more than that.
  Receipt last(std::uint64_t id) const {
    for (auto r = receipts.rbegin(); r != receipts.rend(); ++r) {
      if (r->command_id == id) return *r;
    }
    return {};
  }
  bool terminal(std::uint64_t id) const { return !states(id).empty() && is_terminal(last(id).state); }
  Receipt outcome(std::uint64_t id, int most = 40000) {
    EXPECT_TRUE(until([&] { return terminal(id); }, most)) << "command " << id << " never ended";
    return last(id);
  }
  Receipt outcome(CommandKind kind, std::initializer_list<double> arguments = {}) {
    return outcome(send(kind, arguments));
  }

  CycleSettings settings;
  TinyRobot robot;
  sim::Robot* sim = nullptr;   // in place of the tiny robot, when set
  std::function<void()> wire;  // a fieldbus in place of the direct link, when set
  // By that fieldbus: outputs that the robot's end takes, before the robot acts; empty: it has lost its host.
  std::function<void(std::span<const std::byte>)> on_heard;
  Layout layout;
  std::unique_ptr<bridge::StepResult> result;
  std::unique_ptr<bridge::Cycle> cycle;
  transports::Exchange exchange;
  image::Outputs out;  // what the last step put on the wire, decoded from its bytes
  std::vector<Receipt> receipts;
  std::vector<Request> pending;

  std::chrono::nanoseconds now = 1000s;
  std::int64_t unix_ns = 1'800'000'000'000'000'000;
  bool link_up = false, lose_output = false, lose_input = false;
  bool repeat_output = false, repeat_input = false;
  bool keep_alive = true;  // the owner renews its lease in every cycle
  ClientName client{"cell-plc"};
  LossPolicy policy = LossPolicy::kStopMotion;
  std::uint64_t last_id = 0, renewals = 0, velocities = 0;
};

inline bool ended(const Receipt& r, ReceiptState state, Reason reason) {
  return r.state == state && r.reason == reason;
}

#define EXPECT_OUTCOME(receipt, expected_state, expected_reason)                               \
  do {                                                                                         \
    const ::meca::control::Receipt r_ = (receipt);                                             \
    EXPECT_EQ(static_cast<int>(r_.state), static_cast<int>(expected_state)) << describe(r_);   \
    EXPECT_EQ(static_cast<int>(r_.reason), static_cast<int>(expected_reason)) << describe(r_); \
  } while (false)

}  // namespace meca::test
