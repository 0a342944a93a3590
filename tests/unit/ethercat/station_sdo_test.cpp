// SDOs byte by byte, as SOEM 2 and a SOES device exchanged them (capture soem2, frame numbers in the comments).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "tests/unit/ethercat/station_mailbox_script.hpp"
#include "transports/ethercat/array_reader.hpp"
#include "transports/ethercat/coe_configuration.hpp"
#include "transports/ethercat/sdo_client.hpp"

namespace meca::ethercat::station_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct SdoRig {
  MailboxScript device;
  StationCounters counters;
  MailboxClient mailbox{{100ms, 2s}, counters};
  SdoClient sdo{mailbox, counters};
  Time now = 1s;

  void answer(std::string_view hex) { device.answers.push_back({in_mailbox(hex)}); }
  Outcome run(const std::function<Loss(const Access&)>& loses = {}) {
    return station_test::run(sdo, device, now, loses);
  }
  ByteVector value() const { return {sdo.value().begin(), sdo.value().end()}; }
  // What was written, the counter aside: those of the capture began earlier.
  ByteVector mail(std::size_t n) const {
    ByteVector out = device.written.at(n);
    out[5] &= std::byte{0x0F};
    return out;
  }
  std::string trouble() const { return std::string(sdo.trouble().view()); }
};

TEST(StationSdo, UploadsFourBytesAtOnce) {
  SdoRig rig;
  rig.answer("0A 00 00 00 00 13 00 30 43 18 10 01 E1 AD EC 00");  // 272
  rig.sdo.upload({0x1018, 1}, false, rig.now);
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.device.written[0], from_hex("0A 00 00 00 00 13 00 20 40 18 10 01 00 00 00 00"));  // 259
  EXPECT_EQ(rig.value(), from_hex("E1 AD EC 00"));
}

TEST(StationSdo, UploadsANameInOneMail) {
  SdoRig rig;
  rig.answer("11 00 00 00 00 23 00 30 41 08 10 00 07 00 00 00 4D 65 63 61 35 30 30");  // 288
  rig.sdo.upload({0x1008, 0}, false, rig.now);
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.mail(0), from_hex("0A 00 00 00 00 03 00 20 40 08 10 00 00 00 00 00"));  // 275
  EXPECT_EQ(rig.value(), from_hex("4D 65 63 61 35 30 30"));
}

TEST(StationSdo, UploadsAWholeObject) {
  SdoRig rig;
  rig.answer(  // 416
      "1E 00 00 00 00 23 00 30 51 12 1C 00 14 00 00 00 09 00 00 16 01 16 02 16 10 16 11 16 20 16 21 16 22 16 23 16");
  rig.sdo.upload({0x1C12, 0}, true, rig.now);
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.mail(0), from_hex("0A 00 00 00 00 03 00 20 50 12 1C 00 00 00 00 00"));  // 401
  EXPECT_EQ(rig.value().size(), 20u);
}

// `head`: up to the data; then bytes that go on counting.
ByteVector counting_mail(std::string_view head, int first, std::size_t size) {
  ByteVector mail = from_hex(head);
  for (std::size_t i = 0; i < size; ++i) mail.push_back(static_cast<std::byte>(static_cast<std::size_t>(first) + i));
  mail.resize(kMailboxSize);
  return mail;
}

// 512 bytes 00 01 02 .. in one first part and four segments, as in frames 419 to 498.
void script_segments(SdoRig& rig) {
  rig.device.answers.push_back({counting_mail("7A 00 00 00 00 33 00 30 41 00 2F 00 00 02 00 00", 0x00, 112)});
  rig.device.answers.push_back({counting_mail("7A 00 00 00 00 43 00 30 00", 0x70, 119)});
  rig.device.answers.push_back({counting_mail("7A 00 00 00 00 53 00 30 10", 0xE7, 119)});
  rig.device.answers.push_back({counting_mail("7A 00 00 00 00 63 00 30 00", 0x5E, 119)});
  rig.device.answers.push_back({counting_mail("2E 00 00 00 00 73 00 30 11", 0xD5, 43)});
}

TEST(StationSdo, UploadsInSegments) {
  SdoRig rig;
  script_segments(rig);
  rig.sdo.upload({0x2F00, 0}, false, rig.now);
  ASSERT_EQ(rig.run(), Outcome::kDone);
  ASSERT_EQ(rig.value().size(), 512u);
  for (std::size_t i = 0; i < 512; ++i) ASSERT_EQ(rig.value()[i], static_cast<std::byte>(i & 0xFF)) << i;
  ASSERT_EQ(rig.device.written.size(), 5u);
  EXPECT_EQ(rig.device.written[1][8], std::byte{0x60});  // 433
  EXPECT_EQ(rig.device.written[2][8], std::byte{0x70});  // 449
  EXPECT_EQ(rig.device.written[3][8], std::byte{0x60});
}

