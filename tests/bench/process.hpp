// Child processes of the bench: started, measured and stopped by us, so that no figure includes our own work.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace meca::bench {

// A child whose standard output we read at its end. Killed when the object goes, and when this process dies.
class Process {
 public:
  explicit Process(const std::vector<std::string>& command);  // throws std::runtime_error
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const;
  bool running();
  // User plus system time of all its threads so far, seconds.
  double cpu_seconds() const;
  // Waits for the end and returns what it printed. Throws std::runtime_error when it failed.
  std::string finish();
  // SIGTERM, then wait.
  void stop();
  // SIGKILL, then wait. Once is enough.
  void kill();

 private:
  std::string name_;
  pid_t pid_ = -1;
  int output_ = -1;
};

// Path of this program, for starting itself in another role.
std::string own_path();

}  // namespace meca::bench
