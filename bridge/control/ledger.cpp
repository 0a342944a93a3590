#include "bridge/control/ledger.hpp"

#include <bit>

namespace meca::control {
namespace {

// What makes two commands the same command. FNV-1a; a collision would only answer a misused id as if it were resent.
std::uint64_t fingerprint_of(const CommandRequest& r) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto mix = [&hash](std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) hash = (hash ^ ((value >> shift) & 0xff)) * 0x100000001b3u;
  };
  mix(static_cast<std::uint64_t>(r.kind));
  mix(r.motion_command_id);
  mix(r.argument_count);
  for (std::size_t i = 0; i < r.argument_count && i < r.arguments.size(); ++i) {
    mix(std::bit_cast<std::uint64_t>(r.arguments[i]));
  }
  mix(static_cast<std::uint64_t>(r.use_variables) * 2 + static_cast<std::uint64_t>(r.report_completion));
  mix(static_cast<std::uint64_t>(r.on_loss));
  return hash;
}

}  // namespace

std::optional<std::size_t> Ledger::find_or_add(const CommandRequest& request) noexcept {
  std::optional<std::size_t> oldest;
  for (std::size_t i = 0; i < kClients; ++i) {
    const Client& c = clients_[i];
    if (c.used && c.participant == request.participant && c.name == request.client) return i;
    if (c.unfinished > 0) continue;  // its receipts are still to come: never forgotten
    if (!oldest || (clients_[*oldest].used && (!c.used || c.last_used < clients_[*oldest].last_used))) oldest = i;
  }
  if (!oldest) return std::nullopt;
  Client& c = clients_[*oldest];
  c.used = true;
  c.name = request.client;
  c.participant = request.participant;
  c.highest = 0;
  for (Entry& e : c.entries) e.used = false;
  return oldest;
}

std::optional<Ticket> Ledger::admit(const CommandRequest& request) noexcept {
  ++received_;
  const auto index = find_or_add(request);
  if (!index) return refuse(request, Reason::kQueueFull);
  Client& c = clients_[*index];
  c.last_used = received_;
  Entry& e = c.entries[request.command_id % kRemembered];
  const std::uint64_t fingerprint = fingerprint_of(request);
  if (e.used && e.command_id == request.command_id) {
    if (e.fingerprint != fingerprint) return refuse(request, Reason::kDuplicate);
    answer(c, e);
    return std::nullopt;
  }
  if (request.command_id <= c.highest && c.highest != 0) return refuse(request, Reason::kDuplicate);
  c.highest = request.command_id;
  if (e.used && !is_terminal(e.state)) return refuse(request, Reason::kQueueFull);
  e = Entry{};
  e.used = true;
  e.command_id = request.command_id;
  e.kind = request.kind;
  e.motion_command_id = request.motion_command_id;
  e.fingerprint = fingerprint;
  ++c.unfinished;
  return Ticket{request.command_id, request.motion_command_id, static_cast<std::uint8_t>(*index), request.kind};
}

void Ledger::report(const Ticket& ticket, ReceiptState state, Reason reason, const Detail& detail) noexcept {
  Client& c = clients_[ticket.client];
  Entry& e = c.entries[ticket.command_id % kRemembered];
  e.state = state;
  e.reason = reason;
  e.detail = detail;
  if (is_terminal(state) && c.unfinished > 0) --c.unfinished;
  if (state == ReceiptState::kRejected) ++rejected_;
  answer(c, e);
}

void Ledger::answer(const Client& client, const Entry& entry) noexcept {
  Receipt r;
  r.client = client.name;
  r.command_id = entry.command_id;
  r.state = entry.state;
  r.reason = entry.reason;
  r.robot_error = entry.detail.robot_error;
  r.kind = entry.kind;
  r.motion_command_id = entry.motion_command_id;
  r.argument = entry.detail.argument;
  r.value = entry.detail.value;
  r.minimum = entry.detail.minimum;
  r.maximum = entry.detail.maximum;
  r.other = entry.detail.other;
  r.hint = entry.detail.hint;
  push(r);
}

std::optional<Ticket> Ledger::refuse(const CommandRequest& request, Reason reason) noexcept {
  Receipt r;
  r.client = request.client;
  r.command_id = request.command_id;
  r.state = ReceiptState::kRejected;
  r.reason = reason;
  r.kind = request.kind;
  r.motion_command_id = request.motion_command_id;
  ++rejected_;
  push(r);
  return std::nullopt;
}

// A burst ends at most 256 queued, 256 executing and 16 actions at once; besides it, a cycle brings at most 32 requests
// with three receipts each and hands out 256. So 2048 is never reached.
void Ledger::push(const Receipt& receipt) noexcept {
  if (!pending_.push(receipt)) ++lost_;
}

std::size_t Ledger::drain(std::span<Receipt> out) noexcept {
  std::size_t count = 0;
  for (; count < out.size() && !pending_.empty(); ++count) {
    out[count] = pending_.front();
    pending_.pop();
  }
  return count;
}

}  // namespace meca::control
