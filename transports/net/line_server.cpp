#include "transports/net/line_server.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "transports/net/line_splitter.hpp"

namespace meca::net {
namespace {

constexpr std::size_t kGulp = 1024;

// False when the client is gone.
bool send_some(int socket, std::string& bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    bytes.erase(0, static_cast<std::size_t>(sent));
  }
  return true;
}

}  // namespace

struct LineServer::Client {
  explicit Client(File connection) : socket(std::move(connection)) {}

  File socket;
  LineSplitter lines{kLongestLine};
  std::string unsent;  // what a slow reader has not taken yet; nothing more is read from it until it has
  bool ended = false;  // it will say no more
  bool gone = false;

  // What to wait for; a client that neither reads nor hangs up costs nothing.
  short events() const noexcept { return static_cast<short>(unsent.empty() ? POLLIN : POLLOUT); }
};

LineServer::LineServer(std::filesystem::path path, Answer answer, Refusal refusal)
    : listener_(std::move(path)),
      wakeup_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      answer_(std::move(answer)),
      refusal_(std::move(refusal)) {
  if (!wakeup_) throw std::runtime_error("'" + listener_.path().string() + "' cannot be served: no eventfd");
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

LineServer::~LineServer() {
  thread_.request_stop();
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(wakeup_.get(), &one, sizeof one);
  thread_.join();
}

void LineServer::run(const std::stop_token& stop) {
  std::vector<Client> clients;
  std::vector<pollfd> polled;
  while (!stop.stop_requested()) {
    polled.assign({{wakeup_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}});
    for (const Client& client : clients) polled.push_back({client.socket.get(), client.events(), 0});
    if (::poll(polled.data(), polled.size(), -1) < 0 && errno != EINTR) return;
    for (std::size_t i = 0; i < clients.size() && !stop.stop_requested(); ++i) {
      if (polled[i + 2].revents != 0) serve(clients[i], stop);
    }
    std::erase_if(clients, [](const Client& client) { return client.gone; });
    if (polled[1].revents != 0) welcome(clients);
  }
}

void LineServer::welcome(std::vector<Client>& clients) {
  bool anybody = false;
  while (auto socket = listener_.accept()) {
    anybody = true;
    if (clients.size() < kMostClients) {
      clients.emplace_back(std::move(*socket));
      continue;
    }
    std::string text =
        refusal_(std::to_string(kMostClients) + " clients are connected already; try again later") + "\n";
    send_some(socket->get(), text);
  }
  if (anybody) return;
  // Somebody waits and cannot be let in (no file descriptors left): not to be asked again at once.
  constexpr int kPauseMs = 100;
  pollfd end{wakeup_.get(), POLLIN, 0};
  ::poll(&end, 1, kPauseMs);
}

// One gulp of what the client says, or of what it has not read yet; the others have their turn afterwards.
void LineServer::serve(Client& client, const std::stop_token& stop) {
  if (client.unsent.empty() && !client.ended) {
    std::array<char, kGulp> buffer{};
    const ssize_t size = ::recv(client.socket.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (size < 0) {
      client.gone = errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR;
      return;
    }
    client.ended = size == 0;
    client.lines.add({buffer.data(), static_cast<std::size_t>(size)});
  }
  do {
    if (!send_some(client.socket.get(), client.unsent)) client.gone = true;
    if (client.gone || !client.unsent.empty()) return;
    auto line = client.lines.next();
    if (!line && client.ended) line = client.lines.rest();
    if (!line) break;
    client.unsent = line->too_long ? refusal_("the line has more than " + std::to_string(kLongestLine) + " bytes")
                                   : answer_(line->text, stop);
    client.unsent += "\n";
  } while (!stop.stop_requested());
  client.gone = client.ended;
}

}  // namespace meca::net
