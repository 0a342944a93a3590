// Joint limits set by the user (SetJointLimits, SetJointLimitsCfg): narrower than the model's, and only while enabled.
#pragma once

#include "sim/inverse.hpp"

namespace meca::sim {

class UserLimits {
 public:
  static constexpr double kSmallestRange = 25;  // degrees (constant of the vendor's Python package)

  void enable(bool enabled) noexcept { enabled_ = enabled; }
  bool enabled() const noexcept { return enabled_; }
  // `joint` 1..6; (0, 0) restores the model's. False: outside of the model's limits or too narrow.
  bool set(int joint, double minimum, double maximum) noexcept {
    const auto i = static_cast<std::size_t>(joint - 1);
    const bool reset = minimum == 0 && maximum == 0;
    if (!reset && (maximum - minimum < kSmallestRange || minimum < kModelLimits.minimum[i] ||
                   maximum > kModelLimits.maximum[i])) {
      return false;
    }
    configured_.minimum[i] = reset ? kModelLimits.minimum[i] : minimum;
    configured_.maximum[i] = reset ? kModelLimits.maximum[i] : maximum;
    return true;
  }
  const JointLimits& configured() const noexcept { return configured_; }
  const JointLimits& effective() const noexcept { return enabled_ ? configured_ : kModelLimits; }

 private:
  bool enabled_ = false;
  JointLimits configured_ = kModelLimits;
};

}  // namespace meca::sim
