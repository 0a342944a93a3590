// A robot that answers anything, at any time, over TCP and UDP: the originator sends to nobody but the robot, joins
// nothing but groups, and keeps what its header promises. Input: one byte of settings, then records of one kind byte
// and its bytes, until they run out. Some records are well-formed answers with odd contents, so that every state is
// reached; the others are raw bytes.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "tests/fuzz/source.hpp"
#include "transports/ethernet_ip/originator.hpp"

namespace {

using meca::fuzz::Source;

using namespace meca::ethernet_ip;
using State = Originator::State;

constexpr std::uint32_t kRobot = 0xC0A80064, kHost = 0xC0A80001;
constexpr std::uint32_t kSession = 1;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "ethernet_ip_originator_fuzz: %s\n", what);
  std::abort();
}

OriginatorSettings settings_of(std::uint8_t choice) {
  OriginatorSettings settings;
  settings.vendor_id = 0x1234;
  settings.serial_number = 0x6B02695B;
  settings.incarnation = 0xDC2D;
  settings.address = kRobot;
  settings.multicast = (choice & 1) != 0;
  settings.large = (choice & 2) != 0;
  settings.key = static_cast<KeyPolicy>((choice >> 2) % 3);
  if ((choice & 0x40) != 0) settings.io_port = 5000;
  if ((choice & 0x80) != 0) settings.shortest_backoff = Time{};
  return settings;
}

class Bench {
 public:
  explicit Bench(std::uint8_t choice) : settings_(settings_of(choice)), machine_(settings_, 1) {}

  void step(Source& source) {
    switch (source.take<std::uint8_t>() % 14) {
      case 0:
        now_ += std::chrono::milliseconds(source.take<std::uint16_t>());
        break;
      case 1: {
        const auto size = source.take<std::uint16_t>();
        machine_.tcp_received(source.take_bytes(size), now_);
        break;
      }
      case 2:
        answer(Command::kRegisterSession, source.take_bytes(source.take<std::uint8_t>()),
               source.take<std::uint8_t>() / 128);
        break;
      case 3:
        answer_identity(source);
        break;
      case 4:
        answer_open(source);
        break;
      case 5:
        refuse_open(source);
        break;
      case 6:
        answer_close();
        break;
      case 7: {
        const SocketAddress from{source.take<std::uint8_t>() % 2 != 0 ? kRobot : source.take<std::uint32_t>(), 2222};
        const auto size = source.take<std::uint16_t>();
        machine_.io_received(from, source.take_bytes(size), now_);
        break;
      }
      case 8:
        send_packet(source);
        break;
      case 9:
        machine_.tcp_connected(now_, kHost);
        break;
      case 10:
        machine_.tcp_closed(source.take<std::uint8_t>() % 2 != 0 ? "connection refused" : "", now_);
        break;
      case 11:
        if (source.take<std::uint8_t>() < 32) machine_.close(now_);
        break;
      case 12:
        machine_.join_failed("no such device", now_);
        break;
      case 13:
        break;  // a step in which nothing happens
    }
    const bool closed = machine_.state() == State::kClosed;
    look_at_output(source.take<std::uint8_t>());
    machine_.tick(now_);
    produce();
    check(closed);
  }

 private:
  template <class Write>
  std::vector<std::byte> written(Write write) {
    std::vector<std::byte> buffer(1024);
    meca::wire::Writer out(buffer);
    write(out);
    buffer.resize(out.size());
    return buffer;
  }
  void answer(Command command, Bytes data, std::uint32_t status = 0) {
    Header header;
    header.command = static_cast<std::uint16_t>(command);
    header.length = static_cast<std::uint16_t>(data.size());
    header.session = kSession;
    header.status = status;
    machine_.tcp_received(written([&](auto& out) {
                            write(out, header);
                            out.bytes(data);
                          }),
                          now_);
  }
  void answer_unconnected(Bytes message, std::optional<SocketAddress> o_to_t = {},
                          std::optional<SocketAddress> t_to_o = {}) {
    answer(Command::kSendRrData, written([&](auto& out) {
             out.zeros(6);
             out.u16(static_cast<std::uint16_t>(2 + o_to_t.has_value() + t_to_o.has_value()));
             write_item(out, ItemType::kNullAddress, 0);
             write_item(out, ItemType::kUnconnectedData, message.size());
             out.bytes(message);
             if (o_to_t) {
               write_item(out, ItemType::kSocketAddressOToT, 16);
               write(out, *o_to_t);
             }
             if (t_to_o) {
               write_item(out, ItemType::kSocketAddressTToO, 16);
               write(out, *t_to_o);
             }
           }));
  }
  std::uint8_t open_service() const {
    return static_cast<std::uint8_t>(settings_.large ? Service::kLargeForwardOpen : Service::kForwardOpen);
  }

