#include "tests/bench/owner.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <new>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/bench/client.hpp"
#include "tests/bench/clock.hpp"

namespace meca::bench {
namespace {

using namespace std::chrono_literals;
using meca500::CommandKind;
using meca500::ReceiptState;

constexpr auto kTick = 5ms;
constexpr auto kRenewal = 20ms;         // five times per default lease
constexpr std::size_t kInTheQueue = 4;  // MoveJoints sent and not ended
constexpr float kVelocity = 8;          // deg/s
constexpr double kSwing = 20;           // deg, to both sides
constexpr int kStreamBegins = 10;       // velocity samples until the stream counts as running

class Owner {
 public:
  Owner(const OwnerOptions& options, OwnerBoard& board)
      : options_(options), board_(board), client_(options.domain, options.name) {}

  void run() {
    while (!client_.connected()) std::this_thread::sleep_for(kTick);
    board_.phase = OwnerBoard::kStandby;
    while (!board_.go) std::this_thread::sleep_for(1ms);
    take_and_resume();
    for (auto next = monotonic_now();; sleep_until(next)) {
      next += kTick;
      while (board_.hang) pause();
      options_.velocity ? stream() : queue();
    }
  }

 private:
  template <typename Send>
  void stamped(Send send) {
    const std::int64_t before = unix_now_ns();
    send();
    board_.last_sent_ns = before;
  }

  // Refused while the stop of the owner before is still under way; and a busy machine may let the lease lapse here.
  void take_and_resume() {
    std::string refusal;
    for (const auto patience = monotonic_now() + 20s; monotonic_now() < patience;) {
      auto end = client_.finish(Client::make(CommandKind::TAKE_CONTROL));
      if (end.state() == ReceiptState::COMPLETED) {
        const std::uint64_t id = client_.reserve_id();
        if (board_.first_resume_id == 0) board_.first_resume_id = id;
        end = client_.finish(Client::make(CommandKind::RESUME_MOTION), id);
        if (end.state() == ReceiptState::COMPLETED) return;
      }
      refusal = end.text().to_string();
    }
    throw std::runtime_error("no control and no motion within 20 s, " + refusal);
  }

  void stream() {
    const bool back = ++ticks_ / 40 % 2 == 1;
    stamped([&] { client_.send_velocity(back ? -kVelocity : kVelocity); });
    if (ticks_ == kStreamBegins) board_.phase = OwnerBoard::kStreaming;
  }

  void queue() {
    client_.take_receipts([&](const meca500::CommandReceipt& r) {
      if (r.state() == ReceiptState::ACKNOWLEDGED) board_.phase = OwnerBoard::kStreaming;
      if (is_terminal(r.state())) open_.erase(r.command_id());
    });
    while (open_.size() < kInTheQueue) {
      const double joint1 = ++moves_ % 2 == 0 ? kSwing : -kSwing;
      const std::uint64_t id = client_.reserve_id();
      if (board_.first_motion_id == 0) board_.first_motion_id = id;
      open_.insert(id);
      stamped([&] {
        client_.send(Client::make_motion(meca500::MotionCommandId::MOVE_JOINTS, {joint1, 0, 0, 0, 0, 0}, true), id);
      });
    }
    if (monotonic_now() < next_renewal_) return;
    next_renewal_ = monotonic_now() + kRenewal;
    stamped([&] { client_.renew(); });
  }

  const OwnerOptions& options_;
  OwnerBoard& board_;
  Client client_;
  std::set<std::uint64_t> open_;
  std::chrono::nanoseconds next_renewal_{};
  int ticks_ = 0;
  int moves_ = 0;
};

}  // namespace

SharedBoard::SharedBoard(std::filesystem::path path, bool make) : path_(std::move(path)), made_(make) {
  const int fd = ::open(path_.c_str(), O_RDWR | O_CLOEXEC | (make ? O_CREAT | O_EXCL : 0), 0600);
  if (fd < 0) throw std::runtime_error(path_.string() + ": " + std::strerror(errno));
  if (make && ftruncate(fd, sizeof(OwnerBoard)) != 0) throw std::runtime_error(path_.string() + ": no room");
  void* memory = mmap(nullptr, sizeof(OwnerBoard), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  close(fd);
  if (memory == MAP_FAILED) throw std::runtime_error(path_.string() + ": " + std::strerror(errno));
  board_ = make ? new (memory) OwnerBoard : static_cast<OwnerBoard*>(memory);
}

SharedBoard SharedBoard::make(const std::filesystem::path& path) { return {path, true}; }
SharedBoard SharedBoard::open(const std::filesystem::path& path) { return {path, false}; }

SharedBoard::SharedBoard(SharedBoard&& other) noexcept
    : path_(std::move(other.path_)),
      made_(std::exchange(other.made_, false)),
      board_(std::exchange(other.board_, nullptr)) {}

SharedBoard::~SharedBoard() {
  if (board_ != nullptr) munmap(board_, sizeof(OwnerBoard));
  std::error_code ignored;
  if (made_) std::filesystem::remove(path_, ignored);
}

void run_owner(const OwnerOptions& options) {
  const SharedBoard board = SharedBoard::open(options.board);
  try {
    Owner(options, *board.operator->()).run();
  } catch (const std::exception& error) {
    std::strncpy(board->problem, error.what(), sizeof board->problem - 1);
    board->phase = OwnerBoard::kFailed;
    throw;
  }
}

}  // namespace meca::bench
