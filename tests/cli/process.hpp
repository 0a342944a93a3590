// Programs as a shell would run them: start, wait for the end, signal; output as text. Ends what it started.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace meca::test {

class Process {
 public:
  explicit Process(const std::vector<std::string>& words);  // program and arguments; throws std::runtime_error
  ~Process();                                               // SIGKILL when it still runs
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const;
  int wait();  // exit code, or 128 + signal; the same again when it has ended
  // Reads until the text has come or the program has ended; true when it has come.
  bool wait_for_output(const std::string& text);

  const std::string& output() const { return output_; }  // standard output and standard error, so far

 private:
  bool read_more();

  pid_t pid_ = -1;
  int exit_code_ = -1;
  int pipe_ = -1;
  std::string output_;
};

struct Result {
  int exit_code = -1;
  std::string output;
};
Result run(const std::vector<std::string>& words);

}  // namespace meca::test
