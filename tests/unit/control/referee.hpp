// Who watches the images that reach a robot: what one image lets it do that the image before it did not, and whether
// anybody had asked for that. It reads the 60 bytes by the places of the manual's table, without the bridge's codec.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "transports/image/image.hpp"

namespace meca::test {

using image::Layout;

enum class Right : std::uint8_t { kCommand, kVelocity, kResume, kResetError, kActivate, kHome };
constexpr std::size_t kRights = 6;

class Referee {
 public:
  explicit Referee(Layout layout) : layout_(layout) {}

  // `echo`, `busy`: what the robot has before it reads this image. Returns what is done without the right to it.
  std::vector<std::string> judge(std::span<const std::byte> out, std::uint16_t echo, bool busy) {
    const auto bit = [&out](std::size_t at, int n) { return ((std::to_integer<unsigned>(out[at]) >> n) & 1u) != 0; };
    std::vector<std::string> faults;
    const auto need = [&](Right right, const char* what) {
      if (!rights_[static_cast<std::size_t>(right)]) faults.emplace_back(what);
    };
    // Table 1.1: MoveID 4..5, SetPoint 6:0, Pause 6:1, Clear 6:2, Resume 6:3, command 8..11, arguments 12..35.
    const bool set_point = bit(6, 0), pause = bit(6, 1), clear = bit(6, 2), resume = bit(6, 3);
    const std::uint16_t id = little(out, 4);
    if (set_point && id != 0 && id != echo && id != last_id_) need(Right::kCommand, "a command (MoveID edge)");
    if (set_point && id != 0) last_id_ = id;
    if (set_point && id == 0 && little(out, 8) >= 21 && little(out, 8) <= 23) {
      bool moves = false;
      for (std::size_t i = 12; i < 36; ++i) moves |= std::to_integer<unsigned>(out[i]) != 0;
      if (moves) need(Right::kVelocity, "a velocity");
    }
    if (resume && !resume_) need(Right::kResume, "a ResumeMotion edge");
    // Firmware 9 resumes when both levels are low (spec 1.3): letting go of a robot that has something to do.
    if (layout_ == Layout::kFirmware9 && busy && !pause && !clear && (pause_ || clear_)) {
      need(Right::kResume, "Pause let go with motion queued");
    }
    if (bit(0, 3) && !reset_) need(Right::kResetError, "ResetError");
    if (bit(0, 1) && !activate_) need(Right::kActivate, "Activate");
    if (bit(0, 2) && !home_) need(Right::kHome, "Home");
    pause_ = pause;
    clear_ = clear;
    resume_ = resume;
    reset_ = bit(0, 3);
    activate_ = bit(0, 1);
    home_ = bit(0, 2);
    return faults;
  }

  // The robot hears nobody: the next image is compared with nothing.
  void silence() { resume_ = reset_ = activate_ = home_ = pause_ = clear_ = false; }
  // Its end of a connection is gone: silence, in which it stays paused (inferred, sim/robot.hpp drop_connection()).
  void disconnect() {
    silence();
    pause_ = true;
  }
  // Switched off and on: every MoveID is new to it.
  void power_cycle() {
    silence();
    last_id_ = 0;
  }
  void revoke() { rights_.fill(false); }
  void grant(Right right) { rights_[static_cast<std::size_t>(right)] = true; }

 private:
  static std::uint16_t little(std::span<const std::byte> out, std::size_t at) {
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(out[at]) | std::to_integer<unsigned>(out[at + 1]) << 8);
  }

  Layout layout_;
  std::array<bool, kRights> rights_{};
  std::uint16_t last_id_ = 0;
  bool pause_ = false, clear_ = false, resume_ = false, reset_ = false, activate_ = false, home_ = false;
};

}  // namespace meca::test
