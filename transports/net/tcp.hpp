// TCP sockets that never block: a stream that connects while its owner goes on, and a listener.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "transports/net/file.hpp"
#include "transports/net/ipv4.hpp"

namespace meca::net {

class TcpStream {
 public:
  TcpStream() = default;
  explicit TcpStream(File file) noexcept : file_(std::move(file)) {}
  // Begins to connect; progress() tells how it went. `dscp`: asked for, not insisted on. `from`: the own address to
  // connect from; 0: the system's choice.
  static TcpStream connect(const Endpoint& to, std::uint8_t dscp = 0, std::uint32_t from = 0) noexcept;

  enum class Progress : std::uint8_t { kConnecting, kConnected, kFailed };
  // For a stream of connect(): until it is no longer kConnecting. kFailed: trouble() says why.
  Progress progress() noexcept;

  struct Count {
    std::size_t bytes = 0;
    bool closed = false;  // by the other end, or broken: trouble() says why, empty when it was closed in order
  };
  Count receive(std::span<std::byte> buffer) noexcept;    // what is there; 0 bytes and not closed: nothing now
  Count send(std::span<const std::byte> bytes) noexcept;  // as much as goes

  std::string_view trouble() const noexcept { return trouble_; }  // static text: "connection refused"
  int descriptor() const noexcept { return file_.get(); }
  explicit operator bool() const noexcept { return static_cast<bool>(file_); }
  Endpoint local() const noexcept;
  Endpoint peer() const noexcept;
  void close() noexcept { file_ = {}; }

 private:
  File file_;
  std::string_view trouble_;
};

class TcpListener {
 public:
  TcpListener() = default;
  // Throws std::runtime_error with a sentence. `dscp`: of the streams that are accepted; asked for, not insisted on.
  explicit TcpListener(const Endpoint& local, std::uint8_t dscp = 0);

  std::optional<TcpStream> accept() noexcept;  // nothing: nobody waits
  int descriptor() const noexcept { return file_.get(); }
  Endpoint local() const noexcept;

 private:
  File file_;
  std::uint8_t dscp_ = 0;
};

}  // namespace meca::net
