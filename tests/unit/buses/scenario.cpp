#include "tests/unit/buses/scenario.hpp"

#include <sstream>
#include <stdexcept>

#include "bridge/mapping.hpp"
#include "idl/types.hpp"

namespace meca::test {
namespace {

using meca500::CommandKind;

constexpr auto kSettle = 400ms;
constexpr int kMostSteps = 60000;  // of one line

struct ActionWord {
  const char* word;
  CommandKind kind;
};
constexpr ActionWord kActions[] = {{"take", CommandKind::TAKE_CONTROL},  {"release", CommandKind::RELEASE_CONTROL},
                                   {"activate", CommandKind::ACTIVATE},  {"deactivate", CommandKind::DEACTIVATE},
                                   {"home", CommandKind::HOME},          {"reset", CommandKind::RESET_ERROR},
                                   {"pause", CommandKind::PAUSE_MOTION}, {"resume", CommandKind::RESUME_MOTION},
                                   {"clear", CommandKind::CLEAR_MOTION}};
struct MotionWord {
  const char* word;
  std::uint32_t id;
};
constexpr MotionWord kMotions[] = {{"move-joints", image::kMoveJoints},
                                   {"checkpoint", image::kSetCheckpoint},
                                   {"set-joint-vel", image::kSetJointVel},
                                   {"delay", image::kDelay}};

// The same in time on every bus.
CycleSettings settings(Bus bus) {
  CycleSettings s = settings_on(bus);
  s.lease = 1s;
  s.velocity_lease = 100ms;
  return s;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

std::chrono::milliseconds ms(const std::string& text) { return std::chrono::milliseconds(std::stoi(text)); }

}  // namespace

Scenario::Scenario(Bus bus, Layout layout) : bench_(layout, settings(bus)), wire_(lay_wire(bus, bench_)) {
  // Not every bus says which firmware it is before the first image. What is UNKNOWN for that long is not compared.
  bench_.exchange.identity = {static_cast<std::uint16_t>(9 + static_cast<int>(layout)), 3, 0, 1};
  bench_.connect();
  run(kSettle);
}

std::string Scenario::play(const std::string& text) {
  std::string out = "# the robot is connected\n" + log_.changes();
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    Words words;
    for (std::string word; in >> word;) words.push_back(word);
    line_ = line;
    steps_ = 0;
    play_line(words);
    out += "\n> " + line;
    if (words.back() == "&" || words[0] == "run") continue;
    run(kSettle);
    out += "\n" + std::exchange(shown_, {}) + log_.changes();
  }
  bench_.expect_no_violation();
  return out;
}

void Scenario::play_line(Words words) {
  if (event(words)) return;
  const bool wait = words.back() != "&";
  if (!wait) words.pop_back();
  send(words, wait);
}

void Scenario::send(const Words& line, bool wait) {
  Words words = line;
  const bool panel = words[0] == "panel:";
  if (panel) words.erase(words.begin());
  meca500::Command command;
  bridge::set_text(command.robot(), "arm");
  bridge::set_text(command.client(), panel ? "panel" : bench_.client.view());
  command.command_id(++bench_.last_id);
  command.on_loss(meca500::LossPolicy::STOP_MOTION);
  bool known = false;
  for (const ActionWord& action : kActions) {
    if (action.word != words[0]) continue;
    command.kind(action.kind);
    known = true;
  }
  for (const MotionWord& motion : kMotions) {
    if (motion.word != words[0]) continue;
    command.kind(CommandKind::MOTION);
    command.motion_command_id(motion.id);
    command.report_completion(true);
    known = true;
  }
  if (!known) throw std::invalid_argument("'" + joined(line) + "' is no line of a scenario");
  for (std::size_t i = 1; i < words.size(); ++i) command.arguments().push_back(std::stod(words[i]));
  const auto request = bridge::to_request(command, participant(panel ? 2 : 1));
  const auto* good = std::get_if<CommandRequest>(&request);
  if (good == nullptr) throw std::invalid_argument(std::get<bridge::Refusal>(request).text);
  open_[good->command_id] = titles_[good->command_id] = joined(line);
  bench_.pending.push_back(*good);
  while (wait && open_.contains(good->command_id)) step();
}

bool Scenario::event(const Words& words) {
  const std::string line = joined(words);
  sim::Robot& robot = bench_.model;
  if (line == "press p-stop2") return robot.press_p_stop2(), true;
  if (line == "release p-stop2") return robot.release_p_stop2(), true;
  if (line == "press e-stop") return robot.press_e_stop(), true;
  if (line == "release e-stop") return robot.release_e_stop(), true;
  if (line == "press reset-button") return robot.press_reset_button(), true;
  if (line == "wait") {
    while (!open_.empty()) step();
    return true;
  }
  if (line == "where") return shown_ = TopicLog::joints(bench_.result->record), true;
  if (words[0] == "run") return run(ms(words.at(1))), true;
  if (words[0] == "error") return robot.raise_error(static_cast<std::uint16_t>(std::stoi(words.at(1)))), true;
  if (words[0] == "velocity") return stream(std::stof(words.at(1)), ms(words.at(3))), true;
  if (line == "cut") {
    bench_.link_up = false;
    // The built-in robot has no connection of its own to lose: it does here what a robot does on a fieldbus.
    if (!wire_) robot.drop_connection();
    return true;
  }
  if (line == "heal") {
    bench_.link_up = true;
    if (!wire_) robot.restore_connection();
    while (bench_.result->record.quality != Quality::kGood) step();
    return true;
  }
  return false;
}

void Scenario::stream(float degrees_per_second, std::chrono::nanoseconds time) {
  for (auto i = time / bench_.settings.cycle; i > 0; --i) {
    bench_.pending.push_back(bench_.velocity(degrees_per_second));
    step();
  }
}

void Scenario::step() {
  if (++steps_ > kMostSteps) throw std::runtime_error("'" + line_ + "' does not come to its end");
  bench_.step();
  for (const Receipt& receipt : bench_.receipts) {
    log_.take(receipt, titles_.at(receipt.command_id));
    if (is_terminal(receipt.state)) open_.erase(receipt.command_id);
  }
  bench_.receipts.clear();
  log_.take(bench_.result->record);
}

void Scenario::run(std::chrono::nanoseconds time) {
  for (auto i = time / bench_.settings.cycle; i > 0; --i) step();
}

}  // namespace meca::test
