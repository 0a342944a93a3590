#include "transports/net/claim.hpp"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>

namespace meca::net {

// An abstract Unix address (unix(7)): it stands in no file system, so that nothing is left behind, and belongs to the
// network namespace, as an interface does.
std::optional<File> claim(std::string_view name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::size_t size = std::min(name.size(), sizeof address.sun_path - 1);
  std::copy_n(name.begin(), size, address.sun_path + 1);
  File socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + size);
  if (socket && ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), length) == 0) return socket;
  if (socket && errno == EADDRINUSE) return std::nullopt;
  throw std::runtime_error("the name '" + std::string(name) + "' cannot be claimed: " + std::strerror(errno));
}

}  // namespace meca::net
