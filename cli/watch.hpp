// The live view of `meca-ctl watch` as pure functions: what is known of the robots in, lines of text out.
#pragma once

#include <array>
#include <string>

#include "cli/json.hpp"
#include "cli/view.hpp"

namespace meca::cli {

// How fast things arrive, measured between two redraws.
struct Rates {
  double images = 0;   // fresh images from the robot, 1/s, as the bridge counts them
  double samples = 0;  // TargetJointSet samples received here, 1/s
  double age_ms = -1;  // since the last TargetJointSet arrived; < 0: none yet
};

struct JointRange {
  double minimum = 0, maximum = 0;  // degrees
};

// The robot's own limits where it reports them (dynamic data 14 and 15, else 12 and 13), else those of the model.
std::array<JointRange, 6> joint_ranges(const RobotView& view);

// "[-----o-----]", `width` characters inside; the mark is '<' or '>' outside the range, '?' for a value that is no
// number.
std::string bar(double value, JointRange range, int width);

struct ScreenOptions {
  int rows = 24;  // of the terminal; robots that do not fit are shown in short
  bool color = false;
};

// One robot: about 14 lines, or 4 in short.
std::string screen_text(const std::string& robot, const RobotView& view, const Rates& rates, bool in_short, bool color);
std::string screen_text(const Views& robots, const std::map<std::string, Rates>& rates, const ScreenOptions& options);

// One robot in one line, for logs and pipes.
std::string line_text(const std::string& robot, const RobotView& view, const Rates& rates);
Json watch_json(const std::string& robot, const RobotView& view, const Rates& rates);

// Measures rates between calls.
class RateMeter {
 public:
  std::map<std::string, Rates> update(const Views& robots, Clock::time_point now);

 private:
  struct Last {
    std::uint64_t images = 0, samples = 0;
  };
  std::map<std::string, Last> last_;
  std::map<std::string, Rates> rates_;
  Clock::time_point since_{};
};

}  // namespace meca::cli