TEST(StationSdo, UploadsInSegmentsWhateverReplyIsLost) {
  for (int n = 0; n < 5; ++n) {
    for (const std::uint16_t address : {0x1080, 0x1000}) {
      SdoRig rig;
      script_segments(rig);
      rig.sdo.upload({0x2F00, 0}, false, rig.now);
      int left = n;
      const auto loses = [&](const Access& a) {
        const bool now = a.address == address && left-- == 0;
        return !now ? Loss::kNothing : address == 0x1080 ? Loss::kReply : Loss::kRequest;
      };
      ASSERT_EQ(rig.run(loses), Outcome::kDone) << n;
      ASSERT_EQ(rig.value().size(), 512u);
    }
  }
}

TEST(StationSdo, ASegmentShorterThanSevenBytesSaysHowManyItHas) {
  SdoRig rig;
  rig.device.answers.push_back({counting_mail("7A 00 00 00 00 13 00 30 41 00 2F 00 73 00 00 00", 0, 112)});
  rig.answer("0A 00 00 00 00 23 00 30 09 70 71 72 00 00 00 00");
  rig.sdo.upload({0x2F00, 0}, false, rig.now);
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.value().size(), 115u);
}

TEST(StationSdo, DownloadsTwoBytesAtOnce) {
  SdoRig rig;
  rig.answer("0A 00 00 00 00 73 00 30 60 F1 10 02 00 00 00 00");  // 380
  rig.sdo.download({0x10F1, 2}, from_hex("07 00"), rig.now);
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.mail(0), from_hex("0A 00 00 00 00 03 00 20 2B F1 10 02 07 00 00 00"));  // 363
}

TEST(StationSdo, DownloadsMoreThanFourBytesInOneMail) {
  SdoRig rig;
  rig.answer("0A 00 00 00 00 13 00 30 60 00 2F 00 00 00 00 00");
  rig.sdo.download({0x2F00, 0}, from_hex("03 06 09 0C 0F"), rig.now);
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.mail(0), from_hex("0F 00 00 00 00 03 00 20 21 00 2F 00 05 00 00 00 03 06 09 0C 0F"));  // as 501
}

TEST(StationSdo, AnAbortOfAnUploadIsToldInWords) {
  SdoRig rig;
  rig.answer("0A 00 00 00 00 53 00 20 80 FF 5F 00 00 00 02 06");  // 344, in a mail of service "request"
  rig.sdo.upload({0x5FFF, 0}, false, rig.now);
  ASSERT_EQ(rig.run(), Outcome::kFailed);
  EXPECT_EQ(rig.sdo.abort(), 0x06020000u);
  EXPECT_THAT(rig.trouble(), HasSubstr("refuses to have object 0x5FFF:00 read: abort 0x06020000"));
  EXPECT_EQ(rig.counters.sdo_aborts, 1u);
}

TEST(StationSdo, AnAbortOfADownloadIsToldInWords) {
  SdoRig rig;
  rig.answer("0A 00 00 00 00 13 00 20 80 18 10 01 02 00 01 06");  // 398
  rig.sdo.download({0x1018, 1}, from_hex("00 00 00 00"), rig.now);
  ASSERT_EQ(rig.run(), Outcome::kFailed);
  EXPECT_THAT(rig.trouble(), HasSubstr("refuses to have object 0x1018:01 written: abort 0x06010002"));
}

// One public device sets other bits of the command too.
TEST(StationSdo, AnAbortIsOneWhateverItsLowBits) {
  SdoRig rig;
  rig.answer("0A 00 00 00 00 53 00 30 83 FF 5F 00 00 00 02 06");
  rig.sdo.upload({0x5FFF, 0}, false, rig.now);
  EXPECT_EQ(rig.run(), Outcome::kFailed);
  EXPECT_EQ(rig.sdo.abort(), 0x06020000u);
}

TEST(StationSdo, AnAbortOfASegmentNeedNotNameTheObject) {
  SdoRig rig;
  rig.device.answers.push_back({counting_mail("7A 00 00 00 00 33 00 30 41 00 2F 00 00 02 00 00", 0x00, 112)});
  rig.answer("0A 00 00 00 00 13 00 20 80 00 00 00 00 00 03 05");
  rig.sdo.upload({0x2F00, 0}, false, rig.now);
  EXPECT_EQ(rig.run(), Outcome::kFailed);
  EXPECT_EQ(rig.sdo.abort(), 0x05030000u);
}

