// Anybody on the network does anything to the simulated robot: what comes out stays well formed, and I/O goes to the
// opener or to the robot's own group only. Input: records of one kind byte and its bytes, until they run out.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

#include "tests/fuzz/source.hpp"
#include "transports/ethernet_ip/adapter.hpp"

namespace {

using namespace meca;
using namespace meca::ethernet_ip;

constexpr std::uint32_t kDevice = 0xAC1C0103, kGroup = 0xEFC00140;
constexpr std::array<std::uint32_t, 4> kHosts = {0xAC1C0102, 0xAC1C0109, 0xC0A80002, 0xEFC00140};

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "ethernet_ip_adapter_fuzz: %s\n", what);
  std::abort();
}

AdapterSettings settings_of(std::uint8_t choice) {
  AdapterSettings s;
  s.identity = {.vendor_id = kMecademicVendor,
                .device_type = kRobotDeviceType,
                .product_code = kMeca500ProductCode,
                .major = 11,
                .minor = 3,
                .status = 0,
                .serial_number = 1,  // the first connection id is 0x101
                .name_bytes = {},
                .name_length = 0,
                .state = 0};
  s.identity.set_name("Meca500");
  s.address = kDevice;
  s.key_policy = static_cast<AdapterKeyPolicy>(choice & 3);
  s.ownership = (choice & 4) != 0 ? OwnershipPolicy::kKeep : OwnershipPolicy::kReleaseOnTimeout;
  s.lenient_rpi = (choice & 8) != 0;
  s.socket_items = (choice & 16) == 0;
  return s;
}

class World {
 public:
  explicit World(fuzz::Source& in) : in_(in), adapter_(settings_of(in.take<std::uint8_t>())) {}

  void step() {
    const auto kind = in_.take<std::uint8_t>();
    const std::size_t id = kind >> 4 & 7;
    switch (kind & 15) {
      case 0:
        peers_[id] = kHosts[in_.take<std::uint8_t>() & 3];
        session_[id] = 0;
        raw_[id] = false;
        adapter_.tcp_accepted(id, peers_[id], now_);
        break;
      case 1:
        adapter_.tcp_closed(id, now_);
        break;
      case 2:
        raw_[id] = true;
        tcp(id, in_.take_bytes(in_.take<std::uint8_t>()));
        break;
      case 3:
        request(id);
        break;
      case 4:
        udp();
        break;
      case 5:
        io({kHosts[in_.take<std::uint8_t>() & 3], 2222}, in_.take_bytes(in_.take<std::uint8_t>()));
        break;
      case 6:
        outputs();
        break;
      case 7:
        now_ += std::chrono::microseconds(100) * (std::uint64_t{in_.take<std::uint8_t>()} << (kind >> 4));
        adapter_.tick(now_);
        break;
      case 8:
        faults();
        break;
      case 9:
        adapter_.close_tcp_connections();
        break;
      case 10:
        adapter_.power_cycle();
        require(!adapter_.connected() && !adapter_.produce(now_), "alive after a power cycle");
        break;
      default:
        tcp(id, written([](wire::Writer& out) {  // RegisterSession
              write(out, Header{.command = 0x65, .length = 4, .session = 0, .status = 0, .context = {}, .options = 0});
              out.u32(1);
            }));
        break;
    }
    produce();
    require(!adapter_.run() || adapter_.connected(), "runs without a connection");
    require(!adapter_.next_event() || *adapter_.next_event() >= Time{}, "an event before the beginning");
  }

 private:
  template <class Write>
  static std::vector<std::byte> written(Write write) {
    std::vector<std::byte> buffer(1500);
    wire::Writer out(buffer);
    write(out);
    buffer.resize(out.size());
    return buffer;
  }

  // An explicit request of the input in a right envelope, with a socket address item where the input says so.
  void request(std::size_t id) {
    const auto flags = in_.take<std::uint8_t>();
    const auto cip = in_.take_bytes(in_.take<std::uint8_t>());
    const SocketAddress wanted{(flags & 2) != 0 ? in_.take<std::uint32_t>() : 0,
                               static_cast<std::uint16_t>(in_.take<std::uint32_t>())};
    const auto data = written([&](wire::Writer& out) {
      out.zeros(6);
      out.u16((flags & 1) != 0 ? 3 : 2);
      write_item(out, ItemType::kNullAddress, 0);
      write_item(out, ItemType::kUnconnectedData, cip.size());
      out.bytes(cip);
      if ((flags & 1) == 0) return;
      write_item(out, ItemType::kSocketAddressTToO, 16);
      write(out, wanted);
    });
    const Header header{.command = 0x6F,
                        .length = static_cast<std::uint16_t>(data.size()),
                        .session = session_[id],
                        .status = 0,
                        .context = {},
                        .options = 0};
    const auto before = adapter_.counters().opens;
    tcp(id, written([&](wire::Writer& out) {
          write(out, header);
          out.bytes(data);
        }));
    // After raw bytes a piece of a message may have been waiting: then it was not this request that opened.
    if (adapter_.counters().opens == before + 1 && !raw_[id]) port_ = (flags & 1) != 0 ? wanted.port : kIoPort;
  }

