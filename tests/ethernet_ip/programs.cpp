#include "tests/ethernet_ip/programs.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "transports/net/ipv4.hpp"
#include "transports/net/line_client.hpp"

namespace meca::test {
namespace {

using namespace std::chrono_literals;

constexpr const char* kDomain = "72";
constexpr auto kPatience = 60s;  // the end of hope, not an expectation: a busy machine is slow

std::string program(const char* name) { return std::string(MECA_BINARY_DIR "/") + name; }

std::string next_prefix() {
  static int count = 0;
  return "eip_" + std::to_string(::getpid()) + "_" + std::to_string(++count) + "/";
}

}  // namespace

std::string own_address(unsigned which) {
  return net::to_string(0x7F800000u | ((static_cast<unsigned>(::getpid()) * 8 + which) & 0x3FFFFFu));
}

bool eventually(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(20ms);
  }
  return true;
}

// ---- meca-sim

SimProgram::SimProgram(const std::string& address, const std::vector<std::string>& more)
    : words_{program("meca-sim"),
             "--bind",
             address,
             "--instant-homing",
             "--no-noise",
             "--control",
             (directory_ / "sim.sock").string()} {
  words_.insert(words_.end(), more.begin(), more.end());
  start();
}

void SimProgram::kill() {
  process_->signal(SIGKILL);
  process_->wait();
}

void SimProgram::start() {
  process_.emplace(words_);
  if (!process_->wait_for_output("EtherNet/IP at ")) ADD_FAILURE() << process_->output();
}

std::string SimProgram::say(const std::string& words) const {
  auto client = net::LineClient::connect(directory_ / "sim.sock");
  std::string answer = client ? client->ask(words, kPatience).value_or("(no answer)") : "(nobody)";
  while (answer.ends_with('\n')) answer.pop_back();
  return answer;
}

// ---- meca-bridge

// The watchdog and the lease leave a busy machine its time.
std::string robot(const std::string& name, const std::string& address, const std::string& more,
                  const std::string& cycle) {
  return "  - {name: " + name + ", transport: {type: ethernet_ip, address: " + address +
         ", timeout_multiplier: " + (cycle == "10ms" ? "256" : "64") + more + "}, cycle: " + cycle +
         ", control: {lease: 2s, velocity_lease: 1s}}\n";
}

BridgeProgram::BridgeProgram(const std::vector<std::string>& robots, const std::string& bus) : prefix_(next_prefix()) {
  std::ofstream file(directory_ / "bridge.yaml");
  file << "dds: {domain: " << kDomain << ", interfaces: [127.0.0.1], topic_prefix: " << prefix_ << "}\n"
       << "ethernet_ip: {" << bus << "}\nrobots:\n";
  for (const auto& each : robots) file << each;
  file.close();
  start();
}

void BridgeProgram::kill() {
  process_->signal(SIGKILL);
  process_->wait();
}

void BridgeProgram::start() {
  process_.emplace(std::vector<std::string>{program("meca-bridge"), "--config", (directory_ / "bridge.yaml").string()});
}

int BridgeProgram::stop() {
  process_->signal(SIGTERM);
  return process_->wait();
}

std::vector<std::string> BridgeProgram::command(std::vector<std::string> words) const {
  words.insert(words.begin(),
               {program("meca-ctl"), "--domain", kDomain, "--interface", "127.0.0.1", "--prefix", prefix_});
  return words;
}

nlohmann::json BridgeProgram::status(const std::string& robot) const {
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

bool BridgeProgram::until(const std::function<bool(const nlohmann::json&)>& condition, const std::string& robot) const {
  return eventually([&] { return condition(status(robot)); });
}

bool BridgeProgram::until_up(const std::string& robot) const {
  return until(
      [](const auto& now) {
        return now["bridge_status"]["link"] == "LINK_UP" && now["bridge_status"]["firmware_known"] == true &&
               now["robot_status"]["header"]["quality"] == "GOOD";
      },
      robot);
}

bool BridgeProgram::until_told(const std::string& reason, const std::string& robot) const {
  return until(
      [&](const auto& now) {
        const auto& bridge = now["bridge_status"];
        return bridge["link"] != "LINK_UP" &&
               bridge["link_detail"].template get<std::string>().find(reason) != std::string::npos;
      },
      robot);
}

}  // namespace meca::test
