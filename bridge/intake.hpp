// The reader side: one thread that turns Command, VelocityCommand and ControlLease samples into requests in the inboxes
// of the robots. Nothing is lost silently: what cannot be delivered gets a receipt, or (streams) a line in the log.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bridge/channel.hpp"
#include "bridge/config.hpp"
#include "bridge/dds.hpp"
#include "bridge/wakeup.hpp"
#include "idl/types.hpp"

namespace meca::bridge {

// Sorts samples into inboxes; no thread, no DDS.
class Sorter {
 public:
  Sorter(std::vector<RobotChannel*> robots, SpscQueue<ReaderEvent>& events);

  // False when the event queue has no room for the answer: the caller tries again later.
  bool sort(const meca500::Command& sample, const control::ParticipantId& participant, std::int64_t unix_ns);
  void sort(const meca500::VelocityCommand& sample, const control::ParticipantId& participant);
  void sort(const meca500::ControlLease& sample, const control::ParticipantId& participant);

 private:
  RobotChannel* find(std::string_view robot) const noexcept;
  template <typename Sample>
  void sort_stream(const Sample& sample, const control::ParticipantId& participant, std::string_view what);
  std::string unknown_robot(std::string_view robot) const;
  bool answer(std::string_view robot, const control::Receipt& receipt, std::string_view text, std::string_view log_line,
              std::int64_t unix_ns);
  void complain(const std::string& line);  // each sentence once

  std::vector<RobotChannel*> robots_;
  SpscQueue<ReaderEvent>& events_;
  std::map<std::string, std::uint64_t> complaints_;
};

class Intake {
 public:
  // Opens the readers; throws dds::Error. `robots`, `events` and `wakeup` outlive the intake.
  Intake(dds::Participant& participant, const DdsConfig& config, std::vector<RobotChannel*> robots,
         SpscQueue<ReaderEvent>& events, Wakeup& wakeup);
  ~Intake();  // stops
  Intake(const Intake&) = delete;
  Intake& operator=(const Intake&) = delete;

  void start();
  void stop();

 private:
  void run();
  void take_commands();

  dds::Participant& participant_;
  dds::Reader<meca500::Command> commands_;
  dds::Reader<meca500::VelocityCommand> velocities_;
  dds::Reader<meca500::ControlLease> leases_;
  Sorter sorter_;
  Wakeup& wakeup_;
  std::atomic<bool> stop_requested_{false};
  std::thread thread_;
};

}  // namespace meca::bridge
