// A cell on EtherCAT as its user starts it: robots on one virtual cable, or on a ring of two, with their bridge at the
// other end, in a network namespace of this test.
#pragma once

#include <gtest/gtest.h>

#include <iostream>

#include "tests/network_namespace.hpp"
#include "tests/programs/programs.hpp"

namespace meca::test {

// Of a status that meca-ctl printed.
inline int images(const nlohmann::json& status) { return status["bridge_status"]["fresh_images"].get<int>(); }
inline int counter(const nlohmann::json& status, const char* name) {
  const auto& counters = status["bridge_status"]["transport_counters"];
  return counters.empty() ? 0 : counters.at(name).get<int>();  // none at first; a name that there is not is a mistake
}

class EthercatCell : public testing::Test {
 protected:
  static constexpr const char* kInterface = "meca0";
  static constexpr int kDomain = 74;

  void SetUp() override {
    if (!network_.usable()) GTEST_SKIP() << kNoNamespace;
    network_.cable(kInterface, "meca1");
    network_.cable("ring0", "ring1");
  }

  // What both said is the better half of an explanation.
  void TearDown() override {
    if (!HasFailure()) return;
    if (bridge_) {
      bridge_->stop();
      std::cout << "meca-bridge said:\n" << bridge_->log();
    }
    if (sim_) {
      sim_->stop();
      std::cout << "meca-sim said:\n" << sim_->log();
    }
  }

  // arm1, arm2, ... at the robots' ends.
  Simulator& start_robots(std::size_t count, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"--protocol", "ethercat", "--interface", "meca1", "--count", std::to_string(count)};
    words.insert(words.end(), more.begin(), more.end());
    return sim_.emplace(words, count, "position " + std::to_string(count - 1));
  }

  // At 1 kHz. `segment`: more keys of the segment, as in ", redundant_interface: ring0". The watchdog and the lease
  // leave a busy machine its time.
  BridgeProcess& start_bridge(std::size_t robots, const std::string& segment = "") {
    std::string text = "ethercat: {segments: [{interface: meca0, watchdog: 1s" + segment + "}]}\nrobots:\n";
    for (std::size_t i = 0; i < robots; ++i) {
      text += "  - {name: arm" + std::to_string(i + 1) +
              ", transport: {type: ethercat, interface: meca0, position: " + std::to_string(i) +
              "}, cycle: 1ms, control: {lease: 2s, velocity_lease: 1s}}\n";
    }
    return bridge_.emplace(kDomain, text);
  }

  // meca-ctl with these words for this robot, which have to succeed.
  void ctl(const std::string& robot, std::vector<std::string> words) {
    words.insert(words.begin(), {"--robot", robot});
    const Result result = bridge_->ctl(words);
    EXPECT_EQ(result.exit_code, 0) << result.output;
  }
  void make_ready(const std::string& robot) {
    EXPECT_TRUE(bridge_->until_up(robot));
    ctl(robot, {"activate"});
    ctl(robot, {"home"});
  }
  void move(const std::string& robot) { ctl(robot, {"--wait", "move-joints", "--", "-10", "5", "5", "0", "20", "0"}); }
  // On a move that takes minutes.
  std::unique_ptr<Process> under_way(const std::string& robot) {
    make_ready(robot);
    ctl(robot, {"--wait", "send", "SetJointVel", "0.1"});
    auto mover =
        bridge_->ctl_beside({"--robot", robot, "--wait", "move-joints", "--", "-100", "0", "0", "0", "0", "0"});
    EXPECT_TRUE(mover->wait_for_output("acknowledged")) << mover->output();
    return mover;
  }
  // Over a hundred images.
  void expect_standstill(const std::string& robot) {
    ASSERT_TRUE(bridge_->until_up(robot));
    const nlohmann::json before = bridge_->status(robot);
    nlohmann::json after;
    ASSERT_TRUE(bridge_->until(
        [&](const nlohmann::json& now) {
          after = now;
          return images(now) >= images(before) + 100;
        },
        robot));
    EXPECT_EQ(after["target_joint_set"]["joints"], before["target_joint_set"]["joints"]);
    EXPECT_EQ(after["motion_status"]["fifo_space"], 13000);
  }
  int losses(const std::string& robot) { return bridge_->status(robot)["bridge_status"]["link_losses"].get<int>(); }

  NetworkNamespace network_;
  std::optional<Simulator> sim_;
  std::optional<BridgeProcess> bridge_;
};

}  // namespace meca::test
