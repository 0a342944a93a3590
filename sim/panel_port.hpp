// Carries requests to the thread that steps a simulated robot, and answers back: neither side ever waits in here.
#pragma once

#include "sim/panel.hpp"
#include "transports/spsc_queue.hpp"

namespace meca::sim {

class PanelPort {
 public:
  // The asking thread. False: the queue is full, nobody steps the robot.
  bool ask(const PanelRequest& request) noexcept { return requests_.push({++asked_, request}); }
  // The asking thread. The answer to the request asked last, or nullptr while there is none; valid until the next
  // call. Answers to earlier requests, given up since, are dropped.
  const PanelAnswer* answer() noexcept {
    while (const Answer* next = answers_.front()) {
      answer_ = *next;
      answers_.pop();
      if (answer_.number == asked_) return &answer_.answer;
    }
    return nullptr;
  }

  // The thread that steps the robot, before each step: at most one request, so that the next one sees what this one
  // did.
  void serve(Robot& robot, NetworkFaults* network = nullptr) noexcept {
    const Request* next = requests_.front();
    if (next == nullptr || answers_.size() == answers_.capacity()) return;
    work_.number = next->number;
    apply(next->request, robot, network, work_.answer);
    requests_.pop();
    answers_.push(work_);
  }

 private:
  static constexpr std::size_t kCapacity = 4;
  struct Request {
    std::uint64_t number;
    PanelRequest request;
  };
  struct Answer {
    std::uint64_t number;
    PanelAnswer answer;
  };

  transports::SpscQueue<Request> requests_{kCapacity};
  transports::SpscQueue<Answer> answers_{kCapacity};
  std::uint64_t asked_ = 0;  // the asking thread's
  Answer answer_{};          // the asking thread's
  Answer work_{};            // the stepping thread's
};

}  // namespace meca::sim
