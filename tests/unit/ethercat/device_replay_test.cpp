// What independent masters sent to independent devices comes to ours: tests/captures/ethercat. Ours answers without
// taking time, so whatever a master waited for is there when it looks. Differences that are expected are named.
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include "tests/unit/ethercat/device_rig.hpp"
#include "transports/ethercat/chain.hpp"

namespace meca::ethercat::device_test {
namespace {

struct Exchange {
  Command command;
  std::uint32_t address;
  std::vector<std::byte> data;
  std::uint16_t working_counter;
  std::vector<std::byte> reply;  // of mails and AL states
};
struct Frame {
  Time after;
  std::vector<Exchange> datagrams;
};

Exchange parse_exchange(std::istream& in) {
  std::string command, address, data, reply;
  std::size_t size = 0;
  Exchange out{};
  in >> command >> address >> size >> data >> out.working_counter;
  out.command = static_cast<Command>(std::stoul(command, nullptr, 16));
  const auto adp = std::stoul(address.substr(0, 4), nullptr, 16), ado = std::stoul(address.substr(4), nullptr, 16);
  out.address = static_cast<std::uint32_t>(ado << 16 | adp);
  out.data = data == "-" ? std::vector<std::byte>{} : bytes(data);
  out.data.resize(size);
  if (in >> reply) out.reply = bytes(reply);
  return out;
}

std::vector<Frame> load(const std::string& name) {
  std::ifstream file(MECA_SOURCE_DIR "/tests/captures/ethercat/" + name + ".txt");
  std::vector<Frame> frames;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    long after = 0;
    words >> after;
    Frame frame{std::chrono::microseconds(after), {}};
    for (std::string part; std::getline(words, part, '|');) {
      std::istringstream in(part);
      frame.datagrams.push_back(parse_exchange(in));
    }
    frames.push_back(std::move(frame));
  }
  if (frames.empty()) throw std::runtime_error("no capture " + name);
  return frames;
}

constexpr std::uint32_t kFetch = 0x1080, kPost = 0x1000;

// What a master has to do with one device.
struct Master {
  std::string object;  // of the request that waits for an answer, as "1018"
  std::vector<std::pair<std::string, std::string>> answers, captured;  // object, payload
  std::vector<std::string> states, captured_states;

  void ask(Bytes mail) {
    wire::Reader in(parse_mail(mail).value().payload);
    const CoeHeader header = read_coe_header(in);
    const auto sdo = parse_sdo(static_cast<CoeService>(header.service), in.rest());
    if (!sdo || sdo->address.index == 0) return;  // a segment belongs to what was before it
    object = FixedText<8>::format("%04X", static_cast<unsigned>(sdo->address.index)).view();
  }
};

// Devices in a row, and what they and the captured ones answered.
class Replay {
 public:
  explicit Replay(const std::vector<DeviceSettings>& devices) : devices_(make(devices)), chain_(cable(devices_)) {}

  void play(const std::string& name) {
    for (const Frame& frame : load(name)) {
      for (const Time end = now_ + frame.after; now_ < end;) {
        now_ = std::min(now_ + 1ms, end);
        for (auto& device : devices_) device->tick(now_);
      }
      send(frame);
      for (auto& device : devices_) device->tick(now_);
    }
  }

  Device& device(std::size_t n) { return *devices_[n]; }
  // Objects about which ours has something else to say, each once; and how many answers were the same.
  std::set<std::string> other_objects() const {
    std::set<std::string> out;
    for (const auto& [station, master] : masters_) {
      if (master.answers.size() != master.captured.size()) out.insert("another number of mails");
      for (std::size_t i = 0; i < std::min(master.answers.size(), master.captured.size()); ++i) {
        if (master.answers[i] != master.captured[i]) out.insert(master.answers[i].first);
      }
    }
    return out;
  }
  std::size_t same_answers() const {
    std::size_t count = 0;
    for (const auto& [station, master] : masters_) {
      for (std::size_t i = 0; i < std::min(master.answers.size(), master.captured.size()); ++i) {
        count += master.answers[i] == master.captured[i];
      }
    }
    return count;
  }
  // AL states as the master read them of each device: what changed.
  std::vector<std::string> states(bool captured = false) const {
    std::vector<std::string> out;
    for (const auto& [station, master] : masters_) {
      const auto& states = captured ? master.captured_states : master.states;
      out.insert(out.end(), states.begin(), states.end());
    }
    return out;
  }
  // Working counters that differ, each once, apart from those of mails and polls: "command address: ours, captured".
  const std::map<std::string, int>& other_working_counters() const { return other_working_counters_; }

 private:
  using Devices = std::vector<std::unique_ptr<Device>>;
  static Devices make(const std::vector<DeviceSettings>& all) {
    Devices out;
    for (DeviceSettings settings : all) {
      settings.transition = settings.mailbox_reply = settings.esc.sii_busy = Time{};
      out.push_back(std::make_unique<Device>(settings));
    }
    return out;
  }
  static std::vector<Device*> cable(const Devices& devices) {
    std::vector<Device*> out;
    for (const auto& device : devices) out.push_back(device.get());
    return out;
  }

