#include "sim/meca_sim/ethercat_segment.hpp"

#include <algorithm>

namespace meca::sim {
namespace {

constexpr std::size_t kMostHeld = 256;  // a master sends a handful in a cycle; what is more is lost

std::vector<EthercatRobot> make_robots(const std::vector<EthercatSegment::Member>& members, ConnectionLoss on_loss,
                                       Time now) {
  std::vector<EthercatRobot> robots;
  robots.reserve(members.size());
  for (const auto& member : members) {
    robots.emplace_back(member.model, member.device, member.foreign, on_loss, now);
  }
  return robots;
}

std::vector<ethercat::Device*> devices_of(std::vector<EthercatRobot>& robots) {
  std::vector<ethercat::Device*> devices;
  for (EthercatRobot& robot : robots) devices.push_back(&robot.device());
  return devices;
}

}  // namespace

EthercatSegment::EthercatSegment(const std::vector<Member>& members, bool ring, ConnectionLoss on_loss, Time now)
    : robots_(make_robots(members, on_loss, now)),
      chain_(devices_of(robots_)),
      cut_(members.size() + 1, false),
      powered_(members.size(), true),
      passed_(members.size(), 0),
      held_(kMostHeld) {
  chain_.set_ring(ring);
}

std::optional<EthercatSegment::Side> EthercatSegment::process(Side in, std::span<std::byte> frame, Time now) noexcept {
  if (frame.size() > ethercat::kLongestFrame) return std::nullopt;
  const auto out = chain_.process(in, frame, now);
  if (!out || is_lost()) return std::nullopt;
  Time late{};
  bool twice = false, half = false;
  for (const EthercatRobot& robot : robots_) {
    late += robot.faults().late;
    twice = twice || robot.faults().duplicate;
    half = half || robot.faults().corrupt;
  }
  // What was held back is not overtaken: cables do not do that.
  if (late == Time::zero() && !twice && !half && held_count_ == 0) return out;
  for (int copies = twice ? 2 : 1; copies > 0; --copies) {
    hold(*out, half ? frame.first(frame.size() / 2) : frame, now + late);
  }
  return std::nullopt;
}

bool EthercatSegment::is_lost() noexcept {
  bool lost = false;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    NetworkFaults& faults = robots_[i].faults();
    if (faults.lose_next > 0) {
      --faults.lose_next;
      lost = true;
    }
    passed_[i] = faults.lose_every > 0 ? passed_[i] + 1 : 0;
    if (faults.lose_every == 0 || passed_[i] < faults.lose_every) continue;
    passed_[i] = 0;
    lost = true;
  }
  return lost;
}

void EthercatSegment::hold(Side out, std::span<const std::byte> frame, Time at) noexcept {
  if (held_count_ == held_.size()) return;
  Held& held = held_[(first_held_ + held_count_++) % held_.size()];
  std::ranges::copy(frame, held.bytes.begin());
  held.size = frame.size();
  held.out = out;
  held.at = at;
}

std::optional<EthercatSegment::LateFrame> EthercatSegment::take_late(Time now) noexcept {
  if (held_count_ == 0 || held_[first_held_].at > now) return std::nullopt;
  const Held& held = held_[first_held_];
  first_held_ = (first_held_ + 1) % held_.size();
  --held_count_;
  return LateFrame{held.out, std::span(held.bytes).first(held.size)};
}

void EthercatSegment::advance(Time now) noexcept {
  for (EthercatRobot& robot : robots_) robot.advance(now);
  lay_cables();
}

Time EthercatSegment::next_event() const noexcept {
  Time next = held_count_ > 0 ? held_[first_held_].at : Time::max();
  for (const EthercatRobot& robot : robots_) next = std::min(next, robot.next_event());
  return next;
}

void EthercatSegment::set_carrier(Side side, bool carrier) noexcept {
  carrier_[static_cast<std::size_t>(side)] = carrier;
}

void EthercatSegment::lay_cables() noexcept {
  for (std::size_t k = 0; k < cut_.size(); ++k) {
    if (cut_[k] == is_cut(k)) continue;
    cut_[k] = is_cut(k);
    cut_[k] ? chain_.cut(k) : chain_.heal(k);
  }
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    if (powered_[i] == robots_[i].powered()) continue;
    powered_[i] = robots_[i].powered();
    chain_.set_powered(i, powered_[i]);
  }
}

// Cable k is the one before robot k; the last one, of a ring, leads from the last robot back to the master.
bool EthercatSegment::is_cut(std::size_t cable) const noexcept {
  const bool first = cable == 0, last = cable == robots_.size();
  if (first && !carrier_[static_cast<std::size_t>(Side::kPrimary)]) return true;
  if (last && !carrier_[static_cast<std::size_t>(Side::kSecondary)]) return true;
  if (!first && (robots_[cable - 1].faults().unplugged || robots_[cable - 1].faults().cut_behind)) return true;
  return !last && (robots_[cable].faults().unplugged || robots_[cable].faults().cut);
}

}  // namespace meca::sim
