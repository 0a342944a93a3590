#include "transports/net/unix_socket.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

namespace meca::net {
namespace {

namespace fs = std::filesystem;

constexpr int kBacklog = 16;

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw std::runtime_error("'" + path.string() + "' " + why);
}
std::string reason() { return std::generic_category().message(errno); }

// False when the path is too long for a socket.
bool make_address(const fs::path& path, sockaddr_un& address) noexcept {
  const std::string& text = path.native();
  if (text.empty() || text.size() > kLongestSocketPath) return false;
  address = {};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, text.c_str(), text.size() + 1);
  return true;
}

File make_socket(int flags) noexcept { return File(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | flags, 0)); }

// Two that start at once over one dead socket must not both find it dead: looking and taking is one step.
File lock_directory(const fs::path& path) {
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  File directory(::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!directory) fail(path, "cannot be made: " + reason());
  if (::flock(directory.get(), LOCK_EX) != 0) fail(path, "cannot be made, its directory cannot be locked: " + reason());
  return directory;
}

void take_away_dead(const fs::path& path) {
  struct stat file {};
  if (::lstat(path.c_str(), &file) != 0) {
    if (errno == ENOENT) return;
    fail(path, "cannot be made: " + reason());
  }
  if (!S_ISSOCK(file.st_mode)) fail(path, "exists and is not a socket; remove it, or choose another path");
  if (is_listened_on(path)) fail(path, "is in use by another process that is alive");
  if (::unlink(path.c_str()) != 0)
    fail(path, "is left over from a process that died, and cannot be removed: " + reason());
}

}  // namespace

UnixListener::UnixListener(fs::path path) : path_(std::move(path)) {
  sockaddr_un address{};
  if (!make_address(path_, address)) {
    fail(path_, "has " + std::to_string(path_.native().size()) + " bytes; the path of a socket has 1 to " +
                    std::to_string(kLongestSocketPath));
  }
  const File lock = lock_directory(path_);
  take_away_dead(path_);
  socket_ = make_socket(SOCK_NONBLOCK);
  if (!socket_) fail(path_, "cannot be made, no socket: " + reason());
  if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    fail(path_, "cannot be made: " + reason());
  }
  // Nobody can connect before listen(), so nobody gets in between bind and chmod.
  struct stat file {};
  const bool ready =
      ::chmod(path_.c_str(), 0600) == 0 && ::stat(path_.c_str(), &file) == 0 && ::listen(socket_.get(), kBacklog) == 0;
  if (!ready) {
    const std::string why = reason();
    ::unlink(path_.c_str());
    fail(path_, "cannot be listened on: " + why);
  }
  device_ = file.st_dev;
  inode_ = file.st_ino;
}

UnixListener::~UnixListener() {
  struct stat file {};
  // Only what is still ours: somebody may have put another file there.
  if (::lstat(path_.c_str(), &file) == 0 && file.st_dev == device_ && file.st_ino == inode_) ::unlink(path_.c_str());
}

std::optional<File> UnixListener::accept() const noexcept {
  File client(::accept4(socket_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  return client ? std::optional<File>(std::move(client)) : std::nullopt;
}

std::optional<File> connect_unix(const fs::path& path) noexcept {
  sockaddr_un address{};
  if (!make_address(path, address)) return std::nullopt;
  File socket = make_socket(SOCK_NONBLOCK);
  if (!socket || ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return std::nullopt;
  }
  return socket;
}

bool is_listened_on(const fs::path& path) noexcept {
  errno = 0;
  return connect_unix(path) || errno == EAGAIN;  // EAGAIN: its backlog is full
}

std::vector<fs::path> control_directories() {
  std::vector<fs::path> directories;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  std::error_code ignored;
  if (runtime != nullptr && *runtime == '/' && fs::is_directory(runtime, ignored)) {
    directories.push_back(fs::path(runtime) / "meca500");
  }
  directories.push_back("/tmp/meca500-" + std::to_string(::getuid()));
  return directories;
}

bool is_private_directory(const fs::path& directory) noexcept {
  struct stat file {};
  return ::lstat(directory.c_str(), &file) == 0 && S_ISDIR(file.st_mode) && file.st_uid == ::getuid() &&
         (file.st_mode & (S_IRWXG | S_IRWXO)) == 0;
}

void make_private_directory(const fs::path& directory) {
  if (::mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST) fail(directory, "cannot be made: " + reason());
  if (!is_private_directory(directory)) {
    fail(directory,
         "is not a directory that only this user may enter; remove it, make it mode 0700, or, where it is another "
         "user's, set XDG_RUNTIME_DIR to a directory of your own");
  }
}

}  // namespace meca::net
