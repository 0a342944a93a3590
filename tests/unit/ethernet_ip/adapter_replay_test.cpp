// What independent originators sent to an independent adapter (OpENer with the identity and assemblies of a Meca500,
// firmware 11.3 at 172.28.1.3) comes to ours. Bytes as captured; ours must answer the same wherever the policy is the
// same. What differs by right is put in: the session handle and the ids that the adapter chose.
#include "tests/unit/ethernet_ip/adapter_rig.hpp"

namespace meca::ethernet_ip::adapter_test {
namespace {

constexpr const char* kRegister = "65000400 00000000 00000000 0000000000000000 00000000 0100 0000";

// One TCP connection after the other, as in the captures.
class AdapterReplay : public ::testing::Test {
 protected:
  explicit AdapterReplay(const AdapterSettings& settings = meca500()) : rig(settings) {}

  void new_connection() {
    rig.adapter.tcp_closed(0, rig.now);
    rig.connect(0);
    session_ = read_header(bytes(rig.tcp(kRegister))).value().session;
  }
  // Sends a captured message in our session; the reply, its session put back to the captured 1.
  std::string send(std::string_view captured) {
    std::string reply = rig.tcp(in_session(bytes(captured), session_));
    return reply.empty() ? reply : hex(in_session(bytes(reply), 1));
  }
  // The same for a Forward Open that is accepted: the captured reply with our ids in it.
  void expect_opened(std::string_view captured_request, std::string_view captured_reply) {
    const auto reply = bytes(send(captured_request));
    auto wanted = bytes(captured_reply);
    ASSERT_EQ(reply.size(), wanted.size());
    constexpr std::ptrdiff_t kIds =
        kHeaderSize + 6 + 2 + 4 + 4 + 4;  // handle, time-out, count, two items, reply header
    std::copy_n(reply.begin() + kIds, 4, wanted.begin() + kIds);
    rig.opened = read_forward_open_reply(Bytes(reply).subspan(kIds)).value();
    if (multicast) std::copy_n(reply.begin() + kIds + 4, 4, wanted.begin() + kIds + 4);
    EXPECT_EQ(hex(reply), hex(wanted));
    rig.sequence = 0;
  }
  // A captured O->T packet, the id in it replaced by ours.
  void io(std::string_view captured, std::uint16_t source_port) {
    auto packet = bytes(captured);
    wire::Writer(std::span(packet).subspan(6, 4)).u32(rig.opened.o_to_t_id);
    rig.adapter.io_received({kOriginator, source_port}, packet, rig.now);
  }

  AdapterRig rig;
  bool multicast = false;

