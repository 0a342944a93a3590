#include "bridge/intake.hpp"

#include <chrono>
#include <utility>
#include <variant>

#include "bridge/mapping.hpp"

namespace meca::bridge {
namespace {

using control::Reason;

// How long stop() may have to wait for the thread, and how long a full event queue gets to drain.
constexpr std::chrono::milliseconds kPoll{50};
constexpr std::chrono::milliseconds kRetry{1};

// A client that floods is held back by DDS flow control after so many commands. Clients come and go under new names:
// the limit of instances lets the middleware forget those that are gone.
constexpr int kCommandsPerClient = 256;
constexpr int kClients = 1024;

// Enough to be told once each; who sends ever new nonsense is not listened to for ever.
constexpr std::size_t kComplaints = 64;

std::int64_t unix_now() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

// Names of others in our log: printable or replaced.
std::string in_quotes(std::string_view name) {
  return is_presentable(name) ? "'" + std::string(name) + "'" : "(an unprintable name)";
}

control::Receipt rejection(const control::CommandRequest& request, Reason reason) {
  control::Receipt receipt;
  receipt.client = request.client;
  receipt.command_id = request.command_id;
  receipt.state = control::ReceiptState::kRejected;
  receipt.reason = reason;
  receipt.kind = request.kind;
  receipt.motion_command_id = request.motion_command_id;
  return receipt;
}

}  // namespace

Sorter::Sorter(std::vector<RobotChannel*> robots, SpscQueue<ReaderEvent>& events)
    : robots_(std::move(robots)), events_(events) {}

RobotChannel* Sorter::find(std::string_view robot) const noexcept {
  for (auto* channel : robots_) {
    if (channel->name == robot) return channel;
  }
  return nullptr;
}

std::string Sorter::unknown_robot(std::string_view robot) const {
  std::string text = "no robot " + in_quotes(robot) + " here; this bridge has ";
  for (const auto* channel : robots_) text += (channel == robots_.front() ? "" : ", ") + channel->name;
  return text;
}

bool Sorter::answer(std::string_view robot, const control::Receipt& receipt, std::string_view text,
                    std::string_view log_line, std::int64_t unix_ns) {
  return events_.push({.robot = robot,
                       .has_receipt = true,
                       .receipt = receipt,
                       .text = text,
                       .log_line = log_line,
                       .unix_ns = unix_ns});
}

void Sorter::complain(const std::string& line) {
  if (complaints_.size() >= kComplaints && !complaints_.contains(line)) return;
  if (++complaints_[line] > 1) return;
  events_.push({.robot = {}, .has_receipt = false, .receipt = {}, .text = {}, .log_line = std::string_view(line)});
}

bool Sorter::sort(const meca500::Command& sample, const control::ParticipantId& participant, std::int64_t unix_ns) {
  const std::string_view robot = sample.robot().c_str();
  const auto request = to_request(sample, participant);
  if (const auto* refusal = std::get_if<Refusal>(&request)) {
    return answer(robot, refusal->receipt, refusal->text, {}, unix_ns);
  }
  const auto& command = std::get<control::CommandRequest>(request);
  RobotChannel* channel = find(robot);
  if (channel == nullptr) {
    const std::string text = unknown_robot(robot);
    return answer(robot, rejection(command, Reason::kNotAllowed), text,
                  "command of " + in_quotes(command.client) + " rejected: " + text, unix_ns);
  }
  if (channel->inbox.push(command)) return true;
  return answer(robot, rejection(command, Reason::kQueueFull), {}, {}, unix_ns);
}

template <typename Sample>
void Sorter::sort_stream(const Sample& sample, const control::ParticipantId& participant, std::string_view what) {
  const std::string_view robot = sample.robot().c_str();
  const auto request = to_request(sample, participant);
  if (const auto* sentence = std::get_if<std::string>(&request)) return complain(*sentence);
  RobotChannel* channel = find(robot);
  if (channel == nullptr) return complain(std::string(what) + " ignored: " + unknown_robot(robot));
  if (!channel->inbox.push(std::get<0>(request))) {
    complain(std::string(robot) + ": " + std::string(what) + " dropped: more requests than the cycle can take");
  }
}

void Sorter::sort(const meca500::VelocityCommand& sample, const control::ParticipantId& participant) {
  sort_stream(sample, participant, "VelocityCommand");
}

void Sorter::sort(const meca500::ControlLease& sample, const control::ParticipantId& participant) {
  sort_stream(sample, participant, "ControlLease");
}

Intake::Intake(dds::Participant& participant, const DdsConfig& config, std::vector<RobotChannel*> robots,
               SpscQueue<ReaderEvent>& events, Wakeup& wakeup)
    : participant_(participant), sorter_(std::move(robots), events), wakeup_(wakeup) {
  const dds::Qos queue{.depth = 0, .max_samples = kCommandsPerClient, .max_instances = kClients};
  const dds::Qos stream{.reliability = dds::Reliability::kBestEffort, .max_instances = kClients};
  commands_ = participant.create_reader<meca500::Command>(config.topic_prefix + "Command", queue);
  velocities_ = participant.create_reader<meca500::VelocityCommand>(config.topic_prefix + "VelocityCommand", stream);
  leases_ = participant.create_reader<meca500::ControlLease>(config.topic_prefix + "ControlLease", stream);
}

Intake::~Intake() { stop(); }

void Intake::start() {
  thread_ = std::thread([this] { run(); });
}

void Intake::stop() {
  stop_requested_.store(true);
  if (thread_.joinable()) thread_.join();
}

void Intake::run() {
  meca500::VelocityCommand velocity;
  meca500::ControlLease lease;
  dds::SampleInfo info;
  while (!stop_requested_.load()) {
    if (!participant_.wait_for_data(kPoll)) continue;
    while (leases_.take(lease, info)) {
      if (info.valid_data) sorter_.sort(lease, info.participant);
    }
    while (velocities_.take(velocity, info)) {
      if (info.valid_data) sorter_.sort(velocity, info.participant);
    }
    take_commands();
  }
}

void Intake::take_commands() {
  meca500::Command command;
  dds::SampleInfo info;
  bool answered = false;
  // A flood of commands must not starve the leases: so many, then the streams again.
  for (int i = 0; i < kCommandsPerClient && commands_.take(command, info); ++i) {
    if (!info.valid_data) continue;
    while (!sorter_.sort(command, info.participant, unix_now())) {
      if (stop_requested_.load()) return;
      wakeup_.notify();
      std::this_thread::sleep_for(kRetry);
    }
    answered = true;
  }
  if (answered) wakeup_.notify();  // answers from here need not wait for the next cycle
}

}  // namespace meca::bridge
