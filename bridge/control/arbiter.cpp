#include "bridge/control/arbiter.hpp"

#include <algorithm>

namespace meca::control {

Arbiter::Arbiter(Time lease, const ClientRules& rules) noexcept : lease_(lease), rules_(rules) {
  state_.lease_ms = static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::milliseconds>(lease).count());
}

bool Arbiter::is_owner(const ClientName& client, const ParticipantId& participant) const noexcept {
  return state_.owned && state_.owner_participant == participant && state_.owner == client;
}

bool Arbiter::is_contender(const ClientName& client, const ParticipantId& participant) const noexcept {
  return contender_ && contender_->participant == participant && state_.contender == client;
}

const Arbiter::Loser* Arbiter::find_loser(const ClientName& client, const ParticipantId& participant) const noexcept {
  const auto found = std::find_if(losers_.begin(), losers_.end(), [&](const Loser& loser) {
    return !loser.client.empty() && loser.participant == participant && loser.client == client;
  });
  return found != losers_.end() ? &*found : nullptr;
}

Claim Arbiter::claim(const ClientName& client, const ParticipantId& participant) const noexcept {
  if (is_owner(client, participant)) return Claim::kOwner;
  if (state_.owned) return Claim::kForeign;
  return find_loser(client, participant) ? Claim::kMustTake : Claim::kFree;
}

void Arbiter::take(const ClientName& client, const ParticipantId& participant, LossPolicy asked, Time now,
                   std::int64_t unix_ns) noexcept {
  if (const Loser* loser = find_loser(client, participant)) losers_[static_cast<std::size_t>(loser - &losers_[0])] = {};
  state_.owned = true;
  state_.owner = client;
  state_.owner_participant = participant;
  state_.priority = rules_.priority(client);
  state_.since_unix_ns = unix_ns;
  set_policy(asked);
  live_on(owner_life_, {now, unix_ns, 0});
}

void Arbiter::live_on(Life& life, const Life& now) noexcept {
  life = now;
  if (&life == &owner_life_) state_.last_renewal_unix_ns = now.renewed_unix_ns;
}

Arbiter::Life* Arbiter::life_of(const ClientName& client, const ParticipantId& participant) noexcept {
  if (is_owner(client, participant)) return &owner_life_;
  return is_contender(client, participant) ? &contender_->life : nullptr;
}

void Arbiter::renew(const ClientName& client, const ParticipantId& participant, Time now,
                    std::int64_t unix_ns) noexcept {
  if (Life* life = life_of(client, participant)) live_on(*life, {now, unix_ns, life->last_renewal});
}

void Arbiter::renew(const LeaseRenewal& renewal, Time now, std::int64_t unix_ns) noexcept {
  Life* life = life_of(renewal.client, renewal.participant);
  if (!life || renewal.sequence_number <= life->last_renewal) return;
  live_on(*life, {now, unix_ns, renewal.sequence_number});
}

void Arbiter::remember_loser(const Loser& loser) noexcept {
  auto place = std::find_if(losers_.begin(), losers_.end(), [](const Loser& l) { return l.client.empty(); });
  if (place == losers_.end()) {
    place = losers_.begin() + static_cast<std::ptrdiff_t>(next_loser_);
    next_loser_ = (next_loser_ + 1) % losers_.size();
  }
  *place = loser;  // an owner is never among them: taking control took it off
}

void Arbiter::drop(ControlState::Loss why, bool accident) noexcept {
  if (!state_.owned) return;
  if (accident) remember_loser({state_.owner, state_.owner_participant});
  state_.owned = false;
  state_.last_owner = state_.owner;
  state_.last_loss = why;
  state_.owner = {};
  state_.owner_participant = {};
  state_.priority = 0;
  state_.since_unix_ns = 0;
  state_.on_loss = LossPolicy::kStopMotion;
}

bool Arbiter::may_take_over(const ClientName& client) const noexcept {
  const std::uint32_t priority = rules_.priority(client);
  return state_.owned && priority > state_.priority && (!contender_ || priority > state_.contender_priority);
}

std::optional<Ticket> Arbiter::contend(const CommandRequest& request, const Ticket& ticket, Time now,
                                       std::int64_t unix_ns) noexcept {
  std::optional<Ticket> outranked;
  if (contender_) {
    outranked = contender_->ticket;
  } else {
    takes_over_at_ = now + rules_.take_over_grace;
    state_.contender_takes_over_unix_ns = unix_ns + rules_.take_over_grace.count();
  }
  contender_ = Contender{request.participant, ticket, request.on_loss, {now, unix_ns, 0}};
  state_.contender = request.client;
  state_.contender_priority = rules_.priority(request.client);
  return outranked;
}

std::optional<Ticket> Arbiter::withdraw() noexcept {
  if (!contender_) return std::nullopt;
  const Ticket ticket = contender_->ticket;
  contender_.reset();
  state_.contender = {};
  state_.contender_priority = 0;
  state_.contender_takes_over_unix_ns = 0;
  return ticket;
}

Ticket Arbiter::succeed(std::int64_t unix_ns) noexcept {
  const Contender next = *contender_;
  const ClientName name = state_.contender;
  withdraw();
  take(name, next.participant, next.asked, next.life.renewed, unix_ns);
  live_on(owner_life_, next.life);  // the wait for control is no sign of life
  return next.ticket;
}

Detail Arbiter::explain(const ClientName& client, const ParticipantId& participant) const noexcept {
  Detail detail;
  const Claim claim = this->claim(client, participant);
  if (claim == Claim::kFree) detail.hint = ControlHint::kTakeFirst;
  if (claim != Claim::kForeign) return detail;
  const std::uint32_t priority = rules_.priority(client);
  detail.other = state_.owner;
  detail.value = priority;
  detail.minimum = state_.priority;
  detail.maximum = state_.contender_priority;
  detail.hint = is_contender(client, participant) ? ControlHint::kWaiting
                : may_take_over(client)           ? ControlHint::kMayTakeOver
                : contender_                      ? ControlHint::kContended
                                                  : ControlHint::kNone;
  return detail;
}

}  // namespace meca::control
