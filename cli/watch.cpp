#include "cli/watch.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/format.hpp"
#include "cli/names.hpp"

namespace meca::cli {
namespace {

using namespace std::chrono_literals;

constexpr int kBarWidth = 31;
constexpr auto kRateWindow = 1s;  // shorter ones make the numbers dance
constexpr int kLongForm = 16;     // lines of a robot in full, with the blank one behind it
constexpr double kTurn = 360;

// The model's ranges (robot manual, technical specifications), degrees.
constexpr std::array<JointRange, 6> kModelRanges{
    {{-175, 175}, {-70, 90}, {-135, 70}, {-170, 170}, {-115, 115}, {-36000, 36000}}};

// Pairs of dynamic data types with the limits of joints 1-3 and 4-6, the strongest last.
constexpr std::array<std::uint32_t, 4> kLimitTypes{12, 13, 14, 15};

constexpr const char* kRed = "\033[31m";
constexpr const char* kGreen = "\033[32m";
constexpr const char* kYellow = "\033[33m";
constexpr const char* kBold = "\033[1m";
constexpr const char* kPlain = "\033[0m";

std::string colored(const std::string& text, const char* color, bool on) { return on ? color + text + kPlain : text; }

void adopt_limits(const meca500::DynamicData& sample, std::array<JointRange, 6>& ranges) {
  for (const auto& value : sample.values()) {
    const std::string name = value.name().c_str();  // "joint 4 max"
    if (!name.starts_with("joint ") || name.size() < 11 || !std::isfinite(value.value())) continue;
    const int joint = name[6] - '1';
    if (joint < 0 || joint > 5) continue;
    auto& range = ranges[static_cast<std::size_t>(joint)];
    if (name.ends_with("min")) range.minimum = value.value();
    if (name.ends_with("max")) range.maximum = value.value();
  }
}

std::string joint_line(int joint, double value, JointRange range, bool color) {
  std::string turns;
  double shown = value;
  JointRange scale = range;
  if (range.maximum - range.minimum > 2 * kTurn && std::isfinite(value)) {
    // A hundred turns on thirty characters say nothing: the bar is one turn.
    const double turn = std::round(value / kTurn);
    shown = value - turn * kTurn;
    scale = {-kTurn / 2, kTurn / 2};
    turns = "  turn " + fixed(turn, 0, 0);
  }
  const double margin = std::min(value - range.minimum, range.maximum - value) / (range.maximum - range.minimum);
  const char* tint = margin < 0.02 ? kRed : margin < 0.08 ? kYellow : kGreen;
  return "  q" + std::to_string(joint + 1) + fixed(value, 11, 3) + "  " + fixed(scale.minimum, 5, 0) + " " +
         colored(bar(shown, scale, kBarWidth), tint, color) + " " + fixed(scale.maximum, 0, 0) + turns + "\n";
}

const char* tint_of(const RobotView& view) {
  if (view.robot_status && view.robot_status->error_code() != 0) return kRed;
  return view.bridge && view.bridge->ready() ? kGreen : kYellow;
}

std::string age_text(const Rates& rates) { return rates.age_ms < 0 ? "never" : fixed(rates.age_ms, 0, 0) + " ms ago"; }

std::string rates_text(const Rates& rates) {
  return "images " + fixed(rates.images, 0, 0) + "/s, joint samples " + fixed(rates.samples, 0, 0) + "/s, the last " +
         age_text(rates);
}

std::string timing_text(const meca500::BridgeStatus& b) {
  return "cycle " + std::to_string(b.cycle_us()) + " us, missed " + std::to_string(b.missed_cycles()) + ", stale " +
         std::to_string(b.stale_cycles()) + ", woken up to " + std::to_string(b.wakeup_lateness_max_us()) + " us late";
}

std::string quality_text(const RobotView& view) {
  if (!view.joints) return "";
  const auto quality = view.joints->header().quality();
  return quality == meca500::Quality::GOOD ? "" : "  [" + std::string(name(quality)) + ": last known values]";
}

std::string heading(const std::string& robot, const RobotView& view, bool color) {
  std::string text = colored(robot, kBold, color) + "  " + colored(activity(view), tint_of(view), color) +
                     colored(quality_text(view), kRed, color);
  if (view.bridge) {
    text += "  (" + std::string(view.bridge->product().c_str()) + " " + view.bridge->firmware().c_str() + ", " +
            view.bridge->transport().c_str() + ")";
  }
  return text + "\n";
}

std::string short_form(const std::string& robot, const RobotView& view, const Rates& rates, bool color) {
  std::string text = heading(robot, view, color);
  if (view.bridge && !view.bridge->ready()) text += "  " + readiness(view) + "\n";
  if (view.joints) text += "  joints" + joints_text(*view.joints) + "\n";
  if (view.pose) text += "  pose  " + pose_text(*view.pose) + "\n";
  return text + "  " + rates_text(rates) + "\n";
}

std::string long_form(const std::string& robot, const RobotView& view, const Rates& rates, bool color) {
  std::string text = heading(robot, view, color);
  text += "  Ready    " + readiness(view) + "\n";
  const auto ranges = joint_ranges(view);
  for (int i = 0; view.joints && i < 6; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    text += joint_line(i, view.joints->joints()[joint], ranges[joint], color);
  }
  if (view.pose) text += "  Pose  " + pose_text(*view.pose) + "\n";
  text += "  State    " + flags_text(view) + "\n";
  if (view.robot_status && view.robot_status->error_code() != 0) {
    text += "  Error    " + colored(error_text(view.robot_status->error_code()), kRed, color) + "\n";
  }
  text += "  Safety   " + safety(view) + "\n";
  if (view.control) {
    text += "  Control  " + std::string(view.control->owned() ? view.control->owner().c_str() : "free") + "\n";
  }
  text += "  Rates    " + rates_text(rates) + "\n";
  if (view.bridge) text += "  Timing   " + timing_text(*view.bridge) + "\n";
  return text;
}

}  // namespace

std::array<JointRange, 6> joint_ranges(const RobotView& view) {
  auto ranges = kModelRanges;
  for (const auto type : kLimitTypes) {
    const auto found = view.dynamic_data.find(type);
    if (found != view.dynamic_data.end()) adopt_limits(found->second, ranges);
  }
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (!(ranges[i].maximum > ranges[i].minimum)) ranges[i] = kModelRanges[i];  // not reported yet: zeros
  }
  return ranges;
}

