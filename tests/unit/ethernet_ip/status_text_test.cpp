// What a person reads when the robot refuses.
#include "transports/ethernet_ip/status_text.hpp"

#include <gtest/gtest.h>

#include "tests/unit/ethernet_ip/golden_messages.hpp"

namespace meca::ethernet_ip {
namespace {

Reply refusal(std::uint8_t general, std::initializer_list<std::uint16_t> extended) {
  Reply reply;
  reply.service = 0x54;
  reply.general = general;
  for (const auto word : extended) reply.extended[reply.extended_count++] = word;
  return reply;
}

class Asked {
 public:
  explicit Asked(std::string_view path = "34041D062B00F4018B0320042C962C64") : path_(test::from_hex(path)) {
    open.o_to_t_rpi_us = open.t_to_o_rpi_us = 5'000;
    open.o_to_t.size = 64;
    open.t_to_o.size = 254;
    open.path = path_;
  }
  ForwardOpen open;

 private:
  std::vector<std::byte> path_;
};

std::string text(const Reply& reply, const ForwardOpen& asked, const std::optional<Identity>& robot = std::nullopt) {
  return std::string(refusal_text("Forward Open", reply, &asked, robot).view());
}

TEST(RefusalText, OfAWrongSizeNamesWhatWasAskedAndWhatTheRobotExpects) {
  EXPECT_EQ(text(refusal(1, {0x0127, 66}), Asked().open),
            "Forward Open refused (0x01/0x0127 0x0042): O->T size 64 asked, the robot expects 66; outputs of another "
            "size; check that it is a Meca500, and its firmware");
  EXPECT_EQ(text(refusal(1, {0x0128}), Asked().open),
            "Forward Open refused (0x01/0x0128): T->O size 254 asked; inputs of another size; check that it is a "
            "Meca500, and its firmware");
}

TEST(RefusalText, OfAnIntervalNamesBothAndTheRobotsRange) {
  EXPECT_EQ(text(refusal(1, {0x0111}), Asked().open),
            "Forward Open refused (0x01/0x0111): RPI 5 ms O->T, 5 ms T->O asked; not supported; the Meca500 takes 10 "
            "ms to 10 s");
}

TEST(RefusalText, OfAnIntervalThatTheRobotCorrectsNamesItsValues) {
  const std::string said = text(refusal(1, {0x0112, 0x0101, 10'000, 0, 50'000, 0}), Asked().open);
  EXPECT_NE(said.find("RPI 5/5 ms asked, the robot takes 10/50"), said.npos) << said;
}

TEST(RefusalText, OfAKeyNamesBothRevisions) {
  Identity robot;
  robot.major = 10;
  robot.minor = 2;
  EXPECT_EQ(text(refusal(1, {0x0116}), Asked().open, robot),
            "Forward Open refused (0x01/0x0116): key compatible with 11.3 asked, the robot is 10.2; the revision does "
            "not fit; correct the key's revision, or set the key to none");
}

TEST(RefusalText, OfOutputsThatBelongToAnotherSaysWhoHasToGo) {
  EXPECT_EQ(text(refusal(1, {0x0106}), Asked().open),
            "Forward Open refused (0x01/0x0106): another controller owns the robot's outputs; stop it; if it has "
            "vanished, let it return and close, or restart EtherNet/IP on the robot");
}

TEST(RefusalText, OfPointsNamesThem) {
  const std::string said = text(refusal(1, {0x012F}), Asked().open);
  EXPECT_NE(said.find("points O->T 150, T->O 100 asked"), said.npos) << said;
}

TEST(RefusalText, OfAGeneralStatusLooksNotAtItsExtendedWords) {
  const std::string said = text(refusal(0x04, {0x0106}), Asked().open);
  EXPECT_EQ(said.find("another controller"), said.npos) << said;
  EXPECT_NE(said.find("(0x04/0x0106)"), said.npos) << said;
}

TEST(RefusalText, OfAStatusThatNoDocumentNamesShowsTheNumbers) {
  EXPECT_EQ(text(refusal(1, {0x0999}), Asked().open),
            "Forward Open refused (0x01/0x0999): a status that no document names; look into the robot's log");
  EXPECT_EQ(text(refusal(0x2A, {}), Asked().open),
            "Forward Open refused (0x2A): a status that no document names; look into the robot's log");
}

TEST(RefusalText, OfARequestWithoutParametersNamesTheRequest) {
  EXPECT_EQ(refusal_text("GetAttributesAll", refusal(0x08, {})).view(),
            "GetAttributesAll refused (0x08): the robot does not offer this service; check that the device is a "
            "Meca500");
}

TEST(RefusalText, IsNeverCutHoweverLongTheNumbers) {
  Identity robot;
  robot.major = robot.minor = 255;
  Asked asked("34041D062B00F401FFFF2104002D00FFFF2D00FFFF");
  asked.open.o_to_t_rpi_us = asked.open.t_to_o_rpi_us = 3'999'999'999;
  asked.open.o_to_t.size = asked.open.t_to_o.size = 65'535;
  asked.open.multiplier_code = 255;
  asked.open.o_to_t.variable_size = asked.open.t_to_o.variable_size = true;
  const auto whole = [&](const Reply& reply) {
    const auto said = refusal_text("Forward Open", reply, &asked.open, robot);
    EXPECT_LT(said.view().size(), 191u) << said.view();
  };
  for (const auto& status : general_status_texts()) whole(refusal(static_cast<std::uint8_t>(status.code), {}));
  for (const auto& status : extended_status_texts()) {
    whole(refusal(1, {status.code, 65'535}));
    if (status.concern == Concern::kRpi) whole(refusal(1, {status.code, 0x0101, 65'535, 60'000, 65'535, 60'000}));
  }
}

TEST(StatusTexts, EveryCodeIsFoundAndSaysWhatItMeans) {
  for (const auto& status : general_status_texts()) {
    EXPECT_EQ(find_general_status(static_cast<std::uint8_t>(status.code)), &status);
    EXPECT_FALSE(status.meaning.empty()) << status.code;
  }
  for (const auto& status : extended_status_texts()) {
    EXPECT_EQ(find_extended_status(status.code), &status);
    EXPECT_FALSE(status.meaning.empty()) << status.code;
    EXPECT_FALSE(status.remedy.empty()) << status.code;
  }
  EXPECT_EQ(find_extended_status(0x0999), nullptr);
}

TEST(Dotted, IsHowPeopleWriteAddresses) {
  EXPECT_EQ(dotted(0xC0A80064).view(), "192.168.0.100");
  EXPECT_EQ(dotted(0xFFFFFFFF).view(), "255.255.255.255");
}

}  // namespace
}  // namespace meca::ethernet_ip
