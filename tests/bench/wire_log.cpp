#include "tests/bench/wire_log.hpp"

namespace meca::bench {
namespace {

constexpr dds::Qos kEveryCycle{dds::Reliability::kReliable, dds::Durability::kVolatile, 4000};

}  // namespace

WireLog::WireLog(dds::Participant& participant)
    : control_(participant.create_reader<meca500::MotionControl>("meca500/MotionControl", kEveryCycle)),
      command_(participant.create_reader<meca500::MotionCommand>("meca500/MotionCommand", kEveryCycle)) {}

void WireLog::pump() {
  dds::SampleInfo info;
  meca500::MotionControl control;
  while (control_.take(control, info)) {
    if (!info.valid_data) continue;
    WireImage& image = images_[control.header().cycle()];
    image.time_ns = control.header().receive_time_ns();
    image.has_control = true;
    image.move_id = control.move_id();
    image.set_point = control.set_point();
    image.pause = control.pause_motion();
    image.clear = control.clear_motion();
    image.resume = control.resume_motion();
  }
  meca500::MotionCommand command;
  while (command_.take(command, info)) {
    if (!info.valid_data) continue;
    WireImage& image = images_[command.header().cycle()];
    image.has_command = true;
    image.command = command.motion_command_id();
    image.arguments = command.arguments();
  }
}

}  // namespace meca::bench
