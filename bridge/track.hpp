// When a section is published: the rate of its topic, applied to the stream of cycle records. No DDS, no clock: the
// time comes with each record, so tests move it by hand.
#pragma once

#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <vector>

#include "bridge/config.hpp"
#include "bridge/cycle.hpp"
#include "bridge/diagnosis.hpp"
#include "transports/image/image.hpp"

namespace meca::bridge {

// Equal as bits: a NaN that stays is no change, which operator== of floats would say it is.
inline bool same(const std::array<float, 6>& a, const std::array<float, 6>& b) noexcept {
  using Bits = std::array<std::uint32_t, 6>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}
template <typename Section>
bool same(const Section& a, const Section& b) noexcept {
  return a == b;
}
inline bool same(const image::TargetJointSet& a, const image::TargetJointSet& b) noexcept {
  return same(a.joints, b.joints);
}
inline bool same(const image::Pose& a, const image::Pose& b) noexcept {
  using Values = std::array<float, 6>;
  return same(std::bit_cast<Values>(a), std::bit_cast<Values>(b));
}
inline bool same(const image::MotionCommand& a, const image::MotionCommand& b) noexcept {
  return a.command_id == b.command_id && same(a.arguments, b.arguments);
}
inline bool same(const image::DynamicData& a, const image::DynamicData& b) noexcept {
  return a.type_id == b.type_id && same(a.values, b.values);
}
bool same(const image::Inputs& a, const image::Inputs& b) noexcept;
bool same(const control::ControlState& a, const control::ControlState& b) noexcept;
inline bool same(const Diagnosis& a, const Diagnosis& b) noexcept {
  return a.ready == b.ready && a.cause == b.cause && a.remedy == b.remedy;
}

// The decision of one topic of one robot. On change means at once when the value changes, and again every second while
// it does not: a volatile reader that joins late (the default of every vendor) is not served from the writer's history.
class RateGate {
 public:
  static constexpr Time kRefresh = std::chrono::seconds(1);

  // `changed`: the value differs from the last one published. `urgent`: it must not wait for its period, because the
  // quality changed: a value that is no longer good must not look good until the period is over.
  bool due(const TopicConfig& config, bool changed, bool urgent, Time now) noexcept;

 private:
  bool first_ = true;
  Time next_{};
};

// One section of one robot: remembers what was published last.
template <typename Section>
class Track {
 public:
  // True when `section` is to be published now.
  bool offer(const TopicConfig& config, const Section& section, Quality quality, Time now) noexcept {
    const bool quality_changed = quality != quality_;
    const bool changed = quality_changed || config.rate != RateKind::kOnChange || !same(section, last_);
    if (!gate_.due(config, changed, quality_changed, now)) return false;
    last_ = section;
    quality_ = quality;
    return true;
  }

 private:
  RateGate gate_;
  Section last_{};
  Quality quality_ = Quality::kUnknown;
};

// One dynamic data slot: on change means "this type's values differ from the last of this type in this slot", and every
// type comes at least once a second, so that who joined late has them all after a second. Types in an automatic slot
// come at most ten times a second each: actual values are never still, and who wants them faster asks for a slot.
class DynamicTrack {
 public:
  static constexpr Time kRefresh = RateGate::kRefresh;
  static constexpr Time kAutomaticInterval = std::chrono::milliseconds(100);

  DynamicTrack();
  // `automatic`: the bridge asks for no type in this slot, the robot chooses.
  bool offer(const TopicConfig& config, const image::DynamicData& data, bool automatic, Quality quality, Time now);

 private:
  struct Entry {
    image::DynamicData last;
    Quality quality;
    Time published;
  };
  Entry* find(std::uint32_t type_id) noexcept;

  std::vector<Entry> entries_;
  std::size_t hint_ = 0;  // an automatic slot shows the types in turn: the next one is usually the next entry
  RateGate gate_;         // kPeriod and kEveryCycle
  Quality quality_ = Quality::kUnknown;
};

}  // namespace meca::bridge