  void tcp(std::size_t id, Bytes bytes) {
    const auto before = adapter_.counters().opens;
    adapter_.tcp_received(id, bytes, now_);
    if (adapter_.counters().opens != before) {
      opener_ = peers_[id];
      port_.reset();
    }
    Bytes out = adapter_.tcp_output(id);
    while (!out.empty()) {
      const auto header = read_header(out);
      require(header && out.size() >= kHeaderSize + header->length, "half a reply");
      if (header->command == 0x65 && header->status == 0) session_[id] = header->session;
      out = out.subspan(kHeaderSize + header->length);
    }
    adapter_.tcp_sent(id, adapter_.tcp_output(id).size());
  }

  void udp() {
    const auto datagram = in_.take_bytes(in_.take<std::uint8_t>());
    const auto answer = adapter_.udp_received(datagram, (datagram.size() & 1) != 0);
    if (answer.bytes.empty()) return;
    const auto header = read_header(answer.bytes);
    require(header && answer.bytes.size() == kHeaderSize + header->length, "a datagram that is no message");
    require(answer.delay <= std::chrono::milliseconds(0xFFFF), "an answer later than asked for");
  }

  void io(const SocketAddress& from, Bytes datagram) {
    const auto before = adapter_.counters().consumed;
    adapter_.io_received(from, datagram, now_);
    require(adapter_.counters().consumed == before || (opener_ && from.ipv4 == *opener_), "outputs of a stranger");
  }

  void outputs() {
    const auto flags = in_.take<std::uint8_t>();
    const std::uint32_t id = 0x100u + in_.take<std::uint8_t>();
    const auto sequence = in_.take<std::uint32_t>();
    io({kHosts[flags & 3], 2222}, written([&](wire::Writer& out) {
         write_io_packet(out, id, sequence, 66);
         out.u16(static_cast<std::uint16_t>(sequence));
         out.u32(flags >> 2 & 1);
         out.zeros(60);
       }));
  }

  void faults() {
    const auto flags = in_.take<std::uint8_t>();
    AdapterFaults& f = adapter_.faults();
    f.refuse_open = (flags & 1) != 0 ? std::optional<std::uint16_t>(in_.take<std::uint8_t>()) : std::nullopt;
    f.wrong_size =
        (flags & 2) != 0 ? std::optional(static_cast<std::uint16_t>(in_.take<std::uint32_t>())) : std::nullopt;
    f.api_us = (flags & 4) != 0 ? std::optional(in_.take<std::uint32_t>()) : std::nullopt;
    f.foreign_address = (flags & 8) != 0 ? std::optional(SocketAddress{in_.take<std::uint32_t>(), 80}) : std::nullopt;
    f.stop_producing = (flags & 16) != 0;
    f.duplicate = (flags & 32) != 0;
    f.stale_sequence = (flags & 64) != 0;
    f.corrupt = f.frozen_count = (flags & 128) != 0;
  }

  void produce() {
    int packets = 0;
    while (const auto d = adapter_.produce(now_)) {
      require(++packets <= 2, "a burst");
      require(adapter_.connected() && opener_, "I/O without a connection");
      require(read_io_packet(d->bytes).has_value(), "a T->O packet that is none");
      if (d->multicast) {
        require(d->to == SocketAddress{kGroup, kIoPort}, "I/O to another group");
      } else {
        require(d->to.ipv4 == *opener_ && d->to.port != 0, "I/O to a third party");
        require(!port_ || d->to.port == *port_, "I/O to a port that nobody gave");
      }
    }
  }

  fuzz::Source& in_;
  Adapter adapter_;
  Time now_{};
  std::array<std::uint32_t, 8> peers_{}, session_{};
  std::array<bool, 8> raw_{};  // bytes of the input came over this connection
  std::optional<std::uint32_t> opener_;
  std::optional<std::uint16_t> port_;  // of the opener's choice, where we can tell
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Source in(data, size);
  World world(in);
  for (int record = 0; record < 300 && !in.empty(); ++record) world.step();  // many short lives rather than a long one
  return 0;
}
