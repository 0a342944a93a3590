// meca-bridge from the outside: what it answers to arguments, files and signals.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

extern char** environ;

namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
namespace fs = std::filesystem;

const std::string kSource = MECA_SOURCE_DIR;

struct Outcome {
  int exit_code = -1;  // -1: ended by a signal
  std::string out, err;
};

// Reads both pipes to their ends. When `until` has appeared on stderr, sends `signal`, once. A program that says
// nothing for a minute is killed, so that a failure ends.
void listen(pid_t pid, int out_fd, int err_fd, const std::string& until, int signal, Outcome& outcome) {
  std::array<pollfd, 2> fds{pollfd{out_fd, POLLIN, 0}, pollfd{err_fd, POLLIN, 0}};
  bool sent = signal == 0;
  while (fds[0].fd >= 0 || fds[1].fd >= 0) {
    if (poll(fds.data(), fds.size(), 60'000) <= 0) kill(pid, SIGKILL);
    for (std::size_t i = 0; i < fds.size(); ++i) {
      if (fds[i].fd < 0 || fds[i].revents == 0) continue;
      std::array<char, 4096> buffer{};
      const ssize_t size = read(fds[i].fd, buffer.data(), buffer.size());
      if (size <= 0)
        fds[i].fd = -1;
      else
        (i == 0 ? outcome.out : outcome.err).append(buffer.data(), static_cast<std::size_t>(size));
    }
    if (!sent && outcome.err.find(until) != std::string::npos) {
      kill(pid, signal);
      sent = true;
    }
  }
}

Outcome meca_bridge(std::vector<std::string> arguments, const std::string& until = {}, int signal = 0) {
  arguments.insert(arguments.begin(), std::string(MECA_BINARY_DIR) + "/meca-bridge");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  std::array<int, 2> out{}, err{};
  if (pipe2(out.data(), O_CLOEXEC) != 0 || pipe2(err.data(), O_CLOEXEC) != 0) return {};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
  pid_t pid = 0;
  const int spawned = posix_spawn(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(out[1]);
  close(err[1]);
  Outcome outcome;
  if (spawned == 0) {
    listen(pid, out[0], err[0], until, signal, outcome);
    int status = 0;
    waitpid(pid, &status, 0);
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  }
  close(out[0]);
  close(err[0]);
  return outcome;
}

// A file that is gone with the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(fs::temp_directory_path() / ("meca-" + std::to_string(getpid()) + ".yaml")) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { fs::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

constexpr const char* kOneRobot = "robots: [{name: arm1, transport: {type: builtin}}]\n";

TEST(Program, ExplainsItselfWithExamples) {
  const Outcome help = meca_bridge({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("meca-bridge --check --config cell.yaml"));
  EXPECT_THAT(help.out, HasSubstr("Exit codes: 0"));
  EXPECT_THAT(help.out, HasSubstr("no safety function"));
  EXPECT_THAT(help.err, IsEmpty());
}

TEST(Program, SaysItsVersion) {
  const Outcome version = meca_bridge({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, testing::MatchesRegex("meca-bridge [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(Program, LeavesWithTwoWhenItsArgumentsAreWrong) {
  const std::string next = "\nmeca-bridge --help shows the options and examples\n";
  const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes{
      {{"--chekc"}, "did you mean '--check'?" + next},
      {{"cell.yaml"}, "did you mean '--config cell.yaml'?" + next},
      {{"--config"}, "FILE missing" + next},
      {{"--config", "cell.yaml", "--log-level", "loud"}, next},
  };
  for (const auto& [arguments, ending] : mistakes) {
    const Outcome outcome = meca_bridge(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments.front();
    EXPECT_THAT(outcome.err, StartsWith("meca-bridge: "));
    EXPECT_THAT(outcome.err, testing::EndsWith(ending));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

TEST(Program, AsksForAConfigurationWhenThereIsNoDefaultOne) {
  if (fs::exists("/etc/meca500/bridge.yaml")) GTEST_SKIP() << "this machine has a default configuration";
  const Outcome outcome = meca_bridge({});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no --config FILE given, and there is no /etc/meca500/bridge.yaml"));
}

TEST(Program, LeavesWithThreeAndAllLettersWhenTheConfigurationIsWrong) {
  const std::string file = kSource + "/tests/config/bad/everything_at_once.yaml";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--config", file}, {"--check", "--config", file}}) {
    const Outcome outcome = meca_bridge(arguments);
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_THAT(outcome.err, HasSubstr(file + ":2:3: dds.domian: unknown key, did you mean 'domain'?\n"));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 8);
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

TEST(Program, LeavesWithThreeWhenTheFileIsNotThere) {
  const Outcome outcome = meca_bridge({"--config", "/nowhere/cell.yaml"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, StartsWith("/nowhere/cell.yaml: cannot be read: "));
}

TEST(Program, ChecksEveryFileOfTheConfigFolderAndSaysWhatItWouldRun) {
  for (const char* name : {"builtin.yaml", "cell.yaml", "reference.yaml"}) {
    const std::string file = kSource + "/config/" + name;
    const Outcome outcome = meca_bridge({"--check", "--config", file});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, StartsWith(file + ": good\nDDS domain 0, topics meca500/..., interfaces all over UDP\n"
                                               "arm1: builtin (simulated Meca500 R4, firmware 11.3, serial number 1"));
    EXPECT_THAT(outcome.out, HasSubstr("), cycle 1ms, control on\n"));
    EXPECT_THAT(outcome.err, IsEmpty());
  }
}

TEST(Program, SaysHowItWouldReachARobotOnEtherNetIp) {
  const Outcome outcome = meca_bridge({"--check", "--config", kSource + "/config/ethernet_ip.yaml"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("arm1: ethernet_ip (192.168.0.100:44818, RPI 10ms, watchdog 160ms), cycle 10ms, "
                                     "control on\n"));
}

TEST(Program, PrintsWarningsAndRunsAllTheSame) {
  const TemporaryFile file("dds: {topics: {RobotStatus: {rate: 500us}}}\n" + std::string(kOneRobot));
  const Outcome outcome = meca_bridge({"--check", "--config", file.path()});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err,
              StartsWith("warning: " + file.path() + ":1:36: dds.topics.RobotStatus.rate: 500us is shorter"));
}

TEST(Program, LeavesWithFourWhenDdsCannotBeOpened) {
  // 203.0.113.7: TEST-NET-3 (RFC 5737), no machine has it.
  const TemporaryFile file("dds: {domain: 43, interfaces: [203.0.113.7]}\n" + std::string(kOneRobot));
  const Outcome outcome = meca_bridge({"--config", file.path()});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("203.0.113.7"));
}

constexpr const char* kOneAbsentRobot =
    "dds: {domain: 43, interfaces: [127.0.0.1]}\n"
    "robots: [{name: arm1, transport: {type: ethernet_ip, address: 127.0.11.2}}]\n";

TEST(Program, LeavesWithFourWhenTheAddressOfTheFieldbusIsNotOurs) {
  const TemporaryFile file("ethernet_ip: {bind: 203.0.113.7}\n" + std::string(kOneAbsentRobot));
  const Outcome outcome = meca_bridge({"--config", file.path()});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("EtherNet/IP: 203.0.113.7 is not an address of this machine\n"));
}

TEST(Program, WaitsForARobotThatIsNotThereAndLeavesWithZeroWhenAskedToStop) {
  const TemporaryFile file("ethernet_ip: {bind: 127.0.11.1}\n" + std::string(kOneAbsentRobot));
  const Outcome outcome = meca_bridge({"--config", file.path()}, "arm1: no link yet", SIGTERM);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::EndsWith("info stopped\n"));
}

TEST(Program, RunsUntilItIsAskedToStopAndLeavesWithZero) {
  const TemporaryFile file("dds: {domain: 43, interfaces: [127.0.0.1]}\n" + std::string(kOneRobot));
  for (const int signal : {SIGTERM, SIGINT}) {
    const Outcome outcome = meca_bridge({"--config", file.path()}, "arm1: builtin", signal);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err,
                HasSubstr("arm1: builtin (simulated Meca500 R4, firmware 11.3, serial number 1), cycle 1ms"));
    EXPECT_THAT(outcome.err, testing::EndsWith("info stopped\n"));
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("meca-ctl"))) << "hints are for terminals only";
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

TEST(Program, LogsOnlyWhatTheCommandLineAsksFor) {
  const TemporaryFile file("dds: {domain: 43, interfaces: [203.0.113.7]}\nlog: {level: trace}\n" +
                           std::string(kOneRobot));
  EXPECT_THAT(meca_bridge({"--config", file.path(), "--log-level", "off"}).err, IsEmpty());
}

}  // namespace