  void answer_identity(Source& source) {
    Identity identity;
    identity.vendor_id = kMecademicVendor;
    identity.device_type = kRobotDeviceType;
    identity.product_code = source.take<std::uint8_t>() < 240 ? kMeca500ProductCode : source.take<std::uint16_t>();
    identity.set_name("Meca500");
    answer_unconnected(written([&](auto& out) {
      write_reply(out, 0x01, GeneralStatus::kSuccess);
      write(out, identity);
    }));
  }
  static std::optional<SocketAddress> take_address(Source& source) {
    switch (source.take<std::uint8_t>() % 6) {
      case 0:
        return std::nullopt;
      case 1:
        return SocketAddress{0, kIoPort};
      case 2:
        return SocketAddress{kRobot, source.take<std::uint16_t>()};
      case 3:
        return SocketAddress{0xEFC00140, kIoPort};
      case 4:
        return SocketAddress{0, 5000};
      default:
        return SocketAddress{source.take<std::uint32_t>(), source.take<std::uint16_t>()};
    }
  }
  void answer_open(Source& source) {
    ForwardOpenReply reply{1, asked_.t_to_o_id, asked_.triad, 10'000, 10'000};
    const auto odd = source.take<std::uint8_t>();
    if ((odd & 1) != 0) reply.o_to_t_api_us = source.take<std::uint32_t>();
    if ((odd & 2) != 0) reply.t_to_o_api_us = source.take<std::uint32_t>();
    if ((odd & 4) != 0) reply.t_to_o_id = source.take<std::uint32_t>();
    if ((odd & 24) == 24) reply.triad.connection_serial = source.take<std::uint16_t>();
    const auto o_to_t = take_address(source), t_to_o = take_address(source);
    answer_unconnected(written([&](auto& out) {
                         write_reply(out, open_service(), GeneralStatus::kSuccess);
                         write(out, reply);
                       }),
                       o_to_t, t_to_o);
  }
  void refuse_open(Source& source) {
    const auto general =
        static_cast<GeneralStatus>(source.take<std::uint8_t>() % 2 == 0 ? 1 : source.take<std::uint8_t>());
    std::vector<std::uint16_t> extended(source.take<std::uint8_t>() % 8);
    for (auto& word : extended) word = source.take<std::uint16_t>();
    answer_unconnected(written([&](auto& out) {
      write_reply(out, open_service(), general, extended);
      write(out, ConnectionFailure{asked_.triad, 0});
    }));
  }
  void answer_close() {
    answer_unconnected(written([&](auto& out) {
      write_reply(out, 0x4E, GeneralStatus::kSuccess);
      write_forward_close_reply(out, asked_.triad);
    }));
  }
  void send_packet(Source& source) {
    const auto sequence = source.take<std::uint32_t>();
    const auto count = source.take<std::uint16_t>();
    machine_.io_received({kRobot, kIoPort}, written([&](auto& out) {
                           write_io_packet(out, asked_.t_to_o_id, sequence, kInputSize);
                           out.u16(count);
                           out.zeros(kInputSize - 2u);
                         }),
                         now_);
  }

  // Reads what the machine sends, as a robot would, and takes some of it.
  void look_at_output(std::uint8_t taken) {
    const Bytes output = machine_.tcp_output();
    std::size_t at = 0;
    while (at < output.size() && at_message_begin_) {
      const auto header = read_header(output.subspan(at));
      require(header && at + kHeaderSize + header->length <= output.size(), "half a message in the output");
      read_message(output.subspan(at + kHeaderSize, header->length));
      at += kHeaderSize + header->length;
    }
    const std::size_t count = taken < 200 ? output.size() : std::min<std::size_t>(taken - 200u, output.size());
    machine_.tcp_sent(count);
    at_message_begin_ = machine_.tcp_output().empty();
  }
  void read_message(Bytes data) {
    meca::wire::Reader in(data);
    in.skip(6);
    const auto items = read_items(in);
    const Item* item = items ? items->find(ItemType::kUnconnectedData) : nullptr;
    const auto request = item != nullptr ? read_request(item->data) : std::nullopt;
    if (!request || request->service != open_service()) return;
    ForwardOpen open;
    require(read_forward_open(request->data, settings_.large, open) == GeneralStatus::kSuccess,
            "a Forward Open that nobody can read");
    require(open.triad.connection_serial != 0, "a connection serial of zero");
    require(!(open.triad == asked_.triad), "a connection serial used twice");
    asked_ = open;
    asked_.path = {};  // the request is gone soon
  }

  void produce() {
    const meca::image::OutputBytes outputs{};
    const auto datagram = machine_.produce(outputs, true, now_);
    if (!datagram) return;
    require(machine_.state() == State::kRunning, "a packet while not running");
    require(datagram->to.ipv4 == kRobot && datagram->to.port != 0, "a packet for somebody who is not the robot");
    require(datagram->bytes.size() == kIoOverhead + kOutputSize, "a packet of another size");
    require(!machine_.produce(outputs, true, now_), "a burst");
  }
  void check(bool was_closed) {
    const State state = machine_.state();
    require(machine_.group() == 0 || (settings_.multicast && machine_.group() >> 28 == 0xE), "a group that is none");
    require(machine_.group() == 0 || state == State::kRunning, "a group while not running");
    const bool as_asked =
        machine_.o_to_t_api_us() == settings_.o_to_t_rpi_us && machine_.t_to_o_api_us() == settings_.t_to_o_rpi_us;
    require(!machine_.running() || machine_.trouble().empty() == as_asked, "running, and a wrong word about it");
    require(!was_closed || state == State::kClosed, "closed is for ever");
    const bool idle = state == State::kWaiting || state == State::kClosed;
    require(!idle || (!machine_.wants_tcp() && machine_.tcp_output().empty()), "TCP while there is nothing to say");
    require(machine_.next_send().has_value() == (state == State::kRunning), "a deadline while not running");
    require((machine_.o_to_t_api_us() != 0) == (state == State::kRunning), "an interval while not running");
  }

  OriginatorSettings settings_;
  Originator machine_;
  Time now_{std::chrono::seconds(1)};
  ForwardOpen asked_;
  bool at_message_begin_ = true;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source source(data, size);
  Bench bench(source.take<std::uint8_t>());
  while (!source.empty()) bench.step(source);
  return 0;
}
