// Anybody sends anything to three simulated robots in a row, whatever their cables do: a frame keeps its length and its
// structure, only what a command may change changes, and the robots stay in states that exist.
// Input: records of one kind byte and what belongs to it, until they run out.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

#include "tests/fuzz/source.hpp"
#include "transports/ethercat/chain.hpp"

namespace {

using namespace meca;
using namespace meca::ethercat;

constexpr MacAddress kMaster{std::byte{0x10}};
constexpr std::size_t kDevices = 3;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "ethercat_chain_fuzz: %s\n", what);
  std::abort();
}

// How often the devices can count a datagram, and whether they may change its ADP and its data.
struct Allowed {
  unsigned count;
  bool adp, data;
};
Allowed allowed(std::uint8_t command) {
  if (command == 0 || command >= kCommands) return {0, false, false};
  switch (static_cast<Command>(command)) {
    case Command::kNop:
      break;
    case Command::kAprd:
    case Command::kArmw:
    case Command::kBrd:
      return {kDevices, true, true};
    case Command::kApwr:
    case Command::kBwr:
      return {kDevices, true, false};
    case Command::kAprw:
    case Command::kBrw:
      return {3 * kDevices, true, true};
    case Command::kFprd:
    case Command::kFrmw:
    case Command::kLrd:
      return {kDevices, false, true};
    case Command::kFpwr:
    case Command::kLwr:
      return {kDevices, false, false};
    case Command::kFprw:
    case Command::kLrw:
      return {3 * kDevices, false, true};
  }
  return {0, false, false};
}

class World {
 public:
  explicit World(fuzz::Source& in) : in_(in) {
    const auto flags = in_.take<std::uint8_t>();
    DeviceSettings settings;
    settings.esc.sii_reads_8_bytes = (flags & 1) != 0;
    settings.esc.features = (flags & 2) != 0 ? 0xFFFF : 0x01CC;
    settings.assigned = (flags & 4) != 0;
    settings.alias = (flags & 8) != 0 ? 0x1003 : 0;
    for (auto& device : devices_) device.emplace(settings);
    chain_.emplace(std::vector<Device*>{&*devices_[0], &*devices_[1], &*devices_[2]});
    chain_->set_ring((flags & 16) != 0);
  }

  void step() {
    const auto kind = in_.take<std::uint8_t>();
    const std::size_t which = kind >> 4 & 3;
    Device& device = *devices_[which % kDevices];
    switch (kind & 7) {
      case 0:
        return pass(in_.take_bytes(in_.take<std::uint16_t>() % 2048));
      case 1:
      case 2:
        return pass(frame());
      case 3:
        return pass(set_up(which));
      case 4:
        now_ += std::chrono::microseconds(10) * (1u << (kind >> 4));
        break;
      case 5:
        return cable(which, in_.take<std::uint8_t>());
      case 6:
        device.set_input(image::InputBytes{});
        if ((kind & 8) != 0) device.raise_al_error(in_.take<std::uint16_t>(), now_);
        break;
      case 7:
        if ((kind & 8) != 0) device.power_cycle(now_);
        device.faults().working_counter = (kind & 0x40) != 0 ? -1 : 0;
        device.faults().lose_mailbox_replies = (kind & 0x80) != 0;
        faulty_ = faulty_ || (kind & 0x40) != 0;
        break;
    }
    tick();
  }

 private:
  // Right frames around whatever the input says.
  std::vector<std::byte> frame() {
    std::array<std::byte, kLongestFrame> buffer{};
    FrameWriter writer(buffer, kMaster);
    const auto count = in_.take<std::uint8_t>() % 5;
    for (int i = 0; i <= count; ++i) {
      const auto choice = in_.take<std::uint8_t>();  // a command, or none of them; 80h: 256 bytes more
      const auto address = in_.take<std::uint32_t>();
      const auto bytes = in_.take_bytes(in_.take<std::uint8_t>());
      const std::size_t size = std::max<std::size_t>(1, bytes.size() + ((choice & 0x80u) != 0 ? 256 : 0));
      const auto data = writer.add(static_cast<Command>(choice & 0x1Fu), static_cast<std::uint8_t>(i), address, size);
      if (data.size() >= bytes.size()) std::ranges::copy(bytes, data.begin());
    }
    const Bytes whole = writer.finish();
    return {whole.begin(), whole.end()};
  }

