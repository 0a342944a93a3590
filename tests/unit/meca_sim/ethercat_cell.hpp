// Simulated robots on an EtherCAT segment and the master of the bridge, with time moved by hand and no sockets in
// between: frames arrive at once.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "sim/meca_sim/ethercat_segment.hpp"
#include "transports/ethercat/master.hpp"
#include "transports/image/codec.hpp"

namespace meca::sim::test {

using namespace std::chrono_literals;

class EthercatCell {
 public:
  using Port = ethercat::Master::Port;
  static constexpr Time kBegin = 1000s;
  static constexpr Time kStep = 250us;  // four of them a cycle
  struct Options {
    std::size_t robots = 1;
    bool ring = false;
    ConnectionLoss on_loss = ConnectionLoss::kStop;
    Time cycle = 1ms;
    bool dc = false;
  };

  EthercatCell() : EthercatCell(Options{}) {}
  explicit EthercatCell(const Options& options)
      : segment(members(options.robots), options.ring, options.on_loss, kBegin),
        master(settings(options)),
        outputs(options.robots),
        cycle_(options.cycle) {
    master.link_changed(Port::kPrimary, true, kBegin);
    if (options.ring) master.link_changed(Port::kSecondary, true, kBegin);
  }

  void run(Time duration) {
    for (const Time end = now + duration; now < end; now += kStep) exchange();
  }
  // False: not within the time.
  template <class Condition>
  bool until(Condition condition, Time most = 60s) {
    for (const Time end = now + most; now < end; now += kStep) {
      if (condition()) return true;
      exchange();
    }
    return condition();
  }
  bool operational(std::size_t robot) const { return master.station(robot).operational(); }
  bool connect() {
    return until([this] {
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (!operational(i)) return false;
      }
      return true;
    });
  }
  // Activated, homed, listening.
  bool make_ready() {
    for (image::Outputs& each : outputs) each.robot_control.activate = each.robot_control.home = true;
    return connect() && until([this] {
             for (std::size_t i = 0; i < outputs.size(); ++i) {
               if (!inputs(i).robot_status.homed) return false;
             }
             return true;
           });
  }
  void command(std::size_t robot, std::uint32_t id, std::array<float, 6> arguments) {
    image::Outputs& out = outputs[robot];
    out.motion_control.set_point = true;
    ++out.motion_control.move_id;
    out.motion_command = {id, arguments};
  }

  image::Inputs inputs(std::size_t robot = 0) const { return image::decode_inputs(master.input(robot), {}); }
  const Robot& model(std::size_t robot = 0) { return segment.robot(robot).robot(); }
  NetworkFaults& faults(std::size_t robot = 0) { return segment.robot(robot).faults(); }

  EthercatSegment segment;
  ethercat::Master master;
  std::vector<image::Outputs> outputs;
  bool master_lives = true;  // false: it has died without a word
  Time now = kBegin;

 private:
  static std::vector<EthercatSegment::Member> members(std::size_t count) {
    EthercatSegment::Member member;
    member.model.activation_time = member.model.homing_time = member.model.deactivation_time = 1ms;
    member.model.boot_time = 500ms;
    member.model.noise = false;
    return std::vector<EthercatSegment::Member>(count, member);
  }
  static ethercat::MasterSettings settings(const Options& options) {
    ethercat::MasterSettings settings;
    for (std::size_t i = 0; i < options.robots; ++i) settings.robots.push_back({static_cast<std::uint16_t>(i), {}});
    settings.redundant = options.ring;
    settings.cycle = options.cycle;
    settings.dc = options.dc;
    settings.station.shortest_backoff = 20ms;
    settings.station.longest_backoff = 100ms;
    return settings;
  }

  void exchange() {
    while (const auto late = segment.take_late(now)) deliver(late->out, late->bytes);
    if (master_lives) {
      if (now >= next_cycle_) {
        next_cycle_ = now + cycle_;
        send_outputs();
        master.begin_cycle(now);
      }
      send_frames();
    }
    segment.advance(now);
    for (std::size_t i = 0; i < outputs.size(); ++i) master.take_fresh(i);
  }
  void send_outputs() {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      image::OutputBytes bytes{};
      image::encode_outputs(outputs[i], {}, bytes);
      master.set_output(i, bytes);
    }
  }
  void send_frames() {
    for (int most = 64; most > 0; --most) {
      const ethercat::Bytes frame = master.next_frame(now);
      if (frame.empty()) return;
      const bool both = master.on_both_ports();
      std::ranges::copy(frame, first_.begin());
      std::ranges::copy(frame, second_.begin());
      pass(EthercatSegment::Side::kPrimary, std::span(first_).first(frame.size()));
      if (both) pass(EthercatSegment::Side::kSecondary, std::span(second_).first(frame.size()));
    }
  }
  void pass(EthercatSegment::Side in, std::span<std::byte> frame) {
    const auto out = segment.process(in, frame, now);
    if (out) deliver(*out, frame);
    segment.advance(now);
  }
  void deliver(EthercatSegment::Side out, std::span<const std::byte> frame) {
    if (master_lives) master.received(static_cast<Port>(out), frame, now);
  }

  Time cycle_;
  Time next_cycle_ = kBegin;
  std::array<std::byte, ethercat::kLongestFrame> first_{}, second_{};
};

}  // namespace meca::sim::test
