// What a subscriber sees of one robot, reduced to what must be the same on every bus: each topic's values in the order
// in which they came, without times, counters and places of an arm that moves, and without what a bus shows only on
// its way between GOOD and DISCONNECTED. Samples are those that the publisher fills (bridge/mapping.hpp).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bridge/control/messages.hpp"
#include "bridge/cycle.hpp"

namespace meca::test {

class TopicLog {
 public:
  void take(const bridge::CycleRecord& record);
  // `title`: how the scenario calls the command.
  void take(const control::Receipt& receipt, const std::string& title);

  // What changed since the last call: one line a value, receipts first, then topic by topic. Of BridgeStatus, which is
  // published ten times a second, only how it stands now.
  std::string changes();

  // Joints as TargetJointSet has them, to a thousandth of a degree.
  static std::string joints(const bridge::CycleRecord& record);

 private:
  struct Topic {
    std::string name, last;
    std::vector<std::string> changes;
  };
  void offer(const std::string& topic, const std::string& value);

  bridge::CycleRecord last_;
  int good_images_ = 0;  // in a row
  std::vector<std::string> receipts_;
  std::vector<Topic> topics_;
};

}  // namespace meca::test
