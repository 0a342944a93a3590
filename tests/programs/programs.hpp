// A cell as its user starts it: meca-sim, meca-bridge and meca-ctl as programs, on topics of this test only.
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

// True as soon as the condition holds; false when it has not come to hold within a minute.
bool eventually(const std::function<bool()>& condition);

// meca-sim with robots that home at once. Runs from the start.
class Simulator {
 public:
  // `robots`: as many control sockets as there are. `ready`: what it says once it is ready for a bridge.
  Simulator(std::vector<std::string> words, std::size_t robots, std::string ready);
  void kill();   // as by `kill -9`
  void start();  // again
  int stop();    // asks it to stop; its exit code
  // What the control socket of a robot answers, without the end of the line.
  std::string say(const std::string& words, const std::string& robot = "arm1") const;
  const std::string& log() const { return process_->output(); }

 private:
  std::filesystem::path socket(const std::string& robot) const;

  TemporaryDirectory directory_;
  std::vector<std::string> words_;
  std::size_t robots_;
  std::string ready_;
  std::optional<Process> process_;
};

// meca-bridge, and meca-ctl that speaks to it. Runs from the start.
class BridgeProcess {
 public:
  // `sections`: of the configuration, beside that of DDS.
  BridgeProcess(int domain, const std::string& sections);
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
  std::string domain_, prefix_;
  std::optional<Process> process_;
};

}  // namespace meca::test
