#include "sim/torque.hpp"

#include <algorithm>
#include <cmath>

#include "sim/severity.hpp"
#include "sim/skeleton.hpp"

namespace meca::sim {
namespace {

// inferred, all of them: masses that add up to what a small arm weighs above its base, and what its motors could hold.
constexpr double kUpperArmMass = 1.0, kForearmMass = 0.8, kWristMass = 0.35, kFlangeMass = 0.1;  // kg
constexpr Joints kFullTorque{12.5, 12.5, 6, 1.5, 1.5, 0.6};                                      // Nm
constexpr double kNewtonMetresPerKgMm = 9.81e-3;

struct Mass {
  double kg;
  Vec3 at;
  std::size_t link;  // the joint that carries it, from 0
};

// The motors' share for accelerating: bounded, because a drive takes longer instead of giving more.
double acceleration_share(double acceleration, double top_speed) noexcept {
  constexpr double kMost = 35;           // %
  const double usual = top_speed / 0.1;  // full speed in one ramp at SetJointAcc 100
  const double x = acceleration / usual;
  return kMost * x / (1 + std::abs(x));
}

}  // namespace

Joints calculated_torques(const Joints& q, const Joints& acceleration, const std::array<double, 4>& payload) noexcept {
  const Skeleton s = skeleton(q);
  const Vec3 load = s.flange.p + s.flange.r * Vec3{payload[1], payload[2], payload[3]};
  const std::array<Mass, 5> masses{Mass{kUpperArmMass, 0.5 * (s.shoulder + s.elbow), 1},
                                   {kForearmMass, 0.5 * (s.bend + s.wrist), 2},
                                   {kWristMass, s.wrist, 4},
                                   {kFlangeMass, s.flange.p, 5},
                                   {payload[0], load, 5}};
  const std::array<Vec3, 6> origin{s.shoulder, s.shoulder, s.elbow, s.wrist, s.wrist, s.wrist};
  Joints out;
  for (std::size_t i = 0; i < 6; ++i) {
    double holding = 0;  // kg mm
    for (const Mass& m : masses) {
      if (m.link < i) continue;
      const Vec3 arm = m.at - origin[i];
      // axis . (arm x up): what keeps the mass from falling.
      holding += m.kg * (s.axis[i][0] * arm[1] - s.axis[i][1] * arm[0]);
    }
    const double gravity = 100 * holding * kNewtonMetresPerKgMm / kFullTorque[i];
    // SetPayload has no upper limit; what is shown stays a number.
    out[i] = std::clamp(gravity + acceleration_share(acceleration[i], kTopSpeed[i]), -1000.0, 1000.0);
  }
  return out;
}

bool excessive(const Torques& t, const Settings& settings, bool accelerating) noexcept {
  constexpr int kSkipAcceleration = 1, kDeviation = 2;
  if (settings.torque_severity == severity::kSilent || (settings.torque_mode == kSkipAcceleration && accelerating))
    return false;
  for (std::size_t i = 0; i < 6; ++i) {
    const double measured = settings.torque_mode == kDeviation ? t.actual[i] - t.calculated[i] : t.actual[i];
    if (std::abs(measured) > settings.torque_limits[i]) return true;
  }
  return false;
}

}  // namespace meca::sim
