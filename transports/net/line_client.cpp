#include "transports/net/line_client.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "transports/net/unix_socket.hpp"

namespace meca::net {
namespace {

using Clock = std::chrono::steady_clock;

// False when the time is over.
bool wait_for(int socket, short events, Clock::time_point deadline) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    pollfd polled{socket, events, 0};
    const int ready = ::poll(&polled, 1, static_cast<int>(left));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

bool again() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

}  // namespace

std::optional<LineClient> LineClient::connect(const std::filesystem::path& path) noexcept {
  auto socket = connect_unix(path);
  return socket ? std::optional<LineClient>(LineClient(std::move(*socket))) : std::nullopt;
}

std::optional<std::string> LineClient::ask(std::string_view line, std::chrono::milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  std::string out = std::string(line) + "\n";
  while (!out.empty()) {
    if (!wait_for(socket_.get(), POLLOUT, deadline)) return std::nullopt;
    const ssize_t sent = ::send(socket_.get(), out.data(), out.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && !again()) break;  // it hung up, but may have said why before
    if (sent > 0) out.erase(0, static_cast<std::size_t>(sent));
  }
  std::string answer;
  while (!answer.ends_with("\n\n")) {
    if (!wait_for(socket_.get(), POLLIN, deadline)) return std::nullopt;
    std::array<char, 1024> buffer{};
    const ssize_t size = ::recv(socket_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (size == 0 || (size < 0 && !again())) return std::nullopt;
    if (size > 0) answer.append(buffer.data(), static_cast<std::size_t>(size));
  }
  answer.pop_back();
  return answer;
}

}  // namespace meca::net
