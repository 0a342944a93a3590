// A robot that sends anything and clients that ask for anything: the cycle takes every image and every request, and
// what it sends keeps the rules that protect the robot. Input: records of one kind byte and its bytes, until they run
// out.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "bridge/cycle.hpp"
#include "tests/fuzz/source.hpp"

namespace {

using meca::fuzz::Source;

using namespace meca;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "cycle_fuzz: %s\n", what);
  std::abort();
}

control::Request take_request(Source& source) {
  const auto client = control::ClientName(source.take<std::uint8_t>() % 2 != 0 ? "one" : "two");
  control::ParticipantId participant{};
  participant[0] = std::byte{source.take<std::uint8_t>()};
  switch (source.take<std::uint8_t>() % 4) {
    case 0:
      return control::LeaseRenewal{client, participant, source.take<std::uint64_t>()};
    case 1: {
      control::VelocityRequest request{.client = client, .participant = participant};
      request.sequence_number = source.take<std::uint64_t>();
      request.kind = static_cast<control::VelocityKind>(source.take<std::uint8_t>() % 3);
      for (auto& v : request.velocity) v = source.take<float>();
      return request;
    }
    default: {
      control::CommandRequest request{.client = client, .participant = participant};
      request.command_id = source.take<std::uint8_t>();
      request.kind = static_cast<control::CommandKind>(source.take<std::uint8_t>() % 15);
      request.motion_command_id = source.take<std::uint16_t>();
      for (auto& argument : request.arguments) argument = source.take<float>();
      request.argument_count = source.take<std::uint8_t>() % 7;
      const auto flags = source.take<std::uint8_t>();
      request.use_variables = (flags & 1) != 0;
      request.report_completion = (flags & 2) != 0;
      request.on_loss = static_cast<control::LossPolicy>((flags >> 2) & 1);
      return request;
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source source(data, size);
  bridge::Cycle cycle{bridge::CycleSettings{}};
  transports::Exchange exchange;
  exchange.link = transports::LinkState::kUp;
  const auto result = std::make_unique<bridge::StepResult>();
  bridge::Stamp stamp{std::chrono::seconds(1), 1};
  while (!source.empty()) {
    std::array<control::Request, bridge::Cycle::kMaxRequests> requests;
    std::size_t count = 0;
    const auto kind = source.take<std::uint8_t>();
    exchange.fresh = (kind & 1) != 0;
    exchange.link = (kind & 2) != 0 ? transports::LinkState::kUp : transports::LinkState::kDown;
    if (exchange.fresh) exchange.input = source.take<image::InputBytes>();
    for (int i = (kind >> 2) & 3; i > 0; --i) requests[count++] = take_request(source);
    stamp.now += std::chrono::milliseconds(1 + (kind >> 4) * 10);
    stamp.unix_ns += 1'000'000;
    cycle.step({requests.data(), count}, exchange, stamp, *result);

    const auto& record = result->record;
    require(result->receipt_count <= bridge::StepResult::kMaxReceipts, "more receipts than there is room for");
    require(record.firmware_known || !record.inputs.safety_status.known, "safety read before the firmware is known");
    const auto& motion = record.outputs.motion_control;
    require(!(motion.set_point && (motion.pause_motion || motion.clear_motion) && motion.move_id == 0),
            "a velocity goes out while the robot is held");
    const auto& brakes = record.outputs.brakes_control;
    require(!brakes.brakes_control_allowed, "brakes released though the configuration forbids it");
    require(!(record.outputs.robot_control.activate && record.outputs.robot_control.deactivate),
            "activate and deactivate at once");
    if (exchange.link != transports::LinkState::kUp) {
      require(!exchange.output_valid && !motion.set_point, "commands without a link");
    }
  }
  return 0;
}
