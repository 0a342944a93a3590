// Which firmware the robot runs, and with it which layout its image has. Learnt from the protocol's identity or from
// dynamic data type 1, whose place is the same in every layout; until then nothing that differs may be believed.
#pragma once

#include <array>
#include <cstdint>

#include "bridge/control/view.hpp"
#include "transports/transport.hpp"

namespace meca::control {

class FirmwareProbe {
 public:
  explicit FirmwareProbe(transports::FirmwareVersion expected) noexcept;

  // Another robot, or another firmware on it, may answer after a loss: forget everything.
  void restart(Time now) noexcept;
  void observe(const View& view, transports::FirmwareVersion identity) noexcept;

  bool known() const noexcept { return layout_known_; }
  // The robot's firmware has another layout than the configuration expects, or one this bridge does not speak (< 9).
  bool mismatch() const noexcept { return mismatch_; }
  transports::FirmwareVersion version() const noexcept { return version_; }
  // A guess until known(): what the configuration expects, else the newest.
  image::Layout layout() const noexcept { return layout_; }
  std::uint32_t product_type() const noexcept { return product_type_; }
  std::uint32_t serial_number() const noexcept { return serial_number_; }

  // All that is asked for is known or given up: no slot is borrowed.
  bool settled() const noexcept { return slots({}) == std::array<std::uint32_t, image::kDynamicSlots>{}; }
  // The dynamic data types to ask for: `wanted`, with the first slots borrowed for types 1, 2 and 3 until they are
  // known.
  std::array<std::uint32_t, image::kDynamicSlots> slots(
      const std::array<std::uint32_t, image::kDynamicSlots>& wanted) const noexcept;

 private:
  void learn(transports::FirmwareVersion version, bool from_robot) noexcept;

  transports::FirmwareVersion expected_;
  transports::FirmwareVersion version_{};
  image::Layout layout_;
  bool layout_known_ = false;
  bool version_known_ = false;  // all four numbers, from dynamic data
  bool mismatch_ = false;
  bool gave_up_ = false;  // on what is nice to know; the version alone is asked for as long as it takes
  Time started_{};
  std::uint32_t product_type_ = 0;
  std::uint32_t serial_number_ = 0;
};

}  // namespace meca::control
