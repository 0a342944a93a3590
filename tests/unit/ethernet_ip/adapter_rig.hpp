// An adapter on the bench: hex in, hex out, time moved by hand.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/hex.hpp"
#include "transports/ethernet_ip/adapter.hpp"

namespace meca::ethernet_ip::adapter_test {

using namespace std::chrono_literals;

// The device of the captures in the tests: firmware 11.3 at 172.28.1.3/24. The originator is at .2.
inline constexpr std::uint32_t kDevice = 0xAC1C0103, kOriginator = 0xAC1C0102, kStranger = 0xAC1C0109;

inline std::vector<std::byte> bytes(std::string_view hex) { return meca::test::from_hex(hex); }

inline std::string hex(Bytes data) { return meca::test::to_hex(data, "", "0123456789abcdef"); }

template <class Write>
std::vector<std::byte> written(Write write) {
  std::vector<std::byte> buffer(2048);
  wire::Writer out(buffer);
  write(out);
  buffer.resize(out.size());
  return buffer;
}

inline AdapterSettings meca500() {
  AdapterSettings s;
  s.identity = {.vendor_id = kMecademicVendor,
                .device_type = kRobotDeviceType,
                .product_code = kMeca500ProductCode,
                .major = 11,
                .minor = 3,
                .serial_number = 123456789};
  s.identity.set_name("Meca500");
  s.address = kDevice;
  return s;
}

// 10 ms in both directions, x4, point to point, sizes of the robot.
inline ForwardOpen usual_open() {
  ForwardOpen f;
  f.t_to_o_id = 0x5EED0001;
  f.triad = {.connection_serial = 7, .originator_vendor = 0x1234, .originator_serial = 0x6B02695B};
  f.o_to_t_rpi_us = f.t_to_o_rpi_us = 10'000;
  f.o_to_t.size = 66;
  f.t_to_o.size = 254;
  return f;
}
inline constexpr std::string_view kUsualPath = "20 04 2C 96 2C 64";

class AdapterRig {
 public:
  explicit AdapterRig(const AdapterSettings& settings = meca500()) : adapter(settings) { connect(0); }

  void connect(std::size_t id, std::uint32_t peer = kOriginator) { adapter.tcp_accepted(id, peer, now); }
  // Sends one message, or a piece of it; what the adapter answers at once.
  std::string tcp(Bytes message, std::size_t id = 0) {
    adapter.tcp_received(id, message, now);
    const std::string out = hex(adapter.tcp_output(id));
    adapter.tcp_sent(id, out.size() / 2);
    return out;
  }
  std::string tcp(std::string_view message, std::size_t id = 0) { return tcp(bytes(message), id); }

  // RegisterSession; the handle.
  std::uint32_t enter(std::size_t id = 0) {
    const auto reply = bytes(tcp("65000400 00000000 00000000 0000000000000000 00000000 0100 0000", id));
    session_ = read_header(reply).value().session;
    return session_;
  }

  // SendRRData with a Message Router request, and `items` (hex, with their headers) behind it.
  std::vector<std::byte> rr(Bytes cip, std::string_view items = "", std::size_t item_count = 0) const {
    const auto more = bytes(items);
    const auto data = written([&](wire::Writer& out) {
      out.zeros(6);
      out.u16(static_cast<std::uint16_t>(2 + item_count));
      write_item(out, ItemType::kNullAddress, 0);
      write_item(out, ItemType::kUnconnectedData, cip.size());
      out.bytes(cip);
      out.bytes(more);
    });
    Header h;
    h.command = static_cast<std::uint16_t>(Command::kSendRrData);
    h.length = static_cast<std::uint16_t>(data.size());
    h.session = session_;
    return written([&](wire::Writer& out) {
      write(out, h);
      out.bytes(data);
    });
  }

