// A mailbox at register level that answers every mail with what a script says; drives a machine of the station.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "tests/unit/ethercat/wire_golden.hpp"
#include "transports/ethercat/access_machine.hpp"
#include "transports/ethercat/registers.hpp"

namespace meca::ethercat::station_test {

using namespace std::chrono_literals;
using golden::from_hex;
using ByteVector = std::vector<std::byte>;
using Outcome = AccessMachine::Outcome;

// As it stands in the memory of a mailbox.
inline ByteVector in_mailbox(std::string_view hex) {
  ByteVector mail = from_hex(hex);
  mail.resize(kMailboxSize);
  return mail;
}

class MailboxScript {
 public:
  std::deque<std::vector<ByteVector>> answers;            // to the first mail, to the second, ..
  std::function<std::optional<ByteVector>(Bytes)> serve;  // answers mails for which there is nothing in `answers`
  std::vector<ByteVector> written;                        // mails, without what fills them up
  std::deque<ByteVector> outbox;
  std::size_t full_for = 0;    // so many writes meet a full mailbox
  bool one_at_a_time = false;  // takes no mail out of its mailbox before its last answer was read
  std::uint8_t activate = 1, pdi = 0;
  bool repeats = true;
  ByteVector last;

  struct Answer {
    std::uint16_t working_counter;
    ByteVector data;
  };
  Answer access(const Access& access) {
    switch (access.address) {
      case 0x1000:
        return {take(access.data), {}};
      case 0x1080:
        return fetch();
      case 0x080D:
        return {1, {outbox.empty() ? std::byte{0} : std::byte{8}}};
      case 0x080E:
        if (access.write) request_repeat(std::to_integer<std::uint8_t>(access.data[0]));
        return {1, {std::byte{activate}, std::byte{pdi}}};
      default:
        return {0, ByteVector(access.size)};
    }
  }

 private:
  std::uint16_t take(Bytes memory) {
    if (full_for > 0) {
      --full_for;
      return 0;
    }
    if (one_at_a_time && !outbox.empty()) return std::exchange(full_, true) ? 0 : 1;
    const std::size_t length = 6 + std::to_integer<std::size_t>(memory[0]);
    written.emplace_back(memory.begin(), memory.begin() + static_cast<std::ptrdiff_t>(length));
    if (answers.empty()) {
      if (auto answer = serve ? serve(written.back()) : std::nullopt) outbox.push_back(std::move(*answer));
      return 1;
    }
    for (auto& mail : answers.front()) outbox.push_back(std::move(mail));
    answers.pop_front();
    return 1;
  }
  Answer fetch() {
    if (outbox.empty()) return {0, ByteVector(kMailboxSize)};
    last = outbox.front();
    outbox.pop_front();
    full_ = false;  // what lay there is a mail that it has had, by its counter
    return {1, last};
  }
  void request_repeat(std::uint8_t value) {
    if (repeats && ((value ^ pdi) & 2) != 0) {
      outbox.push_front(last);
      pdi = value & 2;
    }
    activate = value;
  }
  bool full_ = false;
};

enum class Loss : std::uint8_t { kNothing, kRequest, kReply };

// Runs until the machine comes to its end, or for so long.
template <class Device>
Outcome run(AccessMachine& machine, Device& device, Time& now, const std::function<Loss(const Access&)>& loses = {},
            Time limit = 10s) {
  for (const Time end = now + limit; machine.running() && now < end; now += 100us) {
    machine.tick(now);
    const auto access = machine.next(now);
    if (!access) continue;
    const Loss loss = loses ? loses(*access) : Loss::kNothing;
    if (loss != Loss::kRequest) {
      const auto answer = device.access(*access);
      if (loss == Loss::kNothing) {
        machine.answered(answer.working_counter, answer.data, now);
        continue;
      }
    }
    machine.lost(now += 4ms);
  }
  return machine.outcome();
}

}  // namespace meca::ethercat::station_test
