// `meca-ctl watch`: redraws a terminal, or prints lines where there is none.
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/run.hpp"
#include "cli/watch.hpp"

namespace meca::cli {
namespace {

using namespace std::chrono_literals;

// The alternate screen without cursor and line wrap, for as long as this lives; then the terminal is as it was.
class Screen {
 public:
  Screen() { std::cout << "\033[?1049h\033[?25l\033[?7l\033[2J" << std::flush; }
  ~Screen() { std::cout << "\033[?7h\033[?25h\033[?1049l" << std::flush; }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  // Overwrites instead of clearing first: no flicker.
  void draw(const std::string& text) const {
    std::string frame = "\033[H";
    int left = rows();
    for (std::size_t begin = 0; begin < text.size() && left > 0; --left) {
      const std::size_t end = text.find('\n', begin);
      frame += text.substr(begin, end - begin) + "\033[K";
      if (left > 1) frame += "\r\n";
      begin = end == std::string::npos ? text.size() : end + 1;
    }
    std::cout << frame << "\033[J" << std::flush;
  }

  static int rows() {
    winsize size{};
    return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 ? size.ws_row : 24;
  }
};

bool wants_color() {
  const char* no_color = std::getenv("NO_COLOR");  // https://no-color.org
  return no_color == nullptr || *no_color == '\0';
}

std::string title(const Bus& bus) { return "meca-ctl watch  " + bus.where() + "  Ctrl-C ends\n\n"; }

// Calls `show` at the rate until the end; what arrives in between is taken as it comes, so that rates are right.
template <typename Show>
void every(std::chrono::nanoseconds period, const Invocation& call, Observer& observer, Show show) {
  RateMeter meter;
  const auto start = Clock::now();
  auto next = start;
  const auto over = [&] { return call.duration_s && Clock::now() - start >= seconds_of(*call.duration_s); };
  while (!interrupted && !over()) {
    observer.pump(
        std::max<std::chrono::nanoseconds>(std::min<std::chrono::nanoseconds>(next - Clock::now(), 50ms), 0ns));
    if (Clock::now() < next) continue;
    next = std::max(next + std::chrono::duration_cast<Clock::duration>(period), Clock::now());
    show(meter.update(observer.robots(), Clock::now()));
  }
}

}  // namespace

ExitCode run_watch(const Invocation& call, const Report& report) {
  Bus bus(call);
  Observer observer(bus, Interest::kState);
  observer.discover(call.robot, discovery_timeout(call));
  observer.fill(call.robot, kPatience);
  const bool live = isatty(STDOUT_FILENO) == 1 && !report.json();
  const auto period = seconds_of(1 / call.rate_hz.value_or(live || report.json() ? 10 : 1));
  if (live) {
    const Screen screen;
    const bool color = wants_color();
    every(period, call, observer, [&](const auto& rates) {
      screen.draw(title(bus) + screen_text(chosen(observer.robots(), call.robot), rates, {Screen::rows() - 2, color}));
    });
    return ExitCode::kDone;
  }
  every(period, call, observer, [&](const auto& rates) {
    for (const auto& [name, view] : chosen(observer.robots(), call.robot)) {
      const auto& of_robot = rates.at(name);
      report.object(watch_json(name, view, of_robot));
      report.text(line_text(name, view, of_robot));
    }
  });
  return ExitCode::kDone;
}

}  // namespace meca::cli
