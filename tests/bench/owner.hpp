// An owner that is going to die: a process of its own that takes control, resumes the robot, streams motion and renews
// its lease from its main loop, until it is killed, stopped, or told to hang.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

namespace meca::bench {

// Memory shared with the process that watches. Stamps written here survive whatever happens to the owner.
struct OwnerBoard {
  enum Phase : std::uint32_t { kStarting, kStandby, kStreaming, kFailed };
  std::atomic<std::uint32_t> phase{kStarting};
  std::atomic<bool> go{false};    // take control now
  std::atomic<bool> hang{false};  // block the main loop for ever; the process and its DDS threads live on
  // Unix ns just before the last sign of life whose write() returned: never later than the bridge could receive it.
  std::atomic<std::int64_t> last_sent_ns{0};
  std::atomic<std::uint64_t> first_resume_id{0}, first_motion_id{0};  // command ids; 0 = not sent yet
  char problem[256] = {};
};

// A board in a file, mapped by both processes; the one that made it removes it.
class SharedBoard {
 public:
  static SharedBoard make(const std::filesystem::path& path);  // throws std::runtime_error
  static SharedBoard open(const std::filesystem::path& path);  // throws std::runtime_error
  SharedBoard(SharedBoard&& other) noexcept;
  SharedBoard& operator=(SharedBoard&&) = delete;
  ~SharedBoard();
  OwnerBoard* operator->() const { return board_; }

 private:
  SharedBoard(std::filesystem::path path, bool make);
  std::filesystem::path path_;
  bool made_ = false;
  OwnerBoard* board_ = nullptr;
};

struct OwnerOptions {
  int domain = 0;
  std::string name;
  std::filesystem::path board;
  bool velocity = false;  // a velocity stream, which is its only sign of life; else queued MoveJoints and ControlLease
};

// Does not return before it dies, unless something goes wrong: then the board says what.
void run_owner(const OwnerOptions& options);

}  // namespace meca::bench
