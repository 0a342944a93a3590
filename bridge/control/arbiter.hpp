// Who may move the robot: one owner at a time, bound to a client name and its DDS participant, for as long as it
// renews. A client to which the configuration gives a higher priority may take over: it asks for it, waits out the
// owner's grace as the contender, and is the owner next.
#pragma once

#include <array>
#include <optional>

#include "bridge/control/client_rules.hpp"
#include "bridge/control/ledger.hpp"
#include "bridge/control/messages.hpp"
#include "bridge/control/view.hpp"

namespace meca::control {

enum class Claim : std::uint8_t {
  kOwner,     // has control
  kFree,      // nobody has: a first command takes it
  kForeign,   // somebody else has
  kMustTake,  // nobody has, but this client lost control by accident: what it has under way must not move the robot
              // again by itself, so it takes control explicitly first
};

class Arbiter {
 public:
  Arbiter(Time lease, const ClientRules& rules) noexcept;

  Claim claim(const ClientName& client, const ParticipantId& participant) const noexcept;
  void take(const ClientName& client, const ParticipantId& participant, LossPolicy asked, Time now,
            std::int64_t unix_ns) noexcept;

  // Signs of life; those of anybody but the owner and the contender change nothing.
  void renew(const ClientName& client, const ParticipantId& participant, Time now, std::int64_t unix_ns) noexcept;
  // Only with a sequence number above the last.
  void renew(const LeaseRenewal& renewal, Time now, std::int64_t unix_ns) noexcept;
  // What the owner asks for; the configuration may know better.
  void set_policy(LossPolicy asked) noexcept { state_.on_loss = rules_.policy(state_.owner, asked); }

  bool owned() const noexcept { return state_.owned; }
  bool expired(Time now) const noexcept { return state_.owned && now - owner_life_.renewed > lease_; }

  // Ends the owner's control. `accident`: it must take control explicitly to get it back.
  void drop(ControlState::Loss why, bool accident) noexcept;

  // Whether TAKE_CONTROL of this client takes over: its priority is above the owner's and any contender's.
  bool may_take_over(const ClientName& client) const noexcept;
  // For may_take_over() only. The owner's grace runs once: a contender that outranks another waits for what is left of
  // it. Returns the ticket of the one it outranks.
  std::optional<Ticket> contend(const CommandRequest& request, const Ticket& ticket, Time now,
                                std::int64_t unix_ns) noexcept;
  bool contended() const noexcept { return contender_.has_value(); }
  bool is_contender(const ClientName& client, const ParticipantId& participant) const noexcept;
  bool contender_expired(Time now) const noexcept { return contender_ && now - contender_->life.renewed > lease_; }
  bool grace_over(Time now) const noexcept { return contender_ && now >= takes_over_at_; }
  // The contender gives up, or is given up. Nothing when there is none.
  std::optional<Ticket> withdraw() noexcept;
  // The contender becomes the owner; the owner before is gone. For contended() only.
  Ticket succeed(std::int64_t unix_ns) noexcept;

  // What a client without control reads: who has it, the priorities, and what would help.
  Detail explain(const ClientName& client, const ParticipantId& participant) const noexcept;

  void remember_refusal(const Receipt& refusal) noexcept { state_.last_refusal = refusal; }
  void set_monitoring_only(bool on) noexcept { state_.monitoring_only = on; }
  const ControlState& state() const noexcept { return state_; }

 private:
  struct Life {
    Time renewed{};
    std::int64_t renewed_unix_ns = 0;
    std::uint64_t last_renewal = 0;
  };
  struct Contender {
    ParticipantId participant{};
    Ticket ticket;
    LossPolicy asked = LossPolicy::kStopMotion;
    Life life;
  };
  struct Loser {
    ClientName client;
    ParticipantId participant{};
  };

  bool is_owner(const ClientName& client, const ParticipantId& participant) const noexcept;
  void live_on(Life& life, const Life& now) noexcept;
  Life* life_of(const ClientName& client, const ParticipantId& participant) noexcept;
  void remember_loser(const Loser& loser) noexcept;
  const Loser* find_loser(const ClientName& client, const ParticipantId& participant) const noexcept;

  Time lease_;
  ClientRules rules_;
  ControlState state_;  // names and priorities of owner and contender are kept here
  Life owner_life_;
  std::optional<Contender> contender_;
  Time takes_over_at_{};
  // Who lost control by accident and has not taken it since; where there are more, some are forgotten.
  std::array<Loser, 16> losers_{};
  std::size_t next_loser_ = 0;  // to be forgotten when there is no room
};

}  // namespace meca::control
