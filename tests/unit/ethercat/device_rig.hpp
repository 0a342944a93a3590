// A device at the end of a cable: datagrams in and out, time moved by hand.
#pragma once

#include <algorithm>
#include <chrono>

#include "tests/unit/ethercat/device_coe_rig.hpp"
#include "transports/ethercat/frame.hpp"

namespace meca::ethercat::device_test {

using namespace std::chrono_literals;

struct DeviceRig {
  static constexpr std::uint16_t kAddress = 0x1001;
  static constexpr MacAddress kMaster{std::byte{0x10}, std::byte{0x10}, std::byte{0x10},
                                      std::byte{0x10}, std::byte{0x10}, std::byte{0x10}};

  explicit DeviceRig(const DeviceSettings& settings = meca500()) : device(settings) {
    write(reg::kStationAddress, "01 10", Command::kApwr, 0);
  }

  struct Answer {
    std::vector<std::byte> data;
    std::uint16_t working_counter = 0;
  };
  Answer exchange(Command command, std::uint32_t address, Bytes data) {
    std::array<std::byte, kLongestFrame> buffer{};
    FrameWriter writer(buffer, kMaster);
    std::ranges::copy(data, writer.add(command, 1, address, data.size()).begin());
    const auto datagram = DatagramWalk<std::byte>(std::span(buffer).first(writer.finish().size())).next();
    device.esc().process(*datagram, now);
    return {{datagram->data().begin(), datagram->data().end()}, datagram->working_counter()};
  }

  // ---- Registers; what is returned is the working counter, or the bytes.
  std::uint16_t write(std::uint16_t at, Bytes data, Command command = Command::kFpwr, std::uint16_t adp = kAddress) {
    return exchange(command, address_of(adp, at), data).working_counter;
  }
  std::uint16_t write(std::uint16_t at, std::string_view data, Command command = Command::kFpwr,
                      std::uint16_t adp = kAddress) {
    return write(at, Bytes(bytes(data)), command, adp);
  }
  std::string read(std::uint16_t at, std::size_t size) {
    return hex(exchange(Command::kFprd, address_of(kAddress, at), std::vector<std::byte>(size)).data);
  }

  // ---- AL
  // The state and, with an error, the code: "PREOP", "SAFEOP+001B".
  std::string al() {
    const auto bytes = exchange(Command::kFprd, address_of(kAddress, reg::kAlStatus), std::vector<std::byte>(6)).data;
    wire::Reader in(bytes);
    const std::uint16_t status = in.u16();
    in.u16();
    const std::uint16_t code = in.u16();
    constexpr std::array<const char*, 9> kNames{"0", "INIT", "PREOP", "BOOT", "SAFEOP", "5", "6", "7", "OP"};
    const std::string name = kNames.at(status & kAlStateMask);
    if ((status & kAlError) == 0) return code == 0 ? name : name + " with a code";
    return name + std::string(FixedText<8>::format("+%04X", code).view());
  }
  std::string ask(std::uint8_t control, Time wait = 10ms) {
    const std::array<std::byte, 2> bytes{std::byte{control}, std::byte{0}};
    write(reg::kAlControl, bytes);
    run(wait);
    return al();
  }

  void run(Time time) {
    for (const Time end = now + time; now < end; now += 1ms) device.tick(now);
    device.tick(now);
  }
  // One cycle of 1 ms with 60 bytes out and 252 in; the working counter.
  std::uint16_t cycle(std::uint8_t first = 0) {
    std::vector<std::byte> image(kOutputSize + kInputSize);
    image[0] = std::byte{first};
    last_cycle = exchange(Command::kLrw, 0, image);
    device.tick(now);
    now += 1ms;
    return last_cycle.working_counter;
  }

  // Start, length and control can be written only while a sync manager is off.
  void set_sync_manager(unsigned n, std::string_view setting) {
    write(reg::sync_manager(n) + 6, "00");
    write(reg::sync_manager(n), setting);
  }

  // ---- What a master does on the way up
  void set_up_mailbox() {
    for (unsigned n = 0; n < 2; ++n) write(reg::sync_manager(n), sync_manager_bytes(n, true));
  }
  void set_up_process_data() {
    for (unsigned n = 2; n < 4; ++n) write(reg::sync_manager(n), sync_manager_bytes(n, true));
    write(reg::fmmu(0), fmmu_bytes(0, true));
    write(reg::fmmu(1), fmmu_bytes(kOutputSize, false));
  }
  void give_sii_back() { write(reg::kSiiOwner, "01"); }
  void assign() {
    const bool safety = device_has_safety;
    sdo("00 20 31 12 1C 00 14 00 00 00 09 00 00 16 01 16 02 16 10 16 11 16 20 16 21 16 22 16 23 16");
    sdo(safety ? "00 20 31 13 1C 00 1C 00 00 00 0D 00 00 1A 01 1A 02 1A 03 1A 08 1A 09 1A 0A 1A 10 1A 11 1A 20 1A 21 "
                 "1A 22 "
                 "1A 23 1A"
               : "00 20 31 13 1C 00 1A 00 00 00 0C 00 00 1A 01 1A 02 1A 03 1A 08 1A 09 1A 0A 1A 10 1A 20 1A 21 1A 22 "
                 "1A 23 "
                 "1A");
  }
  void to_preop() {
    set_up_mailbox();
    give_sii_back();
    ASSERT_EQ(ask(0x02), "PREOP");
  }
  void to_safeop() {
    to_preop();
    assign();
    set_up_process_data();
    ASSERT_EQ(ask(0x04), "SAFEOP");
  }
  void to_op() {
    to_safeop();
    cycle();
    write(reg::kAlControl, "08 00");
    for (int i = 0; i < 10; ++i) cycle();
    ASSERT_EQ(al(), "OP");
  }

  // ---- Mailbox
  // A mail of CoE with the next counter; the working counter.
  std::uint16_t post(std::string_view payload, std::optional<std::uint8_t> with_counter = std::nullopt,
                     MailboxType type = MailboxType::kCoe) {
    counter = with_counter ? *with_counter : next_mailbox_counter(counter);
    const auto data = bytes(payload);
    std::array<std::byte, kMailboxSize> mail{};
    wire::Writer out(mail);
    ethercat::write(out, MailboxHeader{.length = static_cast<std::uint16_t>(data.size()),
                                       .type = static_cast<std::uint8_t>(type),
                                       .counter = counter});
    out.bytes(data);
    return write(kSyncManagers[0].start, mail);
  }
  // What lies in the mailbox: "type counter: payload", or "empty".
  std::string fetch() {
    const Answer answer =
        exchange(Command::kFprd, address_of(kAddress, kSyncManagers[1].start), std::vector<std::byte>(kMailboxSize));
    if (answer.working_counter == 0) return "empty";
    const auto mail = parse_mail(answer.data);
    return std::to_string(mail->header.type) + " " + std::to_string(mail->header.counter) + ": " + hex(mail->payload);
  }
  // Asks and waits for the answer; its payload. Emergencies are passed over.
  std::string sdo(std::string_view payload) {
    post(payload);
    while (true) {
      run(5ms);
      const std::string mail = fetch();
      if (mail.substr(5, 5) != "00 10") return mail.substr(5);
    }
  }

  Time now = 1s;
  Device device;
  bool device_has_safety = true;
  std::uint8_t counter = 0;
  Answer last_cycle;
};

}  // namespace meca::ethercat::device_test
