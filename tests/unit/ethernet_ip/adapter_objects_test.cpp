// What explicit messages read, and how they are refused. Expected bytes: attributes as CIP numbers and types
// them, values of the device in the captures.
#include "tests/unit/ethernet_ip/adapter_rig.hpp"

namespace meca::ethernet_ip::adapter_test {
namespace {

struct Read {
  const char* request;
  std::string outcome;  // data, or the general status behind a "!"
};

std::string ask(AdapterRig& rig, const char* request) {
  const std::string outcome = rig.cip(request);
  return outcome == "ok" ? rig.last_data : "!" + outcome;
}

void expect_all(AdapterRig& rig, std::initializer_list<Read> reads) {
  for (const Read& r : reads) {
    std::string wanted = r.outcome;
    std::erase(wanted, ' ');
    EXPECT_EQ(ask(rig, r.request), wanted) << r.request;
  }
}

std::string zeros(std::size_t count) { return std::string(2 * count, '0'); }

class AdapterObjects : public ::testing::Test {
 protected:
  AdapterObjects() { rig.enter(); }
  AdapterRig rig;
};

TEST_F(AdapterObjects, IdentityIsReadInOnePieceAndInSingles) {
  expect_all(rig, {
                      {"01 02 20 01 24 01", "1d06 2b00 f401 0b03 0000 15cd5b07 07 4d656361353030"},
                      {"0E 03 20 01 24 01 30 01", "1d06"},
                      {"0E 03 20 01 24 01 30 02", "2b00"},
                      {"0E 03 20 01 24 01 30 03", "f401"},
                      {"0E 03 20 01 24 01 30 04", "0b03"},
                      {"0E 03 20 01 24 01 30 05", "0000"},
                      {"0E 03 20 01 24 01 30 06", "15cd5b07"},
                      {"0E 03 20 01 24 01 30 07", "07 4d656361353030"},
                      {"0E 03 20 01 24 01 30 08", "!14"},
                      {"01 04 21 00 01 00 25 00 01 00", "1d06 2b00 f401 0b03 0000 15cd5b07 07 4d656361353030"},
                  });
}

TEST_F(AdapterObjects, ClassesTellRevisionAndHighestNumbers) {
  expect_all(rig, {
                      {"01 02 20 01 24 00", "0100 0100 0700 0700"},
                      {"0E 03 20 01 24 00 30 01", "0100"},
                      {"0E 03 20 04 24 00 30 01", "0200"},
                      {"0E 03 20 04 24 00 30 02", "9600"},
                      {"0E 03 20 04 24 00 30 03", "0200"},
                      {"0E 03 20 48 24 00 30 07", "0800"},
                      {"0E 03 20 F5 24 00 30 01", "0400"},
                      {"0E 03 20 F6 24 00 30 06", "0700"},
                      {"0E 03 20 01 24 00 30 04", "!14"},
                      {"01 02 20 48 24 00", "!08"},
                  });
}

TEST_F(AdapterObjects, AssembliesShowWhatIsSentAndWhatWasReceived) {
  image::InputBytes input{};
  input[0] = std::byte{0xAB};
  input[251] = std::byte{0xCD};
  rig.adapter.set_input(input);
  ASSERT_EQ(rig.open(usual_open()), "ok");
  rig.io({.fill = 0x42});
  std::string output;
  for (int i = 0; i < 60; ++i) output += "42";
  EXPECT_EQ(ask(rig, "0E 03 20 04 24 64 30 03"), hex(input));
  EXPECT_EQ(ask(rig, "0E 03 20 04 24 96 30 03"), output);
  expect_all(rig, {
                      {"0E 03 20 04 24 64 30 04", "fc00"},
                      {"0E 03 20 04 24 96 30 04", "3c00"},
                      {"0E 03 20 04 24 65 30 03", "!05"},
                      {"01 02 20 04 24 64", "!08"},
                  });
}

TEST_F(AdapterObjects, NobodyMovesTheRobotByWritingAnAssembly) {
  expect_all(rig, {{"10 03 20 04 24 96 30 03 01", "!0E"}, {"10 03 20 04 24 64 30 03 01", "!0E"}});
  EXPECT_EQ(rig.adapter.output(), image::OutputBytes{});
}

TEST_F(AdapterObjects, MessageRouterListsTheClassesItHas) {
  expect_all(rig,
             {{"0E 03 20 02 24 01 30 01", "0700 0100 0200 0400 0600 4800 f500 f600"}, {"01 02 20 02 24 01", "!08"}});
}

TEST_F(AdapterObjects, ConnectionManagerCountsOpensAndTimeouts) {
  auto f = usual_open();
  f.o_to_t.size = 64;
  rig.open(f);
  rig.open(usual_open());
  rig.run_for(11s);
  expect_all(rig, {{"0E 03 20 06 24 01 30 01", "0200"}, {"0E 03 20 06 24 01 30 08", "0100"}});
}

TEST_F(AdapterObjects, QosHasTheDscpOfEveryPriority) {
  expect_all(rig, {
                      {"0E 03 20 48 24 01 30 01", "00"},
                      {"0E 03 20 48 24 01 30 04", "37"},  // urgent 55; this and the next as read from a public stack
                      {"0E 03 20 48 24 01 30 05", "2f"},  // scheduled 47
                      {"0E 03 20 48 24 01 30 06", "2b"},
                      {"0E 03 20 48 24 01 30 07", "1f"},
                      {"0E 03 20 48 24 01 30 08", "1b"},
                      {"0E 03 20 48 24 01 30 02", "!14"},
                      {"10 03 20 48 24 01 30 05 00", "!0E"},
                      {"01 02 20 48 24 01", "!08"},
                  });
}

TEST_F(AdapterObjects, TcpIpInterfaceTellsAddressMulticastAndInactivity) {
  const std::string first = "01000000 00000000 00000000 0200 20f62401 03011cac 00ffffff";
  const std::string all =
      first + zeros(14) + zeros(2) + zeros(6) + "01 0000 0100 4001c0ef" + zeros(1 + 35 + 1) + "7800";
  expect_all(rig, {
                      {"01 02 20 F5 24 01", all},
                      {"0E 03 20 F5 24 01 30 01", "01000000"},
                      {"0E 03 20 F5 24 01 30 04", "0200 20f62401"},
                      {"0E 03 20 F5 24 01 30 05", "03011cac 00ffffff" + zeros(14)},
                      {"0E 03 20 F5 24 01 30 08", "01"},
                      {"0E 03 20 F5 24 01 30 09", "0000 0100 4001c0ef"},
                      {"0E 03 20 F5 24 01 30 0D", "7800"},
                      {"0E 03 20 F5 24 01 30 07", "!14"},
                      {"10 03 20 F5 24 01 30 0D 0000", "!0E"},
                  });
}

TEST_F(AdapterObjects, EthernetLinkIsUpAtOneHundredMegabit) {
  const std::string all =
      "64000000 0f000000 0200ac1c0103" + zeros(44) + zeros(48) + "0100 0000 02 01 01 00" + "02000000 01 6400 01";
  expect_all(rig, {
                      {"01 02 20 F6 24 01", all},
                      {"0E 03 20 F6 24 01 30 01", "64000000"},
                      {"0E 03 20 F6 24 01 30 02", "0f000000"},
                      {"0E 03 20 F6 24 01 30 03", "0200ac1c0103"},
                      {"0E 03 20 F6 24 01 30 0B", "02000000 01 6400 01"},
                      {"0E 03 20 F6 24 02 30 01", "!05"},
                  });
}

TEST_F(AdapterObjects, WhatDoesNotExistIsRefusedByItsKind) {
  expect_all(rig, {
                      {"01 02 20 99 24 01", "!05"},                             // class
                      {"01 02 20 01 24 02", "!05"},                             // instance
                      {"0E 03 20 01 24 01 30 63", "!14"},                       // attribute
                      {"0E 02 20 01 24 01", "!14"},                             // no attribute
                      {"10 03 20 01 24 01 30 63 00", "!14"},                    // attribute to be set
                      {"05 02 20 01 24 01", "!08"},                             // reset
                      {"52 02 20 06 24 01", "!08"},                             // unconnected send: not a router
                      {"54 02 20 01 24 01", "!08"},                             // Forward Open to another object
                      {"54 02 20 06 24 00", "!08"},                             // and to the class
                      {"01 02 20 01 24 01 00", "!15"},                          // data where none belongs
                      {"0E 03 20 01 24 01 30 01 00", "!15"},                    //
                      {"01 01 20 01", "!04"},                                   // no instance
                      {"01 01 24 01", "!04"},                                   // no class
                      {"01 00", "!04"},                                         // no path
                      {"01 03 20 01 24 01 2C 64", "!04"},                       // a connection point
                      {"01 03 20 01 24 01 80 00", "!04"},                       // a data segment
                      {"01 03 20 01 24 01 21 00", "!04"},                       // ends within a segment
                      {"01 03 20 01 24 01 44 01", "!04"},                       // a segment we do not know
                      {"01 07 34 05 0000 0000 0000 00 00 20 01 24 01", "!04"},  // key format 5
                  });
}

TEST_F(AdapterObjects, WhatIsNotARequestIsIncorrectData) {
  EXPECT_EQ(rig.cip(""), "encapsulation 03");
  EXPECT_EQ(rig.cip("01"), "encapsulation 03");
  EXPECT_EQ(rig.cip("01 03 20 01 24 01"), "encapsulation 03");  // path longer than the message
  EXPECT_EQ(rig.cip("81 02 20 01 24 01"), "encapsulation 03");  // a reply
}

TEST_F(AdapterObjects, AnElectronicKeyInThePathIsChecked) {
  EXPECT_EQ(rig.cip("01 07 34 04 1d06 2b00 f401 0b 03 20 01 24 01"), "ok");
  EXPECT_EQ(rig.cip("01 07 34 04 0000 0000 0000 00 00 20 01 24 01"), "ok");
  EXPECT_EQ(rig.cip("01 07 34 04 1e06 2b00 f401 0b 03 20 01 24 01"), "25 0114");
  EXPECT_EQ(rig.cip("01 07 34 04 1d06 2c00 f401 0b 03 20 01 24 01"), "25 0115");
  EXPECT_EQ(rig.cip("01 07 34 04 1d06 2b00 f401 0b 04 20 01 24 01"), "25 0116");
}

}  // namespace
}  // namespace meca::ethernet_ip::adapter_test