  // What came back for a request: "ok", or the statuses as hex words ("01 0127 0042"), or "encapsulation 03".
  std::string cip(Bytes request, std::string_view items = "", std::size_t item_count = 0, std::size_t id = 0) {
    last_reply = bytes(tcp(rr(request, items, item_count), id));
    const Header h = read_header(last_reply).value();
    char text[32];
    if (h.status != 0) {
      std::snprintf(text, sizeof text, "encapsulation %02X", static_cast<unsigned>(h.status));
      return text;
    }
    wire::Reader in(Bytes(last_reply).subspan(kHeaderSize + 6));
    last_items = read_items(in).value();
    const Reply reply = read_reply(last_items.find(ItemType::kUnconnectedData)->data).value();
    last_data = hex(reply.data);
    if (reply.ok()) return "ok";
    std::snprintf(text, sizeof text, "%02X", reply.general);
    std::string out = text;
    for (std::size_t i = 0; i < reply.extended_count; ++i) {
      std::snprintf(text, sizeof text, " %04X", reply.extended[i]);
      out += text;
    }
    return out;
  }
  std::string cip(std::string_view request) { return cip(bytes(request)); }

  // Forward Open; `items` as above.
  std::string open(const ForwardOpen& f, std::string_view path = kUsualPath, std::string_view items = "",
                   std::size_t item_count = 0, std::size_t id = 0) {
    const auto path_bytes = bytes(path);
    const auto request = written([&](wire::Writer& out) {
      write_request(out, f.large ? Service::kLargeForwardOpen : Service::kForwardOpen, kConnectionManagerClass, 1);
      write_forward_open(out, f);
      out.u8(static_cast<std::uint8_t>(path_bytes.size() / 2));
      out.bytes(path_bytes);
    });
    const std::string outcome = cip(request, items, item_count, id);
    if (outcome == "ok") {
      opened = read_forward_open_reply(bytes(last_data)).value();
      sequence = 0;
    }
    return outcome;
  }
  std::string close(const ConnectionTriad& triad, std::string_view path = kUsualPath, std::size_t id = 0) {
    const auto path_bytes = bytes(path);
    return cip(written([&](wire::Writer& out) {
                 write_request(out, Service::kForwardClose, kConnectionManagerClass, 1);
                 write_forward_close(out, {.triad = triad, .path = {}}, path_bytes);
               }),
               "", 0, id);
  }
  std::optional<SocketAddress> socket_item(ItemType type) const {
    const Item* item = last_items.find(type);
    return item == nullptr ? std::nullopt : read_socket_address(item->data);
  }

  // An O->T packet of the open connection: next sequence and count, run, image filled with `fill`.
  struct OToT {
    std::optional<std::uint32_t> id{}, sequence{};
    std::optional<std::uint16_t> count{};
    std::uint32_t header = 1;
    std::uint8_t fill = 0x11;
    std::size_t length = 66;
    SocketAddress from{kOriginator, 2222};
  };
  void io(const OToT& p) {
    ++sequence;
    const auto datagram = written([&](wire::Writer& out) {
      write_io_packet(out, p.id.value_or(opened.o_to_t_id), p.sequence.value_or(sequence), p.length);
      const auto data = written([&](wire::Writer& inner) {
        inner.u16(p.count.value_or(static_cast<std::uint16_t>(sequence)));
        inner.u32(p.header);
        for (int i = 0; i < 200; ++i) inner.u8(p.fill);
      });
      out.bytes(Bytes(data).first(p.length));
    });
    adapter.io_received(p.from, datagram, now);
  }
  void io() { io(OToT{}); }

  // Moves time in steps of 1 ms; what was produced on the way.
  struct Sent {
    Time at;
    SocketAddress to;
    bool multicast;
    std::vector<std::byte> datagram;
    IoPacket packet() const { return read_io_packet(datagram).value(); }
  };
  std::vector<Sent> run_for(Time duration) {
    std::vector<Sent> all;
    for (const Time end = now + duration; now < end; now += 1ms) {
      adapter.tick(now);
      while (const auto d = adapter.produce(now)) {
        all.push_back({now, d->to, d->multicast, {d->bytes.begin(), d->bytes.end()}});
      }
    }
    return all;
  }

  Adapter adapter;
  Time now = 1000s;
  ForwardOpenReply opened;
  std::uint32_t sequence = 0;
  std::vector<std::byte> last_reply;
  Items last_items;
  std::string last_data;

 private:
  std::uint32_t session_ = 0;
};

}  // namespace meca::ethernet_ip::adapter_test
