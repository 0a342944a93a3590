// Who may move the robot: one owner at a time, bound to a client name and its DDS participant, for as long as it
// renews.
#pragma once

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
  explicit Arbiter(Time lease) noexcept;

  Claim claim(const ClientName& client, const ParticipantId& participant) const noexcept;
  void take(const ClientName& client, const ParticipantId& participant, LossPolicy on_loss, Time now,
            std::int64_t unix_ns) noexcept;

  // Signs of life; those of anybody but the owner change nothing.
  void renew(const ClientName& client, const ParticipantId& participant, Time now) noexcept;
  void renew(const LeaseRenewal& renewal, Time now) noexcept;  // only with a sequence number above the last
  void set_policy(LossPolicy on_loss) noexcept { state_.on_loss = on_loss; }

  bool owned() const noexcept { return state_.owned; }
  bool expired(Time now) const noexcept { return state_.owned && now - renewed_ > lease_; }

  // Ends the owner's control. `accident`: it must take control explicitly to get it back.
  void drop(ControlState::Loss why, bool accident) noexcept;

  void remember_refusal(const Receipt& refusal) noexcept { state_.last_refusal = refusal; }
  void set_monitoring_only(bool on) noexcept { state_.monitoring_only = on; }
  const ControlState& state() const noexcept { return state_; }

 private:
  bool is_owner(const ClientName& client, const ParticipantId& participant) const noexcept;

  Time lease_;
  Time renewed_{};
  std::uint64_t last_renewal_ = 0;
  ControlState state_;
  bool lost_by_accident_ = false;
  ClientName loser_;
  ParticipantId loser_participant_{};
};

}  // namespace meca::control
