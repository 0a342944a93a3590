// `meca-ctl topics`: every topic with its type, who is there, and how many samples a second really arrive.
#include <algorithm>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/format.hpp"
#include "cli/run.hpp"

namespace meca::cli {
namespace {

using namespace std::chrono_literals;

constexpr int kBurst = 256;  // samples per robot kept between two looks
constexpr auto kSettle = 200ms;

struct Line {
  const bridge::TopicInfo* info;
  std::function<void()> count;   // takes what has arrived
  std::function<int()> matched;  // the bridge's ends
  std::shared_ptr<std::uint64_t> samples = std::make_shared<std::uint64_t>(0);
};

template <typename Sample>
Line make_line(Bus& bus, std::string_view name) {
  Line line;
  line.info = std::ranges::find(bridge::kTopics, name, &bridge::TopicInfo::name);
  auto reader = std::make_shared<dds::Reader<Sample>>(bus.from_now_on<Sample>(name, kBurst));
  line.count = [reader, samples = line.samples] {
    Sample sample;
    dds::SampleInfo info;
    while (reader->take(sample, info)) *samples += info.valid_data ? 1 : 0;
  };
  if (line.info->direction == bridge::Direction::kPublished) {
    line.matched = [reader] { return reader->matched(); };
  } else {
    auto writer = std::make_shared<dds::Writer<Sample>>(bus.writer<Sample>(name));
    line.matched = [writer] { return writer->matched() - 1; };  // without our own reader
  }
  return line;
}

std::vector<Line> make_lines(Bus& bus) {
  using namespace meca500;
  std::vector<Line> lines;
  lines.push_back(make_line<RobotStatus>(bus, "RobotStatus"));
  lines.push_back(make_line<MotionStatus>(bus, "MotionStatus"));
  lines.push_back(make_line<TargetJointSet>(bus, "TargetJointSet"));
  lines.push_back(make_line<TargetEndEffectorPose>(bus, "TargetEndEffectorPose"));
  lines.push_back(make_line<TargetConfiguration>(bus, "TargetConfiguration"));
  lines.push_back(make_line<TargetWrf>(bus, "TargetWrf"));
  lines.push_back(make_line<TargetTrf>(bus, "TargetTrf"));
  lines.push_back(make_line<RobotTimestamp>(bus, "RobotTimestamp"));
  lines.push_back(make_line<SafetyStatus>(bus, "SafetyStatus"));
  lines.push_back(make_line<DynamicData>(bus, "DynamicData"));
  lines.push_back(make_line<CyclicState>(bus, "CyclicState"));
  lines.push_back(make_line<RobotControl>(bus, "RobotControl"));
  lines.push_back(make_line<MotionControl>(bus, "MotionControl"));
  lines.push_back(make_line<MotionCommand>(bus, "MotionCommand"));
  lines.push_back(make_line<HostTime>(bus, "HostTime"));
  lines.push_back(make_line<BrakesControl>(bus, "BrakesControl"));
  lines.push_back(make_line<DynamicDataConfiguration>(bus, "DynamicDataConfiguration"));
  lines.push_back(make_line<BridgeStatus>(bus, "BridgeStatus"));
  lines.push_back(make_line<ControlStatus>(bus, "ControlStatus"));
  lines.push_back(make_line<CommandReceipt>(bus, "CommandReceipt"));
  lines.push_back(make_line<Command>(bus, "Command"));
  lines.push_back(make_line<VelocityCommand>(bus, "VelocityCommand"));
  lines.push_back(make_line<ControlLease>(bus, "ControlLease"));
  return lines;
}

std::string rate_text(const bridge::TopicConfig& config) {
  switch (config.rate) {
    case bridge::RateKind::kOff:
      return "off";
    case bridge::RateKind::kEveryCycle:
      return "every cycle";
    case bridge::RateKind::kOnChange:
      return "on change";
    case bridge::RateKind::kPeriod:
      return "every " + std::to_string(config.period / 1ms) + " ms";
  }
  return "?";
}

void count_for(Bus& bus, const std::vector<Line>& lines, std::chrono::nanoseconds duration) {
  const auto start = Clock::now();
  while (!interrupted && Clock::now() - start < duration) {
    bus.wait(5ms);
    for (const auto& line : lines) line.count();
  }
}

// The bridge takes a moment to discover two dozen new readers; until then nothing can be measured.
void warm_up(Bus& bus, const std::vector<Line>& lines) {
  const auto arriving = [](const Line& line) {
    const bool periodic = line.info->defaults.rate == bridge::RateKind::kPeriod;
    return !periodic || line.matched() == 0 || *line.samples > 0;
  };
  const auto start = Clock::now();
  count_for(bus, lines, kSettle);
  while (!interrupted && Clock::now() - start < kPatience && !std::ranges::all_of(lines, arriving)) {
    count_for(bus, lines, kSettle);
  }
}

void print(const std::vector<Line>& lines, double seconds, const Report& report) {
  std::vector<std::vector<std::string>> rows{{"TOPIC", "DIRECTION", "DEFAULT RATE", "BRIDGES", "RECEIVED/s", "ABOUT"}};
  for (const auto& line : lines) {
    const bool published = line.info->direction == bridge::Direction::kPublished;
    const std::string direction = published ? "from bridge" : "to bridge";
    const double rate = static_cast<double>(*line.samples) / seconds;
    const std::string default_rate = published ? rate_text(line.info->defaults) : "client's";
    rows.push_back({std::string(line.info->name), direction, default_rate, std::to_string(line.matched()),
                    fixed(rate, 0, 1), std::string(line.info->about)});
    report.object({{"topic", line.info->name},
                   {"type", "meca500::" + std::string(line.info->name)},
                   {"direction", direction},
                   {"default_rate", default_rate},
                   {"bridges", line.matched()},
                   {"received_per_second", rate},
                   {"about", line.info->about}});
  }
  report.text(table(rows));
}

}  // namespace

ExitCode run_topics(const Invocation& call, const Report& report) {
  Bus bus(call);
  Observer observer(bus, Interest::kControl);
  observer.discover(call.robot, discovery_timeout(call));
  const auto lines = make_lines(bus);
  warm_up(bus, lines);
  for (const auto& line : lines) *line.samples = 0;
  const double seconds = call.duration_s.value_or(2);
  count_for(bus, lines, seconds_of(seconds));
  if (interrupted) return ExitCode::kInterrupted;
  report.text("Types are meca500::<TOPIC>, on " + bus.where() + "\n\n");
  print(lines, seconds, report);
  return ExitCode::kDone;
}

}  // namespace meca::cli