 private:
  static std::vector<std::byte> in_session(std::vector<std::byte> message, std::uint32_t session) {
    wire::Writer(std::span(message).subspan(4, 4)).u32(session);
    return message;
  }
  std::uint32_t session_ = 0;
};

std::string plain(std::string_view hex_with_spaces) { return hex(bytes(hex_with_spaces)); }

const std::string kZeroImage(120, '0');

// ---- meca1.pcapng: EIPScanner, point to point, 16 bit request path

TEST_F(AdapterReplay, EipScannerOpensExchangesAndClosesPointToPoint) {
  new_connection();
  expect_opened(
      "6f004400010000000000000000000000000000000000000000000000000002000000 0000b2003400 540421000600250001000af50000"
      "000001002ddc010034125b69026b0000000010270000424810270000fe48010320042c962c64",
      "6f0042000100000000000000000000000000000000000000000000000000030000000000b2001e00d40000001300e63f01002ddc01003412"
      "5b69026b1027000010270000000000801000000208ae000000000000000000000000");
  EXPECT_EQ(rig.opened.t_to_o_id, 0xDC2D0001u);
  io("0200028008001300e63f01000000b10042000100010000000000000001000000090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f20"
     "2122232425262728292a2b2c2d2e2f303132333435363738393a3b3c",
     58323);
  EXPECT_TRUE(rig.adapter.run());
  EXPECT_EQ(hex(rig.adapter.output()).substr(0, 20), "0000000001000000090a");
  rig.now += 10ms;
  io("0200028008001300e63f02000000b100420002000100000000000000020000000a0b0c0d0e0f101112131415161718191a1b1c1d1e1f2021"
     "22232425262728292a2b2c2d2e2f303132333435363738393a3b3c3d",
     58323);
  EXPECT_EQ(hex(rig.adapter.output()).substr(0, 20), "00000000020000000a0b");
  EXPECT_EQ(rig.adapter.counters().consumed, 2u);
  EXPECT_EQ(
      send("6f002c000100000000000000000000000000000000000000000000000000020000000000b2001c004e0421000600250001000000"
           "010034125b69026b030020042c962c64"),
      "6f001e000100000000000000000000000000000000000000000000000000020000000000b2000e00ce000000010034125b69026b0000");
  send("660000000100000000000000000000000000000000000000");
  EXPECT_TRUE(rig.adapter.wants_closed(0));
}

// ---- eeip.pcapng: EEIP.NET, with a configuration instance of 0 and a socket address item

TEST_F(AdapterReplay, EeipOpensPointToPointWithAnItemForItsPort) {
  new_connection();
  expect_opened(
      "6f0056000100000000000000000000000000000000000000000000000000030000000000b200320054022006240103fa24481c09c18d7f06"
      "f1"
      "58ff00ffffffff0300000010270000424810270000fe480104200424002c962c6401801000000208ae000000000000000000000000",
      "6f0056000100000000000000000000000000000000000000000000000000040000000000b2001e00d4000000130086c6c18d7f06f158ff00"
      "ff"
      "ffffff1027000010270000000000801000000208ae00000000000000000000000001801000000208ae000000000000000000000000");
  io("020002800800130086c601000000b1004200010001000000" + kZeroImage, 37960);
  EXPECT_TRUE(rig.adapter.run());
  EXPECT_EQ(
      send("6f002a000100000000000000000000000000000000000000000000000000020000000000b2001a004e022006240103faf158ff00"
           "ffffffff0400200424002c962c64"),
      "6f001e000100000000000000000000000000000000000000000000000000020000000000b2000e00ce000000f158ff00ffffffff0000");
}

TEST_F(AdapterReplay, EeipOpensMulticastAndIsToldTheGroup) {
  multicast = true;
  new_connection();
  expect_opened(
      "6f0056000100000000000000000000000000000000000000000000000000030000000000b200320054022006240103fab530760aac04ee02"
      "92"
      "7cff00ffffffff0300000010270000424810270000fe280104200424002c962c6401801000000208ae000000000000000000000000",
      "6f0056000100000000000000000000000000000000000000000000000000040000000000b2001e00d4000000140086c6150086c6927cff00"
      "ff"
      "ffffff1027000010270000000000801000000208ae00000000000000000000000001801000000208aeefc001400000000000000000");
  const auto sent = rig.run_for(1ms);
  EXPECT_EQ(sent.at(0).to, (SocketAddress{0xEFC00140, 2222}));
  EXPECT_EQ(sent.at(0).packet().connection_id, rig.opened.t_to_o_id);
  EXPECT_EQ(
      send("6f002a000100000000000000000000000000000000000000000000000000020000000000b2001a004e022006240103fa927cff00"
           "ffffffff0400200424002c962c64"),
      "6f001e000100000000000000000000000000000000000000000000000000020000000000b2000e00ce000000927cff00ffffffff0000");
}

// ---- vendor.pcapng: as the vendor's Omron project asks, multicast at 50 ms, with keys of firmware 10.2 and 11.3

TEST_F(AdapterReplay, AnOmronProjectOfFirmware10IsRefusedForItsKeyAndOneOf11Accepted) {
  multicast = true;
  new_connection();
  EXPECT_EQ(
      send("6f004a00010000000000000070726f626500000000000000000000000000020000000000b2003a005402200624010af500000000a8"
           "653ebf03cbad0b515151510000000050c30000424850c30000fe28010834041d062b00f4018a0220042c962c64"),
      "6f002000010000000000000070726f626500000000000000000000000000020000000000b2001000d4000101160103cbad0b51515151000"
      "0");
  new_connection();
  expect_opened(
      "6f004000010000000000000070726f626500000000000000000000000000020000000000b20030005402200624010af500000000032b8f64"
      "04cb"
      "ad0b515151510000000050c30000424850c30000fe28010320042c962c64",
      "6f005600010000000000000070726f626500000000000000000000000000040000000000b2001e00d4000000130005441400054404cbad0b"
      "5151"
      "515150c3000050c30000000000801000000208ae00000000000000000000000001801000000208aeefc001400000000000000000");
  EXPECT_EQ(
      send("6f002800010000000000000070726f626500000000000000000000000000020000000000b20018004e02200624010af504cbad0b51"
           "515151030020042c962c64"),
      "6f001e00010000000000000070726f626500000000000000000000000000020000000000b2000e00ce00000004cbad0b515151510000");
  new_connection();
  expect_opened(
      "6f004a00010000000000000070726f626500000000000000000000000000020000000000b2003a005402200624010af50000000057dad0ce"
      "05cb"
      "ad0b515151510000000050c30000424850c30000fe28010834041d062b00f4018b0320042c962c64",
      "6f005600010000000000000070726f626500000000000000000000000000040000000000b2001e00d4000000150005441600054405cbad0b"
      "5151"
      "515150c3000050c30000000000801000000208ae00000000000000000000000001801000000208aeefc001400000000000000000");
  EXPECT_EQ(
      send("6f003200010000000000000070726f626500000000000000000000000000020000000000b20022004e02200624010af505cbad0b51"
           "515151080034041d062b00f4018b0320042c962c64"),
      "6f001e00010000000000000070726f626500000000000000000000000000020000000000b2000e00ce00000005cbad0b515151510000");
}

// ---- wd2.pcapng: connections left to time out; between them another originator is refused, the same one accepted

AdapterSettings keeping() {
  auto settings = meca500();
  settings.ownership = OwnershipPolicy::kKeep;  // as the adapter in the capture
  return settings;
}

class ReplayTimeouts : public AdapterReplay {
 protected:
  ReplayTimeouts() : AdapterReplay(keeping()) {}
};

// Watchdogs of the capture: O->T RPI and multiplier code; O->T sent, and T->O seen, until (in ms after the opening).
struct Watchdog {
  const char *request, *reply;  // from the connection id of T->O on: what differs between the openings
  int packets, rpi_ms;
  Time last_sent, last_seen, limit;
};

TEST_F(ReplayTimeouts, EndTToOWhenTheCaptureShowsItAndKeepTheOwnership) {
  const std::string request_head =
      "6f004000010000000000000070726f626500000000000000000000000000020000000000b20030005402200624010af500000000";
  const std::string reply_head =
      "6f004200010000000000000070726f626500000000000000000000000000030000000000b2001e00d400000013000644";
  const std::string reply_tail = "000000801000000208ae000000000000000000000000";
  const Watchdog all[] = {
      {"560b11abd513ad0b515151510000000010270000424810270000fe48010320042c962c64",
       "560b11abd513ad0b515151511027000010270000", 100, 10, 990ms, 1019ms, 40ms},
      {"57861238d813ad0b515151510300000010270000424810270000fe48010320042c962c64",
       "57861238d813ad0b515151511027000010270000", 100, 10, 990ms, 1300ms, 320ms},
      {"7d78a586db13ad0b5151515100000000a0860100424810270000fe48010320042c962c64",
       "7d78a586db13ad0b51515151a086010010270000", 10, 100, 900ms, 1290ms, 400ms},
      {"41b559fede13ad0b5151515101000000204e0000424810270000fe48010320042c962c64",
       "41b559fede13ad0b51515151204e000010270000", 50, 20, 980ms, 1130ms, 160ms},
  };
  for (const Watchdog& w : all) {
    new_connection();
    expect_opened(request_head + w.request, reply_head + w.reply + reply_tail);
    const Time begin = rig.now;
    Time last_seen{};
    for (int i = 0; i < w.packets; ++i) {
      rig.io({.fill = 0});
      for (const auto& sent : rig.run_for(i + 1 < w.packets ? std::chrono::milliseconds(w.rpi_ms) : 2000ms)) {
        last_seen = sent.at - begin;
      }
    }
    EXPECT_FALSE(rig.adapter.connected());
    // The adapter of the capture looks every 10 ms; ours sends up to the very end.
    EXPECT_NEAR(static_cast<double>((last_seen - w.last_seen) / 1ms), 0, 12);
    EXPECT_LT(last_seen, w.last_sent + w.limit);

    new_connection();  // originator 0x51515158
    EXPECT_EQ(
        send(request_head + "348c60fed613ad0b585151510000000010270000424810270000fe48010320042c962c64"),
        plain("6f002000010000000000000070726f626500000000000000000000000000020000000000b2001000d40001010601d613ad0b"
              "585151510000"));
    expect_opened(request_head + "dad631a8d713ad0b515151510000000010270000424810270000fe48010320042c962c64",
                  reply_head + "dad631a8d713ad0b515151511027000010270000" + reply_tail);
    EXPECT_EQ(
        send("6f002800010000000000000070726f626500000000000000000000000000020000000000b20018004e02200624010af5d713ad0b"
             "51515151030020042c962c64"),
        "6f001e00010000000000000070726f626500000000000000000000000000020000000000b2000e00ce000000d713ad0b515151510000");
  }
}

TEST_F(ReplayTimeouts, AnOriginatorThatNeverSendsStillGetsTToO) {
  new_connection();
  expect_opened(
      "6f004000010000000000000070726f626500000000000000000000000000020000000000b20030005402200624010af500000000bf"
      "ae72c4e113ad0b515151510000000010270000424810270000fe48010320042c962c64",
      "6f004200010000000000000070726f626500000000000000000000000000030000000000b2001e00d40000001b000644bfae72c4e113"
      "ad0b515151511027000010270000000000801000000208ae000000000000000000000000");
  EXPECT_EQ(rig.run_for(1501ms).size(), 151u);  // 151 packets in the capture
  EXPECT_EQ(
      send("6f002800010000000000000070726f626500000000000000000000000000020000000000b20018004e02200624010af5e113ad0b51"
           "515151030020042c962c64"),
      "6f001e00010000000000000070726f626500000000000000000000000000020000000000b2000e00ce000000e113ad0b515151510000");
}

}  // namespace
}  // namespace meca::ethernet_ip::adapter_test
