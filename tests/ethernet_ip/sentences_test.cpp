// What a person reads where bridge and robot do not get together, word for word, in BridgeStatus and thus in
// `meca-ctl status`; and that they do, once the reason is gone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/ethernet_ip/programs.hpp"
#include "tests/session/adapter_host.hpp"

namespace meca::test {
namespace {

using testing::HasSubstr;

TEST(Sentence, OfAnotherDeviceSaysWhatWasFound) {
  auto other = meca500_at(arm1_address());
  other.identity.vendor_id = 1;
  other.identity.product_code = 65;
  const AdapterHost device(other);
  const BridgeProgram bridge({robot("arm1", arm1_address())});
  EXPECT_TRUE(bridge.until_told("another device at " + arm1_address() +
                                ": found vendor 1, type 43, product 65 "
                                "'Meca500', expected vendor 1565, type 43, product 500 (Meca500); check the address"));
}

TEST(Sentence, OfAKeyThatDoesNotFitSaysBothRevisions) {
  const SimProgram arm1(arm1_address(), {"--key-policy", "exact"});
  const BridgeProgram bridge({robot("arm1", arm1_address(), ", key: exact, key_revision: \"10.2\"")});
  EXPECT_TRUE(bridge.until_told("Forward Open refused (0x01/0x0116): key exactly 10.2 asked, the robot is 11.3; "));
}

TEST(Sentence, OfARobotThatIsOwnedSaysWhoMayHaveItAndTheBridgeGoesOnTrying) {
  const SimProgram arm1(arm1_address(), {"--fault", "refuse open 0x0106"});
  BridgeProgram bridge({robot("arm1", arm1_address())});
  EXPECT_TRUE(bridge.until_told("Forward Open refused (0x01/0x0106): another controller owns the robot's outputs"));
  EXPECT_THAT(bridge.ctl({"activate"}).output, HasSubstr("arm1: activate: rejected ("));
  EXPECT_EQ(arm1.say("faults off"), "ok: the network is healthy");
  EXPECT_TRUE(bridge.until_up());
}

TEST(Sentence, OfAnotherIntervalSaysWhatWasAskedAndWhatIsGranted) {
  const SimProgram arm1(arm1_address(), {"--fault", "api 20000"});
  BridgeProgram bridge({robot("arm1", arm1_address())});
  ASSERT_TRUE(bridge.until_up());
  const auto now = bridge.status()["bridge_status"];
  EXPECT_EQ(now["transport_counters"]["api_t_to_o_us"], 20'000);
  EXPECT_THAT(now["link_detail"].get<std::string>(),
              HasSubstr("the robot grants a packet interval of 20 ms O->T and 20 ms T->O, 10 and 10 ms were asked for; "
                        "the watchdog is 5120 ms"));
  const Result activate = bridge.ctl({"activate"});
  EXPECT_EQ(activate.exit_code, 0) << activate.output;
  EXPECT_EQ(bridge.stop(), 0);
  EXPECT_THAT(bridge.log(), HasSubstr("arm1: link up: the robot grants a packet interval of 20 ms"));
}

TEST(Sentence, OfPacketsThatAreNotWhatWasAgreedSaysTheirSize) {
  const SimProgram arm1(arm1_address());
  const BridgeProgram bridge({robot("arm1", arm1_address())});
  ASSERT_TRUE(bridge.until_up());
  ASSERT_EQ(arm1.say("corrupt").substr(0, 4), "ok: ");
  EXPECT_TRUE(bridge.until_told("the robot's packets have "));
  EXPECT_TRUE(bridge.until(
      [](const auto& now) { return now["bridge_status"]["transport_counters"]["malformed_packets"] > 0; }));
  ASSERT_EQ(arm1.say("faults off"), "ok: the network is healthy");
  EXPECT_TRUE(bridge.until_up());
}

TEST(Sentence, OfATakenPortIsTheLastBeforeExitCodeFour) {
  BridgeProgram first({robot("arm1", arm1_address())});
  ASSERT_TRUE(first.wait_for_log("arm1: no link yet"));
  BridgeProgram second({robot("arm2", arm2_address())});
  EXPECT_EQ(second.wait(), 4);
  EXPECT_THAT(second.log(), HasSubstr("EtherNet/IP: UDP port 2222 of " + bridge_address() +
                                      " is taken by another program on this machine; stop it, or choose another port"));
}

}  // namespace
}  // namespace meca::test
