#include "tests/bench/fighter.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include "tests/bench/client.hpp"
#include "tests/bench/clock.hpp"

namespace meca::bench {
namespace {

using namespace std::chrono_literals;
using meca500::CommandKind;
using meca500::ReceiptState;

constexpr auto kRenewal = 20ms;

std::atomic<bool> asked_to_end{false};

class Fighter {
 public:
  explicit Fighter(const FighterOptions& options)
      : diary_(open(options.diary.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600)),
        client_(options.domain, options.name),
        random_(options.seed) {
    if (diary_ < 0) throw std::runtime_error(options.diary.string() + " cannot be written");
  }

  void run() {
    note("life");
    while (!client_.connected() && !asked_to_end) look_on(5ms, 5ms);
    while (!asked_to_end) {
      const int what = pick(100);
      if (what < 55) {
        if (take()) reign();
      } else if (what < 80) {
        if (answered(send(CommandKind::RESUME_MOTION))) reign();  // a first command takes control when it is free
      } else if (what < 90) {
        what % 2 == 0 ? command() : (void)send(CommandKind::RELEASE_CONTROL);  // whoever has control
      }
      look_on(20ms, 300ms);
    }
    for (const auto patience = monotonic_now() + 30s; !open_.empty() && monotonic_now() < patience;) look_on(5ms, 5ms);
    note("lived");
  }

 private:
  int pick(int n) { return std::uniform_int_distribution(0, n - 1)(random_); }

  void note(const std::string& line) {
    const std::string text = line + "\n";
    [[maybe_unused]] const auto written = write(diary_, text.data(), text.size());
  }

  std::uint64_t send(meca500::Command command) {
    command.on_loss(pick(3) == 0 ? meca500::LossPolicy::FINISH_MOTION : meca500::LossPolicy::STOP_MOTION);
    const std::uint64_t id = client_.reserve_id();
    note("sent " + std::to_string(id) + " " + std::to_string(static_cast<int>(command.kind())));
    open_.insert(id);
    client_.send(command, id);
    if (pick(50) == 0) {
      note("again " + std::to_string(id));
      client_.send(std::move(command), id);
    }
    return id;
  }
  std::uint64_t send(CommandKind kind) { return send(Client::make(kind)); }

  void read() {
    client_.take_receipts([&](const meca500::CommandReceipt& r) {
      note("seen " + std::to_string(r.command_id()) + " " + std::to_string(static_cast<int>(r.state())) + " " +
           std::to_string(static_cast<int>(r.reason())));
      if (!is_terminal(r.state())) return;
      open_.erase(r.command_id());
      if (r.state() == ReceiptState::COMPLETED) done_.insert(r.command_id());
    });
  }

  // Reads receipts for a random time without a sign of life.
  void look_on(std::chrono::milliseconds least, std::chrono::milliseconds most) {
    const auto time = least + (most - least) * pick(101) / 100;
    for (const auto end = monotonic_now() + time; monotonic_now() < end;) {
      client_.wait(std::min<std::chrono::nanoseconds>(end - monotonic_now(), 10ms));
      read();
    }
  }

  void renew() {
    if (monotonic_now() < next_renewal_) return;
    next_renewal_ = monotonic_now() + kRenewal;
    client_.renew();
  }

  // True when the command is COMPLETED within a second; renews meanwhile, as who takes over must.
  bool answered(std::uint64_t id) {
    for (const auto end = monotonic_now() + 1s; open_.contains(id) && monotonic_now() < end;) {
      renew();
      client_.wait(5ms);
      read();
    }
    return done_.contains(id);
  }

  bool take() { return answered(send(CommandKind::TAKE_CONTROL)); }

  void command() {
    using namespace meca500::MotionCommandId;
    const auto degrees = [&] { return pick(400) / 100.0 - 2; };
    const int what = pick(100);
    if (what < 60) {
      send(Client::make_motion(MOVE_JOINTS, {degrees(), degrees(), degrees(), 0, degrees(), 0}, pick(2) == 0));
    } else if (what < 75) {
      send(Client::make_motion(SET_JOINT_VEL, {50.0 + pick(50)}, pick(2) == 0));
    } else if (what < 80) {
      send(Client::make_motion(MOVE_JOINTS, {degrees(), degrees(), degrees()}, false));  // three are too few
    } else if (what < 85) {
      send(Client::make_motion(MOVE_JOINTS, {0, 9999, 0, 0, 0, 0}, false));  // out of range
    } else if (what < 88) {
      send(CommandKind::CLEAR_MOTION);
    } else if (what < 92) {
      send(CommandKind::PAUSE_MOTION);
    } else {
      send(CommandKind::RESUME_MOTION);
    }
  }

  void reign() {
    send(CommandKind::RESUME_MOTION);
    for (const auto end = monotonic_now() + 50ms + 6ms * pick(100); monotonic_now() < end && !asked_to_end;) {
      renew();
      command();
      look_on(5ms, 60ms);
    }
    const int end = pick(100);
    if (end < 45) {
      send(CommandKind::RELEASE_CONTROL);
    } else if (end < 75) {
      look_on(150ms, 300ms);  // silent: the lease runs out
    } else if (!asked_to_end) {
      kill(getpid(), SIGKILL);
    }
  }

  int diary_;
  Client client_;
  std::mt19937 random_;
  std::set<std::uint64_t> open_, done_;
  std::chrono::nanoseconds next_renewal_{};
};

}  // namespace

void run_fighter(const FighterOptions& options) {
  signal(SIGTERM, [](int) { asked_to_end = true; });
  Fighter(options).run();
}

Diary read_diary(const std::filesystem::path& path) {
  Diary diary;
  std::vector<std::uint64_t> of_this_life;
  std::ifstream in(path);
  for (std::string word; in >> word;) {
    std::uint64_t id = 0;
    int number = 0, reason = 0;
    if (word == "life") {
      ++diary.lives;
      of_this_life.clear();
    } else if (word == "lived") {
      for (const auto known : of_this_life) diary.commands[known].lived = true;
    } else if (word == "sent" && in >> id >> number) {
      diary.commands[id].kind = static_cast<CommandKind>(number);
      of_this_life.push_back(id);
    } else if (word == "again" && in >> id) {
      ++diary.commands[id].resends;
    } else if (word == "seen" && in >> id >> number >> reason) {
      diary.commands[id].seen.push_back(
          {static_cast<ReceiptState>(number), static_cast<meca500::ReceiptReason>(reason)});
    }
  }
  return diary;
}

}  // namespace meca::bench
