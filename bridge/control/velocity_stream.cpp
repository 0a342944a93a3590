#include "bridge/control/velocity_stream.hpp"

#include <algorithm>
#include <cmath>

#include "transports/image/motion_commands.hpp"

namespace meca::control {

std::uint32_t velocity_command(VelocityKind kind) noexcept {
  switch (kind) {
    case VelocityKind::kMoveJointsVel:
      return image::kMoveJointsVel;
    case VelocityKind::kMoveLinVelWrf:
      return image::kMoveLinVelWrf;
    case VelocityKind::kMoveLinVelTrf:
      return image::kMoveLinVelTrf;
  }
  return image::kMoveJointsVel;
}

bool VelocityStream::accept(const VelocityRequest& request, Time now) noexcept {
  if (has_sequence_ && request.sequence_number <= sequence_) return false;
  if (!std::ranges::all_of(request.velocity, [](float v) { return std::isfinite(v); })) return false;
  has_sequence_ = true;
  sequence_ = request.sequence_number;
  kind_ = request.kind;
  velocity_ = request.velocity;
  received_ = now;
  has_sample_ = true;
  return true;
}

void VelocityStream::reset() noexcept {
  stop();
  has_sequence_ = false;
  sequence_ = 0;
}

void VelocityStream::advance(const View& view, bool allowed) noexcept {
  if (has_sample_ && view.now - received_ > lease_) has_sample_ = false;
  const bool standing = active_ || view.in.motion_status.eom;
  active_ = has_sample_ && allowed && standing;
}

bool VelocityStream::write(image::Outputs& out) noexcept {
  if (!active_ && !wrote_) return false;
  out.motion_control.move_id = 0;
  out.motion_control.set_point = active_;
  out.motion_control.use_variables = false;
  out.motion_command.command_id = velocity_command(kind_);
  out.motion_command.arguments = active_ ? velocity_ : std::array<float, 6>{};
  wrote_ = active_;
  return true;
}

}  // namespace meca::control
