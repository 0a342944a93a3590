// The book of receipts: which command ids each client has used, what became of them, and what is still to be published.
// A resent id is answered from memory and never executed twice. Fixed memory: the last 256 ids of 32 clients.
//
// A client is its name and its DDS participant together: a restarted process is somebody new and may count from 1
// again. Ids count up: one at or below the highest seen that is not remembered is refused as kDuplicate, gaps included.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "bridge/control/messages.hpp"
#include "bridge/control/ring.hpp"

namespace meca::control {

// One admitted command; small, so that queues of them are.
struct Ticket {
  std::uint64_t command_id = 0;
  std::uint32_t motion_command_id = 0;
  std::uint8_t client = 0;  // index into the ledger's clients
  CommandKind kind = CommandKind::kTakeControl;
};

// What a sentence about a refusal needs.
struct Detail {
  std::uint16_t robot_error = 0;
  std::uint8_t argument = 0;
  double value = 0, minimum = 0, maximum = 0;
  ClientName other{};
  ControlHint hint = ControlHint::kNone;
};

class Ledger {
 public:
  static constexpr std::size_t kClients = 32;
  static constexpr std::size_t kRemembered = 256;  // per client; also the most that one client may have unfinished
  static constexpr std::size_t kPending = 2048;    // receipts not yet handed out

  // A ticket for a new command. Nothing for one that is answered here: resent, too old, or no room to remember it.
  std::optional<Ticket> admit(const CommandRequest& request) noexcept;

  // Adds a receipt and remembers it as the command's latest.
  void report(const Ticket& ticket, ReceiptState state, Reason reason = Reason::kNone,
              const Detail& detail = {}) noexcept;

  // Hands out the oldest receipts, at most as many as fit; the rest waits for the next call.
  std::size_t drain(std::span<Receipt> out) noexcept;

  bool drained() const noexcept { return pending_.empty(); }

  const ClientName& name(const Ticket& ticket) const noexcept { return clients_[ticket.client].name; }
  std::uint64_t received() const noexcept { return received_; }
  std::uint64_t rejected() const noexcept { return rejected_; }
  // Receipts that found no room: 0 by construction (see ledger.cpp), counted all the same.
  std::uint64_t lost() const noexcept { return lost_; }

 private:
  struct Entry {
    bool used = false;
    ReceiptState state = ReceiptState::kAccepted;
    Reason reason = Reason::kNone;
    CommandKind kind = CommandKind::kTakeControl;
    std::uint64_t command_id = 0;
    std::uint64_t fingerprint = 0;
    std::uint32_t motion_command_id = 0;
    Detail detail;
  };
  struct Client {
    bool used = false;
    ClientName name;
    ParticipantId participant{};
    std::uint64_t highest = 0;
    std::uint64_t last_used = 0;
    std::size_t unfinished = 0;
    std::array<Entry, kRemembered> entries{};
  };

  std::optional<std::size_t> find_or_add(const CommandRequest& request) noexcept;
  std::optional<Ticket> refuse(const CommandRequest& request, Reason reason) noexcept;
  void answer(const Client& client, const Entry& entry) noexcept;
  void push(const Receipt& receipt) noexcept;

  std::array<Client, kClients> clients_{};
  Ring<Receipt, kPending> pending_;
  std::uint64_t received_ = 0, rejected_ = 0, lost_ = 0;
};

}  // namespace meca::control
