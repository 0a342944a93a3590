// Answers lines of text on a Unix stream socket, in a thread of its own; any number of clients one after another, some
// at once. A line ends with '\n'. An answer is one or more lines that are not empty, and an empty line behind them.
#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "transports/net/file.hpp"
#include "transports/net/unix_socket.hpp"

namespace meca::net {

class LineServer {
 public:
  static constexpr std::size_t kLongestLine = 512;  // bytes, without '\n'
  static constexpr std::size_t kMostClients = 16;

  // Called by the server's thread, for one line at a time. Returns lines that end with '\n'. Any bytes may come, but no
  // '\n'. May wait, but not once `stop` is requested.
  using Answer = std::function<std::string(std::string_view line, const std::stop_token& stop)>;
  // What is said to a line that is too long and to a client too many: a complaint without full stop, to a text.
  using Refusal = std::function<std::string(std::string_view complaint)>;

  // Listens and answers from here on. Throws std::runtime_error with a sentence that names the path.
  LineServer(std::filesystem::path path, Answer answer, Refusal refusal);
  ~LineServer();  // hangs up and takes the socket away
  LineServer(const LineServer&) = delete;
  LineServer& operator=(const LineServer&) = delete;

  const std::filesystem::path& path() const noexcept { return listener_.path(); }

 private:
  struct Client;
  void run(const std::stop_token& stop);
  void welcome(std::vector<Client>& clients);
  void serve(Client& client, const std::stop_token& stop);

  UnixListener listener_;
  File wakeup_;  // an eventfd: readable once the end is wanted
  Answer answer_;
  Refusal refusal_;
  std::jthread thread_;  // last: it uses the rest
};

}  // namespace meca::net
