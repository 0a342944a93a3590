// An originator on the bench: the test plays the robot and moves time by hand. Answers are written here, so that a
// script can say what is odd about them; what a robot really writes is in golden_messages.hpp.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/unit/ethernet_ip/golden_messages.hpp"
#include "transports/ethernet_ip/originator.hpp"

namespace meca::ethernet_ip::test {

using namespace std::chrono_literals;
using State = Originator::State;

inline constexpr std::uint32_t kRobot = 0xC0A80064, kHost = 0xC0A80001, kStranger = 0x0A000001;
inline constexpr std::uint32_t kGroup = 0xEFC00140;  // 239.192.1.64
inline constexpr std::uint32_t kSession = 0x00C0FFEE, kOutputId = 0x3FE60013;

inline OriginatorSettings usual_settings() {
  OriginatorSettings settings;
  settings.vendor_id = 0x1234;
  settings.serial_number = 0x6B02695B;
  settings.incarnation = 0xDC2D;
  settings.address = kRobot;
  return settings;
}

// What a Forward Open is answered with; a script changes what it wants.
struct OpenAnswer {
  std::optional<ConnectionTriad> triad{};  // not the one that was asked
  std::uint32_t o_to_t_api_us = 10'000, t_to_o_api_us = 10'000;
  std::optional<std::uint32_t> t_to_o_id{};  // the robot's choice (multicast); else echoed
  std::optional<SocketAddress> o_to_t{}, t_to_o{};
};

class Rig {
 public:
  explicit Rig(const OriginatorSettings& settings = usual_settings(), std::uint16_t first_serial = 1)
      : machine(settings, first_serial) {}

  Originator machine;
  Time now{1s};

  // ---- Time
  void tick(Time dt = Time{}) {
    now += dt;
    machine.tick(now);
  }
  // Milliseconds until `condition`, in steps of one; fails after `most`.
  template <class Condition>
  Time until(Condition condition, Time most) {
    const Time begin = now;
    while (!condition()) {
      if (now - begin >= most) {
        ADD_FAILURE() << "nothing for " << (now - begin).count() / 1'000'000 << " ms";
        break;
      }
      tick(1ms);
    }
    return now - begin;
  }

  // ---- The robot on TCP
  void connect() {
    if (machine.state() == State::kWaiting) until([&] { return machine.state() == State::kConnecting; }, 20s);
    machine.tcp_connected(now, kHost);
  }
  // Everything the machine has to send, taken.
  std::vector<std::byte> take_output() {
    const auto output = machine.tcp_output();
    std::vector<std::byte> bytes(output.begin(), output.end());
    machine.tcp_sent(bytes.size());
    return bytes;
  }
  void feed(wire::Bytes bytes) { machine.tcp_received(bytes, now); }
  void feed(std::string_view hex) { feed(from_hex(hex)); }

  void answer_register() { feed(encapsulated(Command::kRegisterSession, from_hex("01000000"))); }
  void answer_identity(std::uint16_t vendor = 1565, std::uint16_t product = 500) {
    Identity identity;
    identity.vendor_id = vendor;
    identity.device_type = 43;
    identity.product_code = product;
    identity.major = 11;
    identity.minor = 3;
    identity.serial_number = 123456789;
    identity.set_name("Meca500");
    feed(unconnected(written([&](wire::Writer& out) {
      write_reply(out, 0x01, GeneralStatus::kSuccess);
      write(out, identity);
    })));
  }
  // Reads the Forward Open (or Close) that the machine has just sent.
  ForwardOpen take_open() {
    const auto request = take_request();
    const bool large = request.service == 0x5B;
    EXPECT_TRUE(large || request.service == 0x54) << "no Forward Open was sent";
    asked_path_.assign(request.data.begin(), request.data.end());
    ForwardOpen open;
    EXPECT_EQ(read_forward_open(asked_path_, large, open), GeneralStatus::kSuccess);
    asked = open;
    return open;
  }
  ConnectionTriad take_close() {
    const auto request = take_request();
    EXPECT_EQ(request.service, 0x4E) << "no Forward Close was sent";
    ForwardClose close;
    EXPECT_EQ(read_forward_close(request.data, close), GeneralStatus::kSuccess);
    return close.triad;
  }
  bool sent_unregister() {
    const auto bytes = take_output();
    const auto header = read_header(bytes);
    return header && header->command == 0x66 && header->session == kSession && bytes.size() == kHeaderSize;
  }
  void answer_open(const OpenAnswer& a = {}) { feed(open_reply(a)); }
  std::vector<std::byte> open_reply(const OpenAnswer& a = {}) const {
    const auto message = written([&](wire::Writer& out) {
      write_reply(out, asked.large ? 0x5B : 0x54, GeneralStatus::kSuccess);
      write(out, ForwardOpenReply{kOutputId, a.t_to_o_id.value_or(asked.t_to_o_id), a.triad.value_or(asked.triad),
                                  a.o_to_t_api_us, a.t_to_o_api_us});
    });
    std::vector<std::byte> items;
    const auto add = [&](ItemType type, const std::optional<SocketAddress>& address) {
      if (!address) return;
      const auto item = written([&](wire::Writer& out) {
        write_item(out, type, 16);
        write(out, *address);
      });
      items.insert(items.end(), item.begin(), item.end());
    };
    add(ItemType::kSocketAddressOToT, a.o_to_t);
    add(ItemType::kSocketAddressTToO, a.t_to_o);
    return unconnected(message, items);
  }
  void refuse_open(std::initializer_list<std::uint16_t> extended, std::uint8_t general = 1) {
    feed(unconnected(written([&](wire::Writer& out) {
      write_reply(out, asked.large ? 0x5B : 0x54, static_cast<GeneralStatus>(general), extended);
      write(out, ConnectionFailure{asked.triad, 0});
    })));
  }
  void answer_close(const ConnectionTriad& triad, std::uint16_t refused = 0) {
    feed(unconnected(written([&](wire::Writer& out) {
      const std::uint16_t words[] = {refused};
      if (refused == 0) {
        write_reply(out, 0x4E, GeneralStatus::kSuccess);
      } else {
        write_reply(out, 0x4E, GeneralStatus::kConnectionFailure, words);
      }
      write_forward_close_reply(out, triad);
    })));
  }