TEST(StationSdo, AnswersToEarlierQuestionsArePassedOver) {
  SdoRig rig;
  rig.device.answers.push_back({in_mailbox("0A 00 00 00 00 13 00 30 43 18 10 02 00 00 00 00"),  // another subindex
                                in_mailbox("0A 00 00 00 00 23 00 30 43 19 10 01 00 00 00 00"),  // another index
                                in_mailbox("0A 00 00 00 00 33 00 30 60 18 10 01 00 00 00 00"),  // of a download
                                in_mailbox("0A 00 00 00 00 43 00 20 80 18 10 03 00 00 02 06"),  // abort of another
                                in_mailbox("0A 00 00 00 00 53 00 30 01 11 22 33 44 55 66 77"),  // a segment
                                in_mailbox("0A 00 00 00 00 63 00 30 E0 18 10 01 00 00 00 00"),  // no service at all
                                in_mailbox("0A 00 00 00 00 73 00 30 43 18 10 01 E1 AD EC 00")});
  rig.sdo.upload({0x1018, 1}, false, rig.now);
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.value(), from_hex("E1 AD EC 00"));
}

TEST(StationSdo, ASegmentThatComesTwiceIsPassedOver) {
  SdoRig rig;
  script_segments(rig);
  rig.device.answers[2].insert(rig.device.answers[2].begin(), rig.device.answers[1][0]);
  rig.sdo.upload({0x2F00, 0}, false, rig.now);
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.value()[300], std::byte{300 & 0xFF});
}

TEST(StationSdo, IsAskedOnceMoreWhenTheDeviceDoesNotRepeatALostMail) {
  SdoRig rig;
  rig.device.repeats = false;
  for (int i = 0; i < 2; ++i) rig.answer("0A 00 00 00 00 13 00 30 43 18 10 01 E1 AD EC 00");
  rig.sdo.upload({0x1018, 1}, false, rig.now);
  int left = 0;
  ASSERT_EQ(
      rig.run([&](const Access& a) { return a.address == 0x1080 && left++ == 0 ? Loss::kReply : Loss::kNothing; }),
      Outcome::kDone);
  ASSERT_EQ(rig.device.written.size(), 2u);
  EXPECT_NE(rig.device.written[0], rig.device.written[1]);  // another mail: another counter
  EXPECT_EQ(rig.mail(0), rig.mail(1));
}

TEST(StationSdo, BeginsAgainWhenASegmentIsLostThatTheDeviceDoesNotRepeat) {
  SdoRig rig;
  rig.device.repeats = false;
  script_segments(rig);
  rig.device.answers.resize(2);
  script_segments(rig);
  rig.sdo.upload({0x2F00, 0}, false, rig.now);
  int left = 1;
  ASSERT_EQ(
      rig.run([&](const Access& a) { return a.address == 0x1080 && left-- == 0 ? Loss::kReply : Loss::kNothing; }),
      Outcome::kDone);
  ASSERT_EQ(rig.value().size(), 512u);
  EXPECT_EQ(rig.value()[300], std::byte{300 & 0xFF});
  EXPECT_EQ(rig.mail(2), rig.mail(0));
}

TEST(StationSdo, GivesUpWhenTheSecondTryIsLostToo) {
  SdoRig rig;
  rig.device.repeats = false;
  for (int i = 0; i < 9; ++i) rig.answer("0A 00 00 00 00 13 00 30 43 18 10 01 E1 AD EC 00");
  rig.sdo.upload({0x1018, 1}, false, rig.now);
  ASSERT_EQ(rig.run([&](const Access& a) { return a.address == 0x1080 ? Loss::kReply : Loss::kNothing; }),
            Outcome::kFailed);
  EXPECT_EQ(rig.device.written.size(), 2u);
  EXPECT_THAT(rig.trouble(), HasSubstr("does not repeat a mail"));
}

TEST(StationSdo, AnObjectOfAbsurdSizeIsRefused) {
  SdoRig rig;
  rig.answer("0A 00 00 00 00 13 00 30 41 00 2F 00 FF FF FF FF");
  rig.sdo.upload({0x2F00, 0}, false, rig.now);
  ASSERT_EQ(rig.run(), Outcome::kFailed);
  EXPECT_THAT(rig.trouble(), HasSubstr("has 4294967295 bytes in object 0x2F00:00, at most 1024"));
}

TEST(StationSdo, AnObjectThatIsLongerOrShorterThanAnnouncedIsRefused) {
  for (const std::string_view segment : {"0A 00 00 00 00 23 00 30 00 70 71 72 73 74 75 76",     // 7, and more to come
                                         "0A 00 00 00 00 23 00 30 0D 70 00 00 00 00 00 00"}) {  // 1, the last
    SdoRig rig;
    rig.device.answers.push_back({counting_mail("7A 00 00 00 00 13 00 30 41 00 2F 00 73 00 00 00", 0, 112)});
    rig.answer(segment);
    rig.sdo.upload({0x2F00, 0}, false, rig.now);
    ASSERT_EQ(rig.run(), Outcome::kFailed);
    EXPECT_THAT(rig.trouble(), HasSubstr("in another size than the 115 bytes it announced"));
  }
}

