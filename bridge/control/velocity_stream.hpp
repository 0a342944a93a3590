// The velocity stream: the newest sample of the owner, repeated every cycle with MoveID 0 while it is fresh. When it is
// not, that very step writes zero velocity and SetPoint 0.
//
// Queued motion goes first: while a command is waiting or its handshake is under way, or the robot still has commands
// whose completion is awaited, the stream is silent. It starts only when the arm stands.
#pragma once

#include <array>
#include <cstdint>

#include "bridge/control/messages.hpp"
#include "bridge/control/view.hpp"

namespace meca::control {

std::uint32_t velocity_command(VelocityKind kind) noexcept;  // MotionCommandID 21, 22, 23

class VelocityStream {
 public:
  explicit VelocityStream(Time lease) noexcept : lease_(lease) {}

  // From the owner only. False when it is older than what is known or not finite: ignored.
  bool accept(const VelocityRequest& request, Time now) noexcept;

  // Decides whether the stream moves the robot in this cycle.
  void advance(const View& view, bool allowed) noexcept;
  // A new owner counts from its own beginning.
  void reset() noexcept;
  void stop() noexcept {
    has_sample_ = false;
    active_ = false;
  }

  bool active() const noexcept { return active_; }
  // Writes the stream, or, once after its end, the zero velocity. False when it has nothing to say.
  bool write(image::Outputs& out) noexcept;
  // A queued command took the image: it cancels the stream on the robot, no zero is owed.
  void yield() noexcept { wrote_ = false; }

 private:
  Time lease_;
  bool has_sample_ = false;
  bool active_ = false;
  bool wrote_ = false;
  Time received_{};
  bool has_sequence_ = false;
  std::uint64_t sequence_ = 0;
  VelocityKind kind_ = VelocityKind::kMoveJointsVel;
  std::array<float, 6> velocity_{};
};

}  // namespace meca::control
