// Which joint limits hold now, and how they are learnt: the robot tells them as dynamic data, in a slot borrowed for
// it.
#pragma once

#include <array>
#include <cstdint>

#include "bridge/control/view.hpp"

namespace meca::control {

// Degrees. Effective limits (types 14 and 15) where the robot has told them since it was activated, else those it was
// configured with (61 and 62, where 11 says that they are enabled), else those of its model (12 and 13), else the
// manual's. In recovery mode the configured ones do not count (spec 5.6).
class JointLimits {
 public:
  struct Range {
    double minimum, maximum;
  };
  // Believes what slots show, whoever asked for it. Limits change only while the robot is deactivated (spec 2.1,
  // 150-151), so those from before an activation are forgotten.
  void observe(const View& view) noexcept;
  void forget() noexcept { *this = JointLimits{}; }

  Range range(std::size_t joint) const noexcept;  // 0..5
  Range model(std::size_t joint) const noexcept;  // what the mechanics allow

 private:
  struct Live {
    bool known = false;
    Range range{};
  };
  using Table = std::array<Live, 6>;
  static void read(const image::DynamicData& data, std::size_t first, bool interleaved, Table& table) noexcept;

  Table effective_{}, configured_{}, model_{};
  bool configured_enabled_ = false;
  bool activated_ = false, recovery_mode_ = false;
};

// Asks for types 14 and 15 after every (re)connection and every activation: in an automatic slot, or, where clients
// have claimed all four, in the last, which is given back after these few cycles.
class LimitsProbe {
 public:
  // `may_ask`: the link stands, the firmware is known, and its probe has given its slots back.
  void observe(const View& view, bool may_ask) noexcept;
  std::array<std::uint32_t, image::kDynamicSlots> slots(
      std::array<std::uint32_t, image::kDynamicSlots> wanted) const noexcept;

 private:
  bool connected_ = false, activated_ = false;
  std::uint32_t asking_ = 0;  // type, 0 = nothing
  int images_ = 0;            // since it was asked for
};

}  // namespace meca::control
