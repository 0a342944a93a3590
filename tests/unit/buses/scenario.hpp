// A scenario: a text of commands and events, one a line, and the simulated robot on any bus that goes through it.
//
//   activate                    an action: take, release, activate, deactivate, home, reset, pause, resume, clear
//   move-joints 30 0 0 0 0 0    a motion command with its arguments; also checkpoint, set-joint-vel, delay
//   move-joints 30 0 0 0 0 0 &  not waited for
//   panel: home                 sent by another client, of another participant
//   velocity 10 for 500         a stream of MoveJointsVel on joint 1, deg/s, for so many ms
//   wait                        for the end of every command
//   run 100                     that many ms
//   error 3005, press p-stop2, release p-stop2, press e-stop, release e-stop, press reset-button
//   cut, heal                   the cable; heal waits until the robot is seen again
//   where                       shows the joints
//   # a remark
//
// After each line, but those with & and run, the robot has 400 ms; then what changed in the topics is written below it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/unit/buses/buses.hpp"
#include "tests/unit/buses/topic_log.hpp"
#include "tests/unit/control/sim_bench.hpp"

namespace meca::test {

class Scenario {
 public:
  Scenario(Bus bus, Layout layout);

  // The lines of `text`, each followed by what the topics showed. What is no line of a scenario throws
  // std::invalid_argument.
  std::string play(const std::string& text);

 private:
  using Words = std::vector<std::string>;

  void play_line(Words words);
  void send(const Words& words, bool wait);
  bool event(const Words& words);
  void stream(float degrees_per_second, std::chrono::nanoseconds time);
  void step();
  void run(std::chrono::nanoseconds time);

  SimBench bench_;
  std::unique_ptr<BusWire> wire_;
  TopicLog log_;
  std::map<std::uint64_t, std::string> titles_, open_;  // by command id
  std::string line_, shown_;                            // `shown_` by `where`
  int steps_ = 0;                                       // of the line
};

}  // namespace meca::test
