// Any bytes as a script of faults: every line becomes an event, in the order of time, or a complaint in one line of
// printable text with its number; what is understood is done to a robot and its network, on
// each bus.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sim/meca_sim/script.hpp"

namespace {

using namespace meca::sim;

void check(std::string_view complaint) {
  if (!complaint.starts_with("f:")) std::abort();
  for (const char c : complaint) {
    if (c < ' ' || c > '~') std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Robot robot;
  static PanelAnswer answer;
  NetworkFaults ethernet_ip, ethercat;
  ethercat.bus = Fieldbus::kEthercat;
  const Script script = parse_script({reinterpret_cast<const char*>(data), size}, "f");
  for (const std::string& mistake : script.mistakes) check(mistake);
  Time previous{};
  for (const ScriptLine& line : script.lines) {
    if (line.at < previous || line.words.empty()) std::abort();
    previous = line.at;
    for (NetworkFaults* faults : {&ethernet_ip, &ethercat}) {
      apply(line.request, robot, faults, answer);
      if (to_text(answer).empty()) std::abort();
      const bool refused = answer.kind == PanelAnswer::Kind::kRefused;
      if (!misplaced(line.request, faults->bus).empty() && !refused) std::abort();
    }
    robot.step_without_outputs(std::chrono::milliseconds(1));
  }
  return 0;
}
