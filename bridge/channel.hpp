// What the threads share of one robot: three queues, each with one producer and one consumer, and a few counters.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>

#include "bridge/control/messages.hpp"
#include "bridge/cycle.hpp"
#include "bridge/queues.hpp"

namespace meca::bridge {

struct ReceiptEvent {
  control::Receipt receipt;
  std::uint64_t cycle = 0;
  std::int64_t unix_ns = 0;
};

// What the reader side has to say itself: the receipt of a command that never reached a robot's inbox, and a sentence
// for the log.
struct ReaderEvent {
  FixedText<63> robot;  // as the client wrote it
  bool has_receipt = false;
  control::Receipt receipt;
  FixedText<255> text;      // of the receipt; empty: the sentence of control::describe()
  FixedText<255> log_line;  // empty: none
  std::int64_t unix_ns = 0;
};

struct RobotChannel {
  static constexpr std::size_t kInbox = 256;
  static constexpr std::size_t kRecords = 256;    // a quarter of a second at 1 kHz
  static constexpr std::size_t kReceipts = 2048;  // see kReceiptReserve

  // Requests are only taken while so many receipts have room: those taken before may still need it all
  // (Cycle::step gives at most kMaxReceipts at once), and no receipt is ever dropped.
  static constexpr std::size_t kReceiptReserve = 1024;

  explicit RobotChannel(std::string robot_name) : name(std::move(robot_name)) {}

  const std::string name;
  SpscQueue<control::Request> inbox{kInbox};    // reader side -> cycle thread
  SpscQueue<CycleRecord> records{kRecords};     // cycle thread -> publisher; full: the record is dropped and counted
  SpscQueue<ReceiptEvent> receipts{kReceipts};  // cycle thread -> publisher
  std::atomic<std::uint64_t> records_dropped{0};
  std::atomic<std::uint64_t> receipts_lost{0};  // stays 0; if not, a client waits in vain and the log says so
};

}  // namespace meca::bridge
