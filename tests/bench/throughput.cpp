#include "tests/bench/throughput.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/bridge_process.hpp"
#include "tests/bench/client.hpp"
#include "tests/bench/clock.hpp"
#include "tests/bench/ethercat_cable.hpp"

namespace meca::bench {
namespace {

using namespace std::chrono_literals;
using json = nlohmann::ordered_json;
using meca500::ReceiptState;

constexpr double kPromised = 0.9;
constexpr std::uint64_t kUnderWay = 200;  // the ledger remembers 256 of a client

class Sender {
 public:
  Sender(int domain, bool moves, bool report_completion)
      : client_(domain, "bench-throughput"),
        status_(client_.participant().create_reader<meca500::BridgeStatus>("meca500/BridgeStatus", {})),
        command_(moves
                     ? Client::make_motion(meca500::MotionCommandId::MOVE_JOINTS, {0, 0, 0, 0, 0, 0}, report_completion)
                     : Client::make_motion(meca500::MotionCommandId::SET_JOINT_VEL, {50}, report_completion)) {}

  json run(std::chrono::seconds duration) {
    prepare();
    for (const auto end = monotonic_now() + duration; monotonic_now() < end;) {
      while (last_sent_ - last_ended_ < kUnderWay) last_sent_ = client_.send(command_);
      read();
    }
    for (const auto patience = monotonic_now() + 20s; last_ended_ < last_sent_ && monotonic_now() < patience;) {
      client_.renew();
      read();
    }
    if (last_ended_ < last_sent_) throw std::runtime_error("not every command ended within 20 s");
    const auto commands = last_taken_.id - first_taken_.id;
    const auto cycles = last_taken_.cycle - first_taken_.cycle;
    return {{"commands", commands},
            {"cycles", cycles},
            {"commands_per_second",
             1e9 * static_cast<double>(commands) / static_cast<double>(last_taken_.time_ns - first_taken_.time_ns)},
            {"refused", refused_},
            {"missed_cycles", missed()}};
  }

 private:
  struct Taken {
    std::uint64_t id = 0, cycle = 0;
    std::int64_t time_ns = 0;
  };

  void prepare() {
    client_.prepare_robot();
    client_.finish(Client::make_motion(meca500::MotionCommandId::MOVE_JOINTS, {0, 0, 0, 0, 0, 0}, true));
    missed_before_ = missed();
    last_sent_ = last_ended_ = client_.reserve_id();
  }

  void read() {
    client_.wait(1ms);
    client_.take_receipts([&](const meca500::CommandReceipt& r) {
      if (r.state() == ReceiptState::SENT) {
        last_taken_ = {r.command_id(), r.cycle(), r.time_ns()};
        if (first_taken_.id == 0) first_taken_ = last_taken_;
      }
      // They end in the order of their ids: where a receipt was lost on the way, a later one says the same.
      if (is_terminal(r.state())) last_ended_ = std::max(last_ended_, r.command_id());
      refused_ += r.state() > ReceiptState::COMPLETED;
    });
    missed();
  }

  std::uint64_t missed() {
    meca500::BridgeStatus status;
    dds::SampleInfo info;
    while (status_.take(status, info)) {
      if (info.valid_data) missed_now_ = status.missed_cycles();
    }
    return missed_now_ - missed_before_;
  }

  Client client_;
  dds::Reader<meca500::BridgeStatus> status_;
  meca500::Command command_;
  std::uint64_t last_sent_ = 0, last_ended_ = 0;  // command ids
  Taken first_taken_, last_taken_;
  long refused_ = 0;
  std::uint64_t missed_now_ = 0, missed_before_ = 0;
};

struct Robot {
  std::string configuration;         // of the bridge
  std::vector<std::string> program;  // the robot's own, where it has one; started anew for each measurement
  int cycles_per_command = 1;
};

json measure(const Setting& setting, const Robot& robot, bool moves, bool report_completion) {
  std::optional<Process> program;
  if (!robot.program.empty()) program.emplace(robot.program);
  BridgeProcess bridge(setting, robot.configuration);
  auto words = role("throughput-client", setting);
  words.insert(words.end(), {"--seconds", std::to_string(setting.duration.count())});
  if (moves) words.push_back("--moves");
  if (report_completion) words.push_back("--report-completion");
  Process client(words);
  json row = json::parse(client.finish());
  bridge.process.stop();
  const int cycles_per_command = robot.cycles_per_command * (report_completion ? 2 : 1);
  row["cycles_per_command"] = cycles_per_command;
  row["of_the_bound"] = row["commands"].get<double>() * cycles_per_command / row["cycles"].get<double>();
  return row;
}

std::string configuration(const Setting& setting, const std::string& transport) {
  return dds_on_loopback(setting.domain) + "log: {level: error}\nrobots:\n  - name: " + kRobot +
         "\n    cycle: 1ms\n    transport: " + transport + "\n";
}

Proof prove_throughput(const Setting& setting, const Robot& robot) {
  Proof proof;
  for (const bool moves : {false, true}) {
    for (const bool report_completion : {false, true}) {
      const std::string name =
          std::string(moves ? "MoveJoints" : "SetJointVel") + (report_completion ? " to completion" : "");
      std::fprintf(stderr, "throughput: %s\n", name.c_str());
      json& row = proof.figures[name] = measure(setting, robot, moves, report_completion);
      proof.expect(row["of_the_bound"] >= kPromised,
                   name + ": " + row["of_the_bound"].dump() + " of what the handshake allows, promised 0.9");
      proof.expect(row["refused"] == 0, name + ": " + row["refused"].dump() + " commands were refused or dropped");
    }
  }
  return proof;
}

}  // namespace

void run_throughput_client(int domain, bool moves, bool report_completion, std::chrono::seconds duration) {
  std::printf("%s\n", Sender(domain, moves, report_completion).run(duration).dump().c_str());
}

Proof prove_throughput(const Setting& setting) {
  Robot robot;
  robot.configuration = configuration(setting, "{type: builtin, instant_homing: true}");
  return prove_throughput(setting, robot);
}

Proof prove_ethercat_throughput(const Setting& setting) {
  const EthercatCable cable;
  const std::string interface = kMasterInterface;
  Robot robot;
  robot.configuration = configuration(setting, "{type: ethercat, interface: " + interface + ", position: 0}") +
                        "ethercat: {segments: [{interface: " + interface + ", watchdog: 500ms}]}\n";
  robot.program = {(setting.bridge.parent_path() / "meca-sim").string(),
                   "--protocol",
                   "ethercat",
                   "--interface",
                   kRobotInterface,
                   "--instant-homing",
                   "--control",
                   "off",
                   "--log-level",
                   "error"};
  robot.cycles_per_command = 2;
  return prove_throughput(setting, robot);
}

}  // namespace meca::bench
