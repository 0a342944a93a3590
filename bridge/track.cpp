#include "bridge/track.hpp"

#include <algorithm>

namespace meca::bridge {

bool same(const image::Inputs& a, const image::Inputs& b) noexcept {
  return same(a.robot_status, b.robot_status) && same(a.motion_status, b.motion_status) &&
         same(a.target_joint_set, b.target_joint_set) && same(a.target_end_effector_pose, b.target_end_effector_pose) &&
         same(a.target_configuration, b.target_configuration) && same(a.target_wrf, b.target_wrf) &&
         same(a.target_trf, b.target_trf) && same(a.robot_timestamp, b.robot_timestamp) &&
         same(a.safety_status, b.safety_status) &&
         std::equal(a.dynamic_data.begin(), a.dynamic_data.end(), b.dynamic_data.begin(),
                    [](const auto& x, const auto& y) { return same(x, y); });
}

bool same(const control::ControlState& a, const control::ControlState& b) noexcept {
  const auto same_refusal = [](const control::Receipt& x, const control::Receipt& y) {
    return x.client == y.client && x.command_id == y.command_id && x.state == y.state && x.reason == y.reason;
  };
  return a.owned == b.owned && a.owner == b.owner && a.owner_participant == b.owner_participant &&
         a.since_unix_ns == b.since_unix_ns && a.priority == b.priority && a.lease_ms == b.lease_ms &&
         a.on_loss == b.on_loss && a.contender == b.contender && a.contender_priority == b.contender_priority &&
         a.contender_takes_over_unix_ns == b.contender_takes_over_unix_ns && a.monitoring_only == b.monitoring_only &&
         same_refusal(a.last_refusal, b.last_refusal) && a.last_owner == b.last_owner && a.last_loss == b.last_loss;
}

bool RateGate::due(const TopicConfig& config, bool changed, bool urgent, Time now) noexcept {
  switch (config.rate) {
    case RateKind::kOff:
      return false;
    case RateKind::kEveryCycle:
      return true;
    case RateKind::kOnChange: {
      if (!first_ && !changed && now < next_) return false;
      first_ = false;
      next_ = now + kRefresh;
      return true;
    }
    case RateKind::kPeriod: {
      if (first_) {
        first_ = false;
        next_ = now + config.period;
        return true;
      }
      if (now < next_) return urgent;
      next_ += config.period;  // keeps the phase, unless it is hopelessly behind
      if (next_ <= now) next_ = now + config.period;
      return true;
    }
  }
  return false;
}

DynamicTrack::DynamicTrack() { entries_.reserve(64); }

DynamicTrack::Entry* DynamicTrack::find(std::uint32_t type_id) noexcept {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::size_t at = (hint_ + i) % entries_.size();
    if (entries_[at].last.type_id != type_id) continue;
    hint_ = at + 1;
    return &entries_[at];
  }
  return nullptr;
}

bool DynamicTrack::offer(const TopicConfig& config, const image::DynamicData& data, bool automatic, Quality quality,
                         Time now) {
  if (config.rate != RateKind::kOnChange) {
    const bool urgent = quality != quality_;
    if (!gate_.due(config, true, urgent, now)) return false;
    quality_ = quality;
    return true;
  }
  // Variables alone may be 10000 types; the limit only costs a repeated sample.
  constexpr std::size_t kMaxTypes = 256;
  Entry* entry = find(data.type_id);
  if (entry == nullptr) {
    if (entries_.size() >= kMaxTypes) entries_.clear();
    entries_.push_back({data, quality, now});
    return true;
  }
  const Time age = now - entry->published;
  if (entry->quality == quality && age < kRefresh) {
    if (same(entry->last, data) || (automatic && age < kAutomaticInterval)) return false;
  }
  *entry = {data, quality, now};
  return true;
}

}  // namespace meca::bridge
