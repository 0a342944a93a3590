#include "transports/builtin/builtin.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "transports/image/codec.hpp"

namespace meca::transports {
namespace {

// A bus that has been silent for longer (a debugger, a stopped process) lets the robots live this much of it.
constexpr Time kLongestStep = std::chrono::milliseconds(100);
constexpr Time kShortestStep = std::chrono::microseconds(1);

class Builtin final : public Transport {
 public:
  Builtin(const std::vector<sim::RobotOptions>& options, std::vector<std::unique_ptr<ControlPanel>> panels) {
    panels.resize(options.size());
    robots_.reserve(options.size());
    for (std::size_t i = 0; i < options.size(); ++i) {
      robots_.push_back({sim::Robot(options[i]), {options[i].layout, std::endian::little}, std::move(panels[i])});
    }
  }

  std::endian byte_order() const noexcept override { return std::endian::little; }
  void open(Time now) override { last_ = now; }

  void exchange(Time now, std::span<Exchange> exchanges) noexcept override {
    const Time dt = last_ ? std::clamp(now - *last_, kShortestStep, kLongestStep) : kShortestStep;
    last_ = now;
    for (std::size_t i = 0; i < std::min(exchanges.size(), robots_.size()); ++i) {
      auto& [robot, format, panel] = robots_[i];
      if (panel) panel->serve(robot);
      Exchange& e = exchanges[i];
      if (e.output_valid && robot.present()) {
        robot.step(e.output, format.byte_order, dt);
      } else {
        robot.step_without_outputs(dt);
      }
      e.fresh = robot.present();
      e.link = robot.present() ? LinkState::kUp : LinkState::kDown;
      e.link_detail = robot.present() ? std::string_view{} : "the simulated robot is starting up";
      if (robot.present()) image::encode_inputs(robot.inputs(), format, e.input);
      // There is no identity object on this bus: the firmware is to be read from dynamic data type 1.
      e.identity = {};
    }
  }

  void close() noexcept override { last_.reset(); }

 private:
  struct Member {
    sim::Robot robot;
    image::Format format;
    std::unique_ptr<ControlPanel> panel;
  };
  std::vector<Member> robots_;
  std::optional<Time> last_;
};

}  // namespace

std::unique_ptr<Transport> make_builtin(std::vector<sim::RobotOptions> robots,
                                        std::vector<std::unique_ptr<ControlPanel>> panels) {
  return std::make_unique<Builtin>(robots, std::move(panels));
}

}  // namespace meca::transports
