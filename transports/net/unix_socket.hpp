// Unix stream sockets with a place in the file system. Errors are std::runtime_error with a sentence that names the
// path.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "transports/net/file.hpp"

namespace meca::net {

inline constexpr std::size_t kLongestSocketPath = 107;  // sun_path of Linux, without its end

// Listens at a path of mode 0600, not blocking. Takes the place of a socket that nobody listens on any more, refuses to
// take it from a living one and from a file of another kind. Takes the file away at the end.
class UnixListener {
 public:
  explicit UnixListener(std::filesystem::path path);  // throws std::runtime_error
  ~UnixListener();
  UnixListener(const UnixListener&) = delete;
  UnixListener& operator=(const UnixListener&) = delete;

  int get() const noexcept { return socket_.get(); }
  std::optional<File> accept() const noexcept;  // a client that does not block; empty when none is waiting
  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
  File socket_;
  unsigned long long device_ = 0, inode_ = 0;  // of the file we made
};

// A connection, not blocking, to whoever listens there; empty when nobody does or too many wait already.
std::optional<File> connect_unix(const std::filesystem::path& path) noexcept;
bool is_listened_on(const std::filesystem::path& path) noexcept;  // by a process that is alive, however busy

// Where the control sockets of this user's simulated robots are looked for: $XDG_RUNTIME_DIR/meca500 where that
// variable names a directory, then /tmp/meca500-<uid>. The first that can be had is used to listen; clients look into
// all.
std::vector<std::filesystem::path> control_directories();

// Makes it with mode 0700 unless it is there; throws std::runtime_error when it cannot be made, or is not a directory
// that belongs to this user alone: whoever may write there could put a socket of his own into our place.
void make_private_directory(const std::filesystem::path& directory);
bool is_private_directory(const std::filesystem::path& directory) noexcept;

}  // namespace meca::net
