#include "tests/programs/programs.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "transports/net/line_client.hpp"

namespace meca::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 60s;  // the end of hope, not an expectation: a busy machine is slow

std::string program(const char* name) { return std::string(MECA_BINARY_DIR "/") + name; }

std::string next_prefix() {
  static int count = 0;
  return "programs_" + std::to_string(::getpid()) + "_" + std::to_string(++count) + "/";
}

}  // namespace

bool eventually(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(20ms);
  }
  return true;
}

// ---- meca-sim

Simulator::Simulator(std::vector<std::string> words, std::size_t robots, std::string ready)
    : words_{program("meca-sim"), "--instant-homing", "--no-noise", "--control"},
      robots_(robots),
      ready_(std::move(ready)) {
  words_.push_back(robots == 1 ? socket("arm1").string() : directory_.path().string());
  words_.insert(words_.end(), words.begin(), words.end());
  start();
}

std::filesystem::path Simulator::socket(const std::string& robot) const {
  return directory_ / (robots_ == 1 ? "sim.sock" : robot + ".sock");
}

void Simulator::kill() {
  process_->signal(SIGKILL);
  process_->wait();
}

void Simulator::start() {
  process_.emplace(words_);
  if (!process_->wait_for_output(ready_)) ADD_FAILURE() << process_->output();
}

int Simulator::stop() {
  process_->signal(SIGTERM);
  return process_->wait();
}

std::string Simulator::say(const std::string& words, const std::string& robot) const {
  auto client = net::LineClient::connect(socket(robot));
  std::string answer = client ? client->ask(words, kPatience).value_or("(no answer)") : "(nobody)";
  while (answer.ends_with('\n')) answer.pop_back();
  return answer;
}

// ---- meca-bridge

BridgeProcess::BridgeProcess(int domain, const std::string& sections)
    : domain_(std::to_string(domain)), prefix_(next_prefix()) {
  std::ofstream(directory_ / "bridge.yaml")
      << "dds: {domain: " << domain_ << ", interfaces: [127.0.0.1], topic_prefix: " << prefix_ << "}\n"
      << sections;
  start();
}

void BridgeProcess::kill() {
  process_->signal(SIGKILL);
  process_->wait();
}

void BridgeProcess::start() {
  process_.emplace(std::vector<std::string>{program("meca-bridge"), "--config", (directory_ / "bridge.yaml").string()});
}

int BridgeProcess::stop() {
  process_->signal(SIGTERM);
  return process_->wait();
}

std::vector<std::string> BridgeProcess::command(std::vector<std::string> words) const {
  words.insert(words.begin(),
               {program("meca-ctl"), "--domain", domain_, "--interface", "127.0.0.1", "--prefix", prefix_});
  return words;
}

nlohmann::json BridgeProcess::status(const std::string& robot) const {
  nlohmann::json out;
  EXPECT_TRUE(eventually([&] {
    const Result result = ctl({"status", "--json", "--robot", robot});
    if (result.exit_code != 0) return false;
    out = nlohmann::json::parse(result.output);
    return out.contains("bridge_status") && out.contains("robot_status") && out.contains("motion_status") &&
           out.contains("target_joint_set") && out.contains("control_status");
  })) << robot;
  return out;
}

bool BridgeProcess::until(const std::function<bool(const nlohmann::json&)>& condition, const std::string& robot) const {
  return eventually([&] { return condition(status(robot)); });
}

bool BridgeProcess::until_up(const std::string& robot) const {
  return until(
      [](const auto& now) {
        return now["bridge_status"]["link"] == "LINK_UP" && now["bridge_status"]["firmware_known"] == true &&
               now["robot_status"]["header"]["quality"] == "GOOD";
      },
      robot);
}

bool BridgeProcess::until_told(const std::string& reason, const std::string& robot) const {
  return until(
      [&](const auto& now) {
        const auto& bridge = now["bridge_status"];
        return bridge["link"] != "LINK_UP" &&
               bridge["link_detail"].template get<std::string>().find(reason) != std::string::npos;
      },
      robot);
}

}  // namespace meca::test