  void send(const Frame& captured) {
    std::array<std::byte, kLongestFrame> buffer{};
    FrameWriter writer(buffer, DeviceRig::kMaster);
    for (const Exchange& exchange : captured.datagrams) {
      std::ranges::copy(exchange.data, writer.add(exchange.command, 1, exchange.address, exchange.data.size()).begin());
    }
    const auto frame = std::span(buffer).first(writer.finish().size());
    chain_.process(Chain::Side::kPrimary, frame, now_);
    DatagramWalk<std::byte> walk(frame);
    for (const Exchange& exchange : captured.datagrams) compare(exchange, walk.next().value());
  }

  void compare(const Exchange& exchange, const MutableDatagram& answer) {
    const bool logical = exchange.command >= Command::kLrd && exchange.command <= Command::kLrw;
    const std::uint32_t ado = exchange.address >> 16;
    Master& master = masters_[static_cast<std::uint16_t>(exchange.address)];
    if (!logical && ado == kPost) return master.ask(exchange.data);
    if (!logical && ado == kFetch) {
      if (!exchange.reply.empty()) master.captured.emplace_back(master.object, meaning(exchange.reply));
      if (answer.working_counter() != 0) master.answers.emplace_back(master.object, meaning(answer.data()));
      return;
    }
    if (!logical && ado == reg::kAlStatus) {
      note(master.captured_states, exchange.reply);
      note(master.states, answer.data());
    }
    if (answer.working_counter() != exchange.working_counter) {
      const auto name =
          FixedText<64>::format("command %d at %04X: %d, captured %d", static_cast<int>(exchange.command),
                                static_cast<unsigned>(ado), answer.working_counter(), exchange.working_counter);
      ++other_working_counters_[std::string(name.view())];
    }
  }
  // The payload. What stands in bytes without a meaning is left out: SOES sends what happens to be there.
  static std::string meaning(Bytes memory) {
    std::vector<std::byte> payload;
    std::ranges::copy(parse_mail(memory).value().payload, std::back_inserter(payload));
    const auto command = std::to_integer<unsigned>(payload.at(2));
    const bool expedited = (command & 0xE3) == 0x43, confirmation = (command & 0xE0) == 0x20;
    if (expedited) payload.resize(payload.size() - (command >> 2 & 3));
    if (confirmation) payload.resize(3);
    return hex(payload);
  }
  static void note(std::vector<std::string>& states, Bytes bytes) {
    std::string state = hex(bytes.first(1));
    if (states.empty() || states.back() != state) states.push_back(std::move(state));
  }

  Devices devices_;
  Chain chain_;
  Time now_ = 1s;
  std::map<std::uint16_t, Master> masters_;  // by station address
  std::map<std::string, int> other_working_counters_;
};

DeviceSettings assigned(Layout layout) {
  DeviceSettings settings = meca500(layout);
  settings.assigned = true;  // as the captured devices were
  return settings;
}

// 2F00h: an object of 512 bytes that only the captured device has.
TEST(DeviceReplay, SoemReachesOp) {
  Replay replay({assigned(Layout::kFirmware10)});
  replay.play("soem2");
  EXPECT_EQ(replay.states(), replay.states(true));
  EXPECT_THAT(replay.other_objects(), testing::ElementsAre("2F00"));
  EXPECT_GT(replay.same_answers(), 30u);
  EXPECT_THAT(replay.other_working_counters(), testing::ElementsAre());
  EXPECT_TRUE(replay.device(0).operational());
  EXPECT_GT(replay.device(0).counters().outputs, 20u);
}

// The captured device has the PDOs of an older firmware 9.
TEST(DeviceReplay, KickCatReachesOp) {
  Replay replay({assigned(Layout::kFirmware9)});
  replay.play("kickcat");
  EXPECT_EQ(replay.states(), replay.states(true));
  EXPECT_THAT(replay.other_objects(), testing::ElementsAre("1A00", "1A01", "2F00"));
  EXPECT_GT(replay.same_answers(), 100u);
  EXPECT_THAT(replay.other_working_counters(), testing::ElementsAre());
  EXPECT_TRUE(replay.device(0).operational());
}

// The same PDOs, and a clock that stands still.
TEST(DeviceReplay, EthercrabReadsThreeRobots) {
  Replay replay({assigned(Layout::kFirmware9), assigned(Layout::kFirmware9), assigned(Layout::kFirmware9)});
  replay.play("ethercrab");
  EXPECT_EQ(replay.states(), replay.states(true));
  EXPECT_THAT(replay.other_objects(), testing::ElementsAre("10F8", "1A00", "1A01"));
  EXPECT_GT(replay.same_answers(), 150u);
  EXPECT_THAT(replay.other_working_counters(), testing::ElementsAre());
}

TEST(DeviceReplay, LibethercatReadsTheSii) {
  Replay replay({assigned(Layout::kFirmware9)});
  replay.play("libethercat");
  EXPECT_EQ(replay.states(), replay.states(true));
  EXPECT_THAT(replay.other_working_counters(), testing::ElementsAre());
}

}  // namespace
}  // namespace meca::ethercat::device_test
