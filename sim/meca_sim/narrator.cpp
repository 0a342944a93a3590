#include "sim/meca_sim/narrator.hpp"

namespace meca::sim {

void Narrator::look(Time now) {
  if (robot_.present() != present_) {
    present_ = robot_.present();
    say_(Level::kInfo, present_ ? "the robot is back" : "the robot is away, starting up");
  }
  look_at_connection();
  look_at_violations(now);
}

void Narrator::look_at_violations(Time now) {
  const auto& violations = robot_.violations();
  if (violations.size() == violations_ || now < quiet_until_) return;
  const std::uint64_t more = violations.size() - violations_;
  violations_ = violations.size();
  quiet_until_ = now + std::chrono::seconds(1);
  say_(Level::kWarning, "the host broke a rule: " + std::string(violations[violations_ - 1].what) +
                            (more > 1 ? ", and " + counted(more - 1, "more") : ""));
}

std::string Narrator::summary() const {
  return connection_summary() + "; rules broken by the host: " + std::to_string(robot_.violations().size());
}

}  // namespace meca::sim
