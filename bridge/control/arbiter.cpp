#include "bridge/control/arbiter.hpp"

namespace meca::control {

Arbiter::Arbiter(Time lease) noexcept : lease_(lease) {
  state_.lease_ms = static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::milliseconds>(lease).count());
}

bool Arbiter::is_owner(const ClientName& client, const ParticipantId& participant) const noexcept {
  return state_.owned && state_.owner_participant == participant && state_.owner == client;
}

Claim Arbiter::claim(const ClientName& client, const ParticipantId& participant) const noexcept {
  if (is_owner(client, participant)) return Claim::kOwner;
  if (state_.owned) return Claim::kForeign;
  if (lost_by_accident_ && loser_participant_ == participant && loser_ == client) return Claim::kMustTake;
  return Claim::kFree;
}

void Arbiter::take(const ClientName& client, const ParticipantId& participant, LossPolicy on_loss, Time now,
                   std::int64_t unix_ns) noexcept {
  if (lost_by_accident_ && loser_participant_ == participant && loser_ == client) lost_by_accident_ = false;
  state_.owned = true;
  state_.owner = client;
  state_.owner_participant = participant;
  state_.on_loss = on_loss;
  state_.since_unix_ns = unix_ns;
  renewed_ = now;
  last_renewal_ = 0;
}

void Arbiter::renew(const ClientName& client, const ParticipantId& participant, Time now) noexcept {
  if (is_owner(client, participant)) renewed_ = now;
}

void Arbiter::renew(const LeaseRenewal& renewal, Time now) noexcept {
  if (!is_owner(renewal.client, renewal.participant) || renewal.sequence_number <= last_renewal_) return;
  last_renewal_ = renewal.sequence_number;
  renewed_ = now;
}

void Arbiter::drop(ControlState::Loss why, bool accident) noexcept {
  if (!state_.owned) return;
  state_.owned = false;
  state_.last_owner = state_.owner;
  state_.last_loss = why;
  if (accident) {
    lost_by_accident_ = true;
    loser_ = state_.owner;
    loser_participant_ = state_.owner_participant;
  }
  state_.owner = {};
  state_.owner_participant = {};
  state_.since_unix_ns = 0;
  state_.on_loss = LossPolicy::kStopMotion;
}

}  // namespace meca::control