  // A step of what masters do, so that the input need not find it: sync managers, FMMUs, states, process data, mails.
  std::vector<std::byte> set_up(std::size_t which) {
    std::array<std::byte, kLongestFrame> buffer{};
    FrameWriter writer(buffer, kMaster);
    const auto position = auto_increment(static_cast<std::uint16_t>(which));
    const auto write = [&](std::uint16_t ado, Bytes bytes) {
      std::ranges::copy(bytes, writer.add(Command::kApwr, 1, address_of(position, ado), bytes.size()).begin());
    };
    const auto choice = in_.take<std::uint8_t>();
    const std::array<std::byte, 2> state{std::byte{choice} & std::byte{0x1F}, std::byte{0}};
    switch (choice >> 5) {
      case 0:
        for (unsigned n = 0; n < 4; ++n) write(reg::sync_manager(n), sync_manager_bytes(n, true));
        write(reg::fmmu(0), fmmu_bytes(0, true));
        write(reg::fmmu(1), fmmu_bytes(kOutputSize, false));
        break;
      case 1:
        write(reg::kAlControl, state);
        break;
      case 2:
        writer.add(Command::kLrw, 2, 0, kOutputSize + kInputSize);
        break;
      case 3: {
        std::array<std::byte, kMailboxSize> mail{};
        const auto bytes = in_.take_bytes(mail.size());
        std::ranges::copy(bytes, mail.begin());
        write(kSyncManagers[0].start, mail);
        break;
      }
      default:
        writer.add(Command::kAprd, 3, address_of(position, kSyncManagers[1].start), kMailboxSize);
        break;
    }
    const Bytes whole = writer.finish();
    return {whole.begin(), whole.end()};
  }

  void cable(std::size_t which, std::uint8_t flags) {
    if ((flags & 1) != 0) chain_->cut(which);
    if ((flags & 2) != 0) chain_->heal(which);
    if ((flags & 4) != 0) chain_->set_powered(which, (flags & 8) != 0);
    if ((flags & 16) != 0) chain_->set_ring((flags & 32) != 0);
    side_ = (flags & 64) != 0 ? Chain::Side::kSecondary : Chain::Side::kPrimary;
  }

  void pass(std::vector<std::byte> frame) {
    const std::vector<std::byte> before = frame;
    const auto out = chain_->process(side_, frame, now_);
    require(frame.size() == before.size(), "a frame of another length");
    if (!out) {
      require(frame == before, "a frame that was dropped was changed");
      return tick();
    }
    require(std::equal(frame.begin(), frame.begin() + 6, before.begin()), "another destination");
    require((frame[6] & ~kReplyBit) == (before[6] & ~kReplyBit), "another source");
    require(std::equal(frame.begin() + 7, frame.begin() + 16, before.begin() + 7), "another header");
    std::size_t end = kEthernetHeader + kFrameHeader;
    DatagramWalk<const std::byte> was{Bytes(before)}, is{Bytes(frame)};
    while (const auto a = was.next()) {
      const auto b = is.next();
      require(b.has_value(), "a datagram less");
      compare(*a, *b);
      end += kDatagramOverhead + a->data().size();
    }
    require(!is.next() && was.ok() == is.ok(), "a datagram more");
    require(std::equal(frame.begin() + static_cast<std::ptrdiff_t>(end), frame.end(),
                       before.begin() + static_cast<std::ptrdiff_t>(end)),
            "bytes behind the datagrams changed");
    tick();
  }

  void compare(const Datagram& was, const Datagram& is) {
    const Allowed may = allowed(was.raw_command());
    require(was.raw_command() == is.raw_command() && was.index() == is.index(), "another command or index");
    require(was.data().size() == is.data().size() && was.circulating() == is.circulating(), "another length");
    require(was.ado() == is.ado(), "another register");
    const auto passed = static_cast<std::uint16_t>(is.adp() - was.adp());
    require(may.adp ? passed <= kDevices : passed == 0, "another ADP");
    require((was.irq() & ~is.irq()) == 0, "an event less");
    require(may.data || std::ranges::equal(was.data(), is.data()), "a write changed its data");
    const auto counted = static_cast<std::uint16_t>(is.working_counter() - was.working_counter());
    require(faulty_ || counted <= may.count, "counted more than the devices can, or less than before");
  }

  void tick() {
    for (auto& device : devices_) {
      device->tick(now_);
      device->take_fresh();
      const unsigned state = device->esc().al_status() & kAlStateMask;
      require(state == 1 || state == 2 || state == 4 || state == 8, "in a state that does not exist");
      require(device->operational() == (state == 8), "states that contradict each other");
    }
  }

  fuzz::Source& in_;
  std::array<std::optional<Device>, kDevices> devices_;
  std::optional<Chain> chain_;
  Chain::Side side_ = Chain::Side::kPrimary;
  bool faulty_ = false;
  Time now_{};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Source in(data, size);
  World world(in);
  for (int record = 0; record < 300 && !in.empty(); ++record) world.step();  // many short lives rather than a long one
  return 0;
}
