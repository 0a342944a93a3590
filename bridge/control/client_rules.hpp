// What the configuration says of clients: who may take over from whom, and what happens when an owner is gone.
//
// A client is known by its name alone, which it chooses itself: rules keep order among programs that mean well. Who may
// reach the topics at all is for the network and DDS Security to say.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "bridge/control/messages.hpp"

namespace meca::control {

// What happens to queued motion when an owner is gone: what the client asks for, or what the configuration says.
enum class LossRule : std::uint8_t { kClient, kStop, kFinish };

struct ClientRule {
  ClientName name;         // exact, or the beginning of a name
  bool beginning = false;  // was written with a trailing '*'
  std::uint32_t priority = 0;
  std::optional<LossRule> on_loss;  // empty: the robot's
};

struct ClientRules {
  static constexpr std::size_t kMost = 32;
  static constexpr std::uint32_t kHighestPriority = 100;

  std::chrono::nanoseconds take_over_grace = std::chrono::milliseconds(500);
  LossRule on_loss = LossRule::kClient;
  std::array<ClientRule, kMost> clients{};
  std::size_t count = 0;

  // The rule for this client: its exact name wins over a beginning, the longer beginning over a shorter. nullptr: none.
  const ClientRule* find(std::string_view client) const noexcept {
    const ClientRule* best = nullptr;
    for (std::size_t i = 0; i < count; ++i) {
      const ClientRule& rule = clients[i];
      const std::string_view name = rule.name;
      if (rule.beginning ? !client.starts_with(name) : client != name) continue;
      const bool better =
          best == nullptr || (best->beginning && (!rule.beginning || name.size() > best->name.view().size()));
      if (better) best = &rule;
    }
    return best;
  }
  std::uint32_t priority(std::string_view client) const noexcept {
    const ClientRule* rule = find(client);
    return rule ? rule->priority : 0;
  }
  LossPolicy policy(std::string_view client, LossPolicy asked) const noexcept {
    const ClientRule* rule = find(client);
    switch (rule && rule->on_loss ? *rule->on_loss : on_loss) {
      case LossRule::kClient:
        break;
      case LossRule::kStop:
        return LossPolicy::kStopMotion;
      case LossRule::kFinish:
        return LossPolicy::kFinishMotion;
    }
    return asked;
  }
};

}  // namespace meca::control