// ---- Lists

TEST(StationArray, IsReadAsAWhole) {
  SdoRig rig;
  ArrayReader array(rig.sdo);
  rig.answer(  // 416
      "1E 00 00 00 00 23 00 30 51 12 1C 00 14 00 00 00 09 00 00 16 01 16 02 16 10 16 11 16 20 16 21 16 22 16 23 16");
  array.read(0x1C12, 2, rig.now);
  ASSERT_EQ(run(array, rig.device, rig.now), Outcome::kDone);
  EXPECT_THAT(array.entries(), ElementsAre(0x1600, 0x1601, 0x1602, 0x1610, 0x1611, 0x1620, 0x1621, 0x1622, 0x1623));
}

TEST(StationArray, IsReadEntryByEntryWhereItCannotBeReadAsAWholeAndThatIsRemembered) {
  SdoRig rig;
  ArrayReader array(rig.sdo);
  rig.answer("0A 00 00 00 00 13 00 20 80 00 16 00 04 00 01 06");
  for (int i = 0; i < 2; ++i) {
    rig.answer("0A 00 00 00 00 13 00 30 4F 00 16 00 01 00 00 00");
    rig.answer("0A 00 00 00 00 13 00 30 43 00 16 01 10 01 00 72");
    array.read(0x1600, 4, rig.now);
    ASSERT_EQ(run(array, rig.device, rig.now), Outcome::kDone);
    EXPECT_THAT(array.entries(), ElementsAre(0x72000110));
  }
  EXPECT_EQ(rig.device.written.size(), 5u);
}

TEST(StationArray, IsReadEntryByEntryWhereTheWholeIsCutShort) {
  SdoRig rig;
  ArrayReader array(rig.sdo);
  rig.answer("0E 00 00 00 00 13 00 30 51 00 16 00 04 00 00 00 02 00 10 01");
  rig.answer("0A 00 00 00 00 13 00 30 4F 00 16 00 01 00 00 00");
  rig.answer("0A 00 00 00 00 13 00 30 43 00 16 01 10 01 00 72");
  array.read(0x1600, 4, rig.now);
  ASSERT_EQ(run(array, rig.device, rig.now), Outcome::kDone);
  EXPECT_THAT(array.entries(), ElementsAre(0x72000110));
}

TEST(StationArray, WithAnEntryTooShortIsRefused) {
  SdoRig rig;
  ArrayReader array(rig.sdo);
  rig.answer("0A 00 00 00 00 13 00 20 80 00 16 00 04 00 01 06");
  rig.answer("0A 00 00 00 00 13 00 30 4F 00 16 00 01 00 00 00");
  rig.answer("0A 00 00 00 00 13 00 30 4B 00 16 01 10 01 00 00");
  array.read(0x1600, 4, rig.now);
  ASSERT_EQ(run(array, rig.device, rig.now), Outcome::kFailed);
  EXPECT_EQ(array.trouble().view(), "has object 0x1600:01 with only 2 bytes; check its firmware");
}

TEST(StationArray, OfNothingIsEmpty) {
  SdoRig rig;
  ArrayReader array(rig.sdo);
  rig.answer("0A 00 00 00 00 13 00 30 5B 00 16 00 00 00 00 00");
  array.read(0x1600, 4, rig.now);
  ASSERT_EQ(run(array, rig.device, rig.now), Outcome::kDone);
  EXPECT_TRUE(array.entries().empty());
}

// ---- 100Ah

TEST(StationFirmware, IsReadAsRobotsWriteIt) {
  using Version = transports::FirmwareVersion;
  EXPECT_EQ(parse_firmware("v9.3.3.5809"), (Version{9, 3, 3, 5809}));
  EXPECT_EQ(parse_firmware("10.2.1"), (Version{10, 2, 1, 0}));
  EXPECT_EQ(parse_firmware("11.3.3.12637"), (Version{11, 3, 3, 12637}));
  EXPECT_EQ(parse_firmware("V11.3-beta"), (Version{11, 3, 0, 0}));
}

TEST(StationFirmware, IsUnknownWhereItIsNone) {
  for (const std::string_view text : {"", "v", "11", "SOES 4.0", "70000.1.2", "11.70000", "-1.2", "firmware 9.3"}) {
    EXPECT_EQ(parse_firmware(text), transports::FirmwareVersion{}) << text;
  }
}

}  // namespace
}  // namespace meca::ethercat::station_test
