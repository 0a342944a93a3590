// The four dynamic data slots: which types they show in a cycle, and when a whole round is done (manual 4.4.6, 4.5.10).
#pragma once

#include <array>
#include <cstdint>

#include "transports/image/image.hpp"

namespace meca::sim {

class DynamicSlots {
 public:
  explicit DynamicSlots(image::Layout layout) noexcept;

  // A value of `type` changed: automatic slots show it before the others.
  void changed(std::uint32_t type) noexcept { dirty_ |= bit(type); }
  // The arm moves: everything measured changes.
  void measured_changed() noexcept { dirty_ |= kMeasured & available_; }

  // The types to show in this cycle. A new request takes effect one cycle later (the manual says one or two).
  std::array<std::uint32_t, image::kDynamicSlots> advance(
      const std::array<std::uint32_t, image::kDynamicSlots>& requested) noexcept;

  std::uint32_t update_count() const noexcept { return update_count_; }
  bool available(std::uint32_t type) const noexcept { return type < 64 && (available_ & bit(type)) != 0; }

 private:
  static constexpr std::uint64_t bit(std::uint32_t type) noexcept { return std::uint64_t{1} << (type & 63); }
  static constexpr std::uint64_t kMeasured = std::uint64_t{0x7F} << 40 | std::uint64_t{0x7} << 32;  // 40..46, 32..34

  static std::uint32_t after(std::uint32_t last, std::uint64_t set) noexcept;
  std::uint32_t pick(std::uint64_t taken) noexcept;

  std::uint64_t available_ = 0;  // types of this firmware, by number
  std::uint64_t dirty_ = 0;
  std::uint64_t seen_ = 0;                      // in this round
  std::uint32_t last_ = 0, last_measured_ = 0;  // where the rounds are
  std::uint32_t turn_ = 0;
  std::uint32_t update_count_ = 0;
  std::array<std::uint32_t, image::kDynamicSlots> requested_{};
};

}  // namespace meca::sim