  // ---- The way to each state
  void to_opening() {
    connect();
    take_output();
    answer_register();
    take_output();
    answer_identity();
    take_open();
  }
  void to_running(const OpenAnswer& a = {}) {
    to_opening();
    answer_open(a);
  }
  void to_receiving(const OpenAnswer& a = {}) {
    to_running(a);
    EXPECT_TRUE(receive(1, 1));
    EXPECT_TRUE(machine.running()) << machine.trouble();
    machine.take_fresh();
  }
  // After a fault: answers the good-bye until the machine waits (or is closed).
  void finish_closing() {
    answer_close(take_close());
    EXPECT_TRUE(sent_unregister());
    tick();
  }

  // ---- The robot on UDP
  std::vector<std::byte> packet(std::uint32_t sequence, std::uint16_t count, std::uint8_t fill = 0,
                                std::size_t size = kInputSize) const {
    return written([&](wire::Writer& out) {
      write_io_packet(out, connection_id.value_or(asked.t_to_o_id), sequence, size);
      out.u16(count);
      for (std::size_t i = 2; i < size; ++i) out.u8(fill);
    });
  }
  bool receive(std::uint32_t sequence, std::uint16_t count, std::uint8_t fill = 0, std::size_t size = kInputSize) {
    return machine.io_received({kRobot, 2222}, packet(sequence, count, fill, size), now);
  }
  struct Sent {
    SocketAddress to;
    std::uint32_t connection_id, sequence, header;
    std::uint16_t count;
    std::size_t size;
  };
  std::optional<Sent> produce(bool run = true) {
    const auto datagram = machine.produce(outputs, run, now);
    if (!datagram) return std::nullopt;
    const auto packet = read_io_packet(datagram->bytes);
    EXPECT_TRUE(packet);
    wire::Reader in(packet->data);
    const std::uint16_t count = in.u16();
    return Sent{datagram->to, packet->connection_id, packet->sequence, in.u32(), count, packet->data.size()};
  }

  image::OutputBytes outputs{};
  ForwardOpen asked;
  std::optional<std::uint32_t> connection_id;  // of T->O packets, where the robot chose it
  std::uint32_t session = kSession;

  std::vector<std::byte> encapsulated(Command command, wire::Bytes data, std::uint32_t status = 0) const {
    return written([&](wire::Writer& out) {
      Header header;
      header.command = static_cast<std::uint16_t>(command);
      header.length = static_cast<std::uint16_t>(data.size());
      header.session = session;
      header.status = status;
      write(out, header);
      out.bytes(data);
    });
  }
  std::vector<std::byte> unconnected(wire::Bytes message, wire::Bytes more_items = {}) const {
    return encapsulated(Command::kSendRrData, written([&](wire::Writer& out) {
                          out.zeros(6);
                          out.u16(static_cast<std::uint16_t>(2 + more_items.size() / 20));
                          write_item(out, ItemType::kNullAddress, 0);
                          write_item(out, ItemType::kUnconnectedData, message.size());
                          out.bytes(message);
                          out.bytes(more_items);
                        }));
  }
  template <class Write>
  static std::vector<std::byte> written(Write write) {
    std::array<std::byte, 1024> buffer;
    wire::Writer out(buffer);
    write(out);
    EXPECT_TRUE(out.ok());
    return {out.written().begin(), out.written().end()};
  }

 private:
  Request take_request() {
    request_ = take_output();
    wire::Reader in(wire::Bytes(request_).subspan(std::min(request_.size(), kHeaderSize + 6)));
    items_ = read_items(in);
    const Item* item = items_ ? items_->find(ItemType::kUnconnectedData) : nullptr;
    const auto request = item != nullptr ? read_request(item->data) : std::nullopt;
    EXPECT_TRUE(request) << "no request was sent; " << machine.trouble();
    return request.value_or(Request{});
  }

  std::vector<std::byte> request_, asked_path_;

 public:
  std::optional<Items> items_;  // of the last request
};

}  // namespace meca::ethernet_ip::test
