// A master that does anything to a simulated robot: states, mails and process data in any order. The robot stays in a
// state that exists, and every mail of it can be read. Input: records of one kind byte and its bytes, until they run
// out.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/fuzz/source.hpp"
#include "transports/ethercat/chain.hpp"

namespace {

using namespace meca;
using namespace meca::ethercat;

constexpr std::uint16_t kStation = 0x1001;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "ethercat_device_fuzz: %s\n", what);
  std::abort();
}

DeviceSettings settings_of(std::uint8_t choice) {
  DeviceSettings s;
  s.layout = static_cast<image::Layout>(choice % 3);
  s.assigned = (choice & 4) != 0;
  s.wants_sii = (choice & 8) != 0;
  s.old_sync_manager_types = (choice & 16) != 0;
  if ((choice & 32) != 0) s.firmware = std::string(300, 'x');  // longer than one mail
  s.transition = s.mailbox_reply = std::chrono::milliseconds(choice >> 6);
  return s;
}

class World {
 public:
  explicit World(fuzz::Source& in) : in_(in), device_(settings_of(in.take<std::uint8_t>())) {
    const std::array station{std::byte{0x01}, std::byte{0x10}};
    send(Command::kApwr, address_of(0, reg::kStationAddress), station);
    if ((in.take<std::uint8_t>() & 1) != 0) set_up();
  }

  void step() {
    const auto kind = in_.take<std::uint8_t>();
    switch (kind & 7) {
      case 0:  // AL control
        send(Command::kFpwr, address_of(kStation, reg::kAlControl), in_.take_bytes(2));
        break;
      case 1:
        mail();
        break;
      case 2:
        fetch();
        break;
      case 3:
        now_ += std::chrono::microseconds(100) * (std::uint64_t{in_.take<std::uint8_t>()} << (kind >> 5));
        break;
      case 4:
        send(Command::kLrw, 0, std::vector<std::byte>(kOutputSize + kInputSize));
        break;
      case 5: {  // a register, or any other address
        const auto at = in_.take<std::uint16_t>();
        send(Command::kFpwr, address_of(kStation, at), in_.take_bytes(1 + (kind >> 3)));
        break;
      }
      case 6:
        set_up();
        break;
      default:
        trouble(kind >> 3);
        break;
    }
    device_.tick(now_);
    check();
  }

 private:
  std::vector<std::byte> send(Command command, std::uint32_t address, Bytes data) {
    std::array<std::byte, kLongestFrame> buffer{};
    FrameWriter writer(buffer, {});
    std::ranges::copy(data, writer.add(command, 1, address, data.size()).begin());
    const auto frame = std::span(buffer).first(writer.finish().size());
    if (frame.empty() || !chain_.process(Chain::Side::kPrimary, frame, now_)) return {};
    const auto datagram = DatagramWalk<std::byte>(frame).next();
    if (datagram->working_counter() == 0) return {};
    return {datagram->data().begin(), datagram->data().end()};
  }

  void set_up() {
    for (unsigned n = 0; n < 4; ++n) {
      send(Command::kFpwr, address_of(kStation, reg::sync_manager(n)), sync_manager_bytes(n, true));
    }
    send(Command::kFpwr, address_of(kStation, reg::fmmu(0)), fmmu_bytes(0, true));
    send(Command::kFpwr, address_of(kStation, reg::fmmu(1)), fmmu_bytes(kOutputSize, false));
  }

  // A right header around bytes of the input; or, with a length of 255, no right header at all.
  void mail() {
    const auto length = in_.take<std::uint8_t>(), type = in_.take<std::uint8_t>();
    std::array<std::byte, kMailboxSize> memory{};
    wire::Writer out(memory);
    if (length != 255) {
      const auto payload = in_.take_bytes(std::min<std::size_t>(length, kMailboxSize - kMailboxHeader));
      write(out, MailboxHeader{.length = static_cast<std::uint16_t>(payload.size()),
                               .type = static_cast<std::uint8_t>((type & 0x80) != 0 ? type & 0x0F : 3),
                               .counter = static_cast<std::uint8_t>(type & 7)});
      out.bytes(payload);
    } else {
      out.bytes(in_.take_bytes(kMailboxSize));
    }
    send(Command::kFpwr, address_of(kStation, kSyncManagers[0].start), memory);
  }

  void fetch() {
    const auto memory =
        send(Command::kFprd, address_of(kStation, kSyncManagers[1].start), std::vector<std::byte>(kMailboxSize));
    if (memory.empty() || device_.state() == AlState::kInit) return;  // of an application that does not serve it
    if (device_.esc().sync_manager(1).start != kSyncManagers[1].start) return;
    const auto read = parse_mail(memory);
    require(read && read->header.length > 0, "a mail that cannot be read");
    require(read->header.counter != 0, "a mail without a counter");
    require(read->header.type == 0 || read->header.type == 3, "a mail of a protocol that nobody spoke");
  }

  void trouble(unsigned choice) {
    DeviceFaults& faults = device_.faults();
    faults.no_mailbox = (choice & 1) != 0;
    faults.lose_mailbox_replies = (choice & 2) != 0;
    faults.frozen_inputs = (choice & 4) != 0;
    if ((choice & 8) != 0) device_.raise_al_error(in_.take<std::uint8_t>(), now_);
    if ((choice & 24) == 24) device_.power_cycle(now_);
    if ((choice & 16) != 0) device_.send_emergency({.code = in_.take<std::uint16_t>()});
  }

  void check() {
    const auto state = device_.state();
    require(state == AlState::kInit || state == AlState::kPreop || state == AlState::kSafeop || state == AlState::kOp,
            "a state that does not exist");
    const bool fresh = device_.take_fresh();
    require(!fresh || device_.counters().outputs > 0, "outputs that nobody counted");
  }

  fuzz::Source& in_;
  Device device_;
  Chain chain_{{&device_}};
  Time now_ = std::chrono::seconds(1);
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Source in(data, size);
  World world(in);
  for (int record = 0; record < 300 && !in.empty(); ++record) world.step();  // many short lives rather than a long one
  return 0;
}
