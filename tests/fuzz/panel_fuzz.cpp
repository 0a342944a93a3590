// Any bytes on a control socket: they become lines of bounded length, each a request or a complaint in one line of
// printable text; what is understood is done to a robot that goes on working.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sim/panel.hpp"
#include "transports/net/line_splitter.hpp"

namespace {

using namespace meca;

constexpr std::size_t kLongest = 64;

void check(std::string_view text) {
  if (!(text.starts_with("ok: ") || text.starts_with("error: ")) || !text.ends_with('\n')) std::abort();
  if (text.find("\n\n") != std::string_view::npos) std::abort();  // that is the end of an answer
  for (const char c : text) {
    if ((c < ' ' || c > '~') && c != '\n') std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static sim::Robot robot;
  static sim::PanelAnswer answer;
  sim::NetworkFaults network, ethercat;
  ethercat.bus = sim::Fieldbus::kEthercat;
  net::LineSplitter lines(kLongest);
  lines.add({reinterpret_cast<const char*>(data), size});
  const auto say = [&](const net::LineSplitter::Line& line) {
    if (line.text.size() > kLongest || line.text.find('\n') != std::string::npos) std::abort();
    const auto parsed = sim::parse_panel_line(line.text);
    if (const auto* complaint = std::get_if<std::string>(&parsed)) return check(sim::panel_error(*complaint));
    sim::apply(std::get<sim::PanelRequest>(parsed), robot, &network, answer);
    robot.step_without_outputs(std::chrono::milliseconds(1));
    check(sim::to_text(answer));
    sim::apply(std::get<sim::PanelRequest>(parsed), robot, &ethercat, answer);
    check(sim::to_text(answer));
  };
  while (const auto line = lines.next()) say(*line);
  if (const auto line = lines.rest()) say(*line);
  return 0;
}