std::string bar(double value, JointRange range, int width) {
  std::string cells(static_cast<std::size_t>(width), '-');
  const double share = (value - range.minimum) / (range.maximum - range.minimum);
  if (!std::isfinite(share)) {
    cells[static_cast<std::size_t>(width) / 2] = '?';
  } else if (share < 0) {
    cells.front() = '<';
  } else if (share > 1) {
    cells.back() = '>';
  } else {
    cells[static_cast<std::size_t>(std::lround(share * (width - 1)))] = 'o';
  }
  return "[" + cells + "]";
}

std::string screen_text(const std::string& robot, const RobotView& view, const Rates& rates, bool in_short,
                        bool color) {
  return in_short ? short_form(robot, view, rates, color) : long_form(robot, view, rates, color);
}

std::string screen_text(const Views& robots, const std::map<std::string, Rates>& rates, const ScreenOptions& options) {
  const bool in_short = static_cast<int>(robots.size()) * kLongForm > options.rows && robots.size() > 1;
  std::string text;
  for (const auto& [name, view] : robots) {
    const auto found = rates.find(name);
    if (!text.empty()) text += "\n";
    text += screen_text(name, view, found == rates.end() ? Rates{} : found->second, in_short, options.color);
  }
  return text;
}

std::string line_text(const std::string& robot, const RobotView& view, const Rates& rates) {
  std::string text = robot + "  " + activity(view) + quality_text(view);
  if (view.joints) text += "  joints" + joints_text(*view.joints);
  if (view.pose) text += "  pose" + pose_text(*view.pose);
  return text + "  " + fixed(rates.samples, 0, 0) + " samples/s, the last " + age_text(rates);
}

Json watch_json(const std::string& robot, const RobotView& view, const Rates& rates) {
  Json json = to_json(robot, view);
  json["doing"] = activity(view);
  json["rates"] = {{"images_per_second", rates.images},
                   {"samples_per_second", rates.samples},
                   {"age_ms", rates.age_ms < 0 ? Json(nullptr) : Json(rates.age_ms)}};
  return json;
}

std::map<std::string, Rates> RateMeter::update(const Views& robots, Clock::time_point now) {
  const bool first = since_ == Clock::time_point{};
  const double seconds = std::chrono::duration<double>(now - since_).count();
  const bool due = first || now - since_ >= kRateWindow;
  for (const auto& [name, view] : robots) {
    auto& rates = rates_[name];
    rates.age_ms = view.joints ? std::chrono::duration<double, std::milli>(now - view.joints_arrived).count() : -1;
    if (!due) continue;
    const bool known = last_.contains(name);
    auto& last = last_[name];
    const Last current{view.bridge ? view.bridge->fresh_images() : 0, view.joint_samples};
    // A bridge that was restarted counts from zero again: then nothing can be said for this window.
    if (known && !first && current.images >= last.images) {
      rates.images = static_cast<double>(current.images - last.images) / seconds;
      rates.samples = static_cast<double>(current.samples - last.samples) / seconds;
    }
    last = current;
  }
  if (due) since_ = now;
  return rates_;
}

}  // namespace meca::cli
