#include "sim/dynamic_data.hpp"

#include <bit>
#include <initializer_list>

namespace meca::sim {

DynamicSlots::DynamicSlots(image::Layout layout) noexcept {
  const auto add = [this](std::initializer_list<std::uint32_t> types) {
    for (const std::uint32_t t : types) available_ |= bit(t);
  };
  // Every type of table 12 that a Meca500 has. Which generation brought which is inferred from what they report:
  // firmware 9 has no work zone, collision or time scaling, and only firmware 11 has move duration, payload and
  // configured limits.
  add({1, 2, 3, 11, 12, 13, 14, 15, 20, 21, 22, 23, 24, 25, 32, 33, 34, 40, 41, 42, 43, 44, 45, 46, 52, 53});
  if (layout >= image::Layout::kFirmware10) add({17, 18, 19, 30, 36, 37, 38, 54});
  if (layout >= image::Layout::kFirmware11) add({29, 31, 61, 62});
  dirty_ = available_;
}

// The next member of `set` (not empty) after `last`, in a circle.
std::uint32_t DynamicSlots::after(std::uint32_t last, std::uint64_t set) noexcept {
  const std::uint64_t above = last >= 63 ? 0 : set & ~(bit(last + 1) - 1);
  return static_cast<std::uint32_t>(std::countr_zero(above != 0 ? above : set));
}

// Changed settings first, then what the moving arm changes; every fourth choice goes on with the round, so that a robot
// in motion still shows everything.
std::uint32_t DynamicSlots::pick(std::uint64_t taken) noexcept {
  const std::uint64_t settings = dirty_ & ~kMeasured & ~taken;
  const std::uint64_t measured = dirty_ & kMeasured & ~taken;
  const bool urgent = ++turn_ % 4 != 0;
  std::uint32_t type;
  if (urgent && settings != 0) {
    type = after(0, settings);
  } else if (urgent && measured != 0) {
    type = last_measured_ = after(last_measured_, measured);
  } else {
    type = last_ = after(last_, available_ & ~taken);
  }
  dirty_ &= ~bit(type);
  return type;
}

std::array<std::uint32_t, image::kDynamicSlots> DynamicSlots::advance(
    const std::array<std::uint32_t, image::kDynamicSlots>& requested) noexcept {
  std::array<std::uint32_t, image::kDynamicSlots> out{};
  std::uint64_t taken = 0;  // the same type in two slots would waste one
  bool any_automatic = false;
  for (std::size_t i = 0; i < out.size(); ++i) {
    any_automatic = any_automatic || requested_[i] == 0;
    if (requested_[i] != 0) {
      out[i] = requested_[i];
      if (out[i] < 64) taken |= bit(out[i]);
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (requested_[i] == 0) taken |= bit(out[i] = pick(taken));
  }
  requested_ = requested;
  if (any_automatic) {
    seen_ |= taken;
    if ((seen_ & available_) == available_) {
      ++update_count_;
      seen_ = 0;
    }
  }
  return out;
}

}  // namespace meca::sim
