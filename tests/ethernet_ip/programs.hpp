// A cell as its user starts it: meca-sim, meca-bridge and meca-ctl as programs, on addresses and topics of this test
// only.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/cli/process.hpp"
#include "tests/unit/net/temporary_directory.hpp"

namespace meca::test {

// Eight addresses of 127.128.0.0/10 for each process: test programs that run at the same time do not meet.
std::string own_address(unsigned which);
inline std::string bridge_address() { return own_address(0); }
inline std::string arm1_address() { return own_address(1); }
inline std::string arm2_address() { return own_address(2); }
inline std::string second_bridge_address() { return own_address(3); }

// True as soon as the condition holds; false when it has not come to hold within a minute.
bool eventually(const std::function<bool()>& condition);

// A robot that homes at once. Runs from the start.
class SimProgram {
 public:
  explicit SimProgram(const std::string& address, const std::vector<std::string>& more = {});
  void kill();   // as by `kill -9`
  void start();  // again
  // What the control socket answers, without the end of the line.
  std::string say(const std::string& words) const;

 private:
  TemporaryDirectory directory_;
  std::vector<std::string> words_;
  std::optional<Process> process_;
};

// One entry of `robots:`; `more` goes into its transport section, as in ", key: exact".
std::string robot(const std::string& name, const std::string& address, const std::string& more = "",
                  const std::string& cycle = "10ms");

class BridgeProgram {
 public:
  // `bus`: what the section ethernet_ip says. Runs from the start.
  BridgeProgram(const std::vector<std::string>& robots, const std::string& bus = "bind: " + bridge_address());
  void kill();
  void start();
  int stop();  // asks it to stop; its exit code
  int wait() { return process_->wait(); }
  const std::string& log() const { return process_->output(); }
  bool wait_for_log(const std::string& text) { return process_->wait_for_output(text); }

  // meca-ctl with these words, to its end, or beside the test.
  Result ctl(const std::vector<std::string>& words) const { return run(command(words)); }
  std::unique_ptr<Process> ctl_beside(const std::vector<std::string>& words) const {
    return std::make_unique<Process>(command(words));
  }
  nlohmann::json status(const std::string& robot = "arm1") const;
  bool until(const std::function<bool(const nlohmann::json&)>& condition, const std::string& robot = "arm1") const;
  bool until_up(const std::string& robot = "arm1") const;
  // The reason that BridgeStatus gives for a link that is not up.
  bool until_told(const std::string& reason, const std::string& robot = "arm1") const;

 private:
  std::vector<std::string> command(std::vector<std::string> words) const;

  TemporaryDirectory directory_;
  std::string prefix_;
  std::optional<Process> process_;
};

}  // namespace meca::test
