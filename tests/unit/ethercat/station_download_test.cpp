// Values written to a device: in how many mails, against the CoE server of our own device and byte by byte as SOEM 2
// and a SOES device exchanged them (capture soem2, frame numbers in the comments).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/ethercat/station_mailbox_script.hpp"
#include "transports/ethercat/coe_server.hpp"
#include "transports/ethercat/object_dictionary.hpp"
#include "transports/ethercat/sdo_client.hpp"

namespace meca::ethercat::station_test {
namespace {

using testing::HasSubstr;

constexpr SdoAddress kObject{0x2F00, 0};
constexpr std::size_t kMostFirst = SdoClient::kMostFirstPart, kMostSegment = SdoClient::kMostSegment;

// 00 03 06 .., as the value of the capture.
ByteVector value_of(std::size_t size) {
  ByteVector out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(3 * i & 0xFF);
  return out;
}

ObjectDictionary with_one_object(std::size_t size) {
  ObjectDictionary out;
  Object object;
  object.index = kObject.index;
  object.type = static_cast<std::uint16_t>(DataType::kVisibleString);
  object.name = "Text";
  object.entries.push_back(out.stored({.type = DataType::kVisibleString,
                                       .bits = static_cast<std::uint16_t>(8 * size),
                                       .access = access::kRead | access::kWrite,
                                       .name = "Text"},
                                      ByteVector(size)));
  out.add(std::move(object));
  out.finish();
  return out;
}

// Our client, and our server behind a mailbox that drops a mail that it has had already.
struct DownloadRig {
  explicit DownloadRig(std::size_t size) : objects(with_one_object(size)) {
    device.serve = [this](Bytes mail) { return serve(mail); };
  }

  ObjectDictionary objects;
  CoeServer server;
  MailboxScript device;
  StationCounters counters;
  MailboxClient mailbox{{100ms, 2s}, counters};
  SdoClient sdo{mailbox, counters};
  Time now = 1s;

  Outcome write(const ByteVector& value, const std::function<Loss(const Access&)>& loses = {}) {
    sdo.download(kObject, value, now);
    return station_test::run(sdo, device, now, loses);
  }
  ByteVector stored() const {
    ByteVector out(1024);
    std::size_t size = 0;
    EXPECT_FALSE(objects.upload(kObject, false, AlState::kPreop, out, size));
    out.resize(size);
    return out;
  }
  // Command, and what comes after it up to the data, of the n-th mail.
  std::byte command(std::size_t n) const { return device.written.at(n)[kMailboxHeader + kCoeHeader]; }
  std::size_t length(std::size_t n) const { return device.written.at(n).size(); }
  std::string trouble() const { return std::string(sdo.trouble().view()); }

 private:
  std::optional<ByteVector> serve(Bytes memory) {
    const auto mail = parse_mail(memory);
    if (mail->header.counter == last_counter_) return std::nullopt;
    last_counter_ = mail->header.counter;
    std::array<std::byte, CoeServer::kMostPayload> payload;
    wire::Writer answer(payload);
    EXPECT_FALSE(server.request(objects, mail->payload, AlState::kPreop, answer));
    if (answer.size() == 0) return std::nullopt;
    ByteVector out(kMailboxSize);
    wire::Writer to(out);
    ethercat::write(to, MailboxHeader{.length = static_cast<std::uint16_t>(answer.size()), .type = 3, .counter = 1});
    to.bytes(answer.written());
    return out;
  }
  std::uint8_t last_counter_ = 0;
};

struct Size {
  std::size_t bytes, mails;
};
void PrintTo(const Size& size, std::ostream* out) { *out << size.bytes << " bytes"; }

class OfSize : public testing::TestWithParam<Size> {};

TEST_P(OfSize, AValueArrivesWholeInAsFewMailsAsItTakes) {
  DownloadRig rig(GetParam().bytes);
  ASSERT_EQ(rig.write(value_of(GetParam().bytes)), Outcome::kDone) << rig.trouble();
  EXPECT_EQ(rig.stored(), value_of(GetParam().bytes));
  EXPECT_EQ(rig.device.written.size(), GetParam().mails);
  EXPECT_EQ(rig.server.aborts(), 0u);
}

// Whatever is lost, and wherever: a mail on its way there, the word that it is there, the answer.
TEST_P(OfSize, AValueArrivesWholeWhateverIsLost) {
  for (const auto& [address, how] :
       {std::pair{0x1000, Loss::kRequest}, {0x1000, Loss::kReply}, {0x1080, Loss::kReply}}) {
    for (std::size_t n = 0; n < GetParam().mails; ++n) {
      DownloadRig rig(GetParam().bytes);
      std::size_t left = n;
      const auto loses = [&](const Access& a) { return a.address == address && left-- == 0 ? how : Loss::kNothing; };
      ASSERT_EQ(rig.write(value_of(GetParam().bytes), loses), Outcome::kDone) << n << ": " << rig.trouble();
      EXPECT_EQ(rig.stored(), value_of(GetParam().bytes));
      EXPECT_EQ(rig.server.aborts(), 0u);
      EXPECT_GT(rig.counters.lost_accesses, 0u);
    }
  }
}

// Where the device does not give the lost answer again, nobody knows whether it has the segment: all of it once more.
TEST_P(OfSize, AValueIsWrittenOnceMoreWhereALostAnswerIsNotRepeated) {
  for (std::size_t n = 0; n < GetParam().mails; ++n) {
    DownloadRig rig(GetParam().bytes);
    rig.device.repeats = false;
    std::size_t left = n;
    const auto loses = [&](const Access& a) {
      return a.address == 0x1080 && left-- == 0 ? Loss::kReply : Loss::kNothing;
    };
    ASSERT_EQ(rig.write(value_of(GetParam().bytes), loses), Outcome::kDone) << n << ": " << rig.trouble();
    EXPECT_EQ(rig.stored(), value_of(GetParam().bytes));
    EXPECT_EQ(rig.device.written.size(), n + 1 + GetParam().mails);
    EXPECT_EQ(rig.server.aborts(), 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Sdo, OfSize,
                         testing::Values(Size{1, 1}, Size{4, 1}, Size{5, 1}, Size{111, 1}, Size{kMostFirst, 1},
                                         Size{kMostFirst + 1, 2}, Size{118, 2}, Size{119, 2}, Size{kMailboxSize, 2},
                                         Size{kMailboxSize + 1, 2}, Size{kMostFirst + kMostSegment, 2},
                                         Size{kMostFirst + kMostSegment + 1, 3}, Size{kMostFirst + 2 * kMostSegment, 3},
                                         Size{512, 5}));

TEST(StationDownload, OfUpToFourBytesIsExpedited) {
  for (const auto& [size, command] : {std::pair{1, 0x2F}, {2, 0x2B}, {3, 0x27}, {4, 0x23}}) {
    DownloadRig rig(static_cast<std::size_t>(size));
    ASSERT_EQ(rig.write(value_of(static_cast<std::size_t>(size))), Outcome::kDone);
    EXPECT_EQ(rig.command(0), static_cast<std::byte>(command));
    EXPECT_EQ(rig.length(0), 16u);
  }
}

TEST(StationDownload, OfMoreIsWhatSoemWrote) {
  DownloadRig rig(512);
  ASSERT_EQ(rig.write(value_of(512)), Outcome::kDone);
  ASSERT_EQ(rig.device.written.size(), 5u);
  EXPECT_EQ(rig.device.written[0], from_hex(golden::kLongDownload));         // 501
  EXPECT_EQ(rig.device.written[1], from_hex(golden::kLongDownloadSegment));  // 517
  EXPECT_EQ(rig.command(2), std::byte{0x10});                                // 531
  EXPECT_EQ(rig.command(3), std::byte{0x00});                                // 547
  EXPECT_EQ(rig.device.written[4], from_hex(golden::kLongDownloadLast));     // 563
}

TEST(StationDownload, IsDoneWithTheAnswersThatSoesGave) {
  DownloadRig rig(512);
  rig.device.serve = {};
  rig.device.answers = {{in_mailbox("0A 00 00 00 00 13 00 30 60 00 2F 00 00 00 00 00")},  // 516
                        {in_mailbox(golden::kLongDownloadSegmentResponse)},               // 530: old bytes behind it
                        {in_mailbox(golden::kLongDownloadSegmentResponse1)},              // 546
                        {in_mailbox(golden::kLongDownloadSegmentResponse)},
                        {in_mailbox(golden::kLongDownloadSegmentResponse1)}};
  EXPECT_EQ(rig.write(value_of(512)), Outcome::kDone) << rig.trouble();
}

TEST(StationDownload, FillsALastSegmentOfLessThanSevenBytesUpAndSaysSo) {
  DownloadRig rig(kMostFirst + 2);
  ASSERT_EQ(rig.write(value_of(kMostFirst + 2)), Outcome::kDone);
  EXPECT_EQ(rig.command(1), std::byte{0x0B});  // 5 of 7 bytes are not used, last
  EXPECT_EQ(rig.length(1), kMailboxHeader + kCoeHeader + 8);
}

TEST(StationDownload, ThatTheDeviceRefusesIsToldInWords) {
  DownloadRig rig(kMostFirst + 2);
  ASSERT_EQ(rig.write(value_of(kMostFirst + 1)), Outcome::kFailed);  // with the last segment: too short
  EXPECT_EQ(rig.sdo.abort(), 0x06070013u);
  EXPECT_THAT(rig.trouble(), HasSubstr("refuses to have object 0x2F00:00 written: abort 0x06070013"));
  ASSERT_EQ(rig.write(value_of(513)), Outcome::kFailed);  // with the first mail: more than it has room for
  EXPECT_EQ(rig.sdo.abort(), 0x06070012u);
  EXPECT_EQ(rig.stored(), ByteVector(kMostFirst + 2));
}

TEST(StationDownload, AbortedInASegmentWithoutTheNameOfTheObjectIsAborted) {
  DownloadRig rig(512);
  rig.device.serve = {};
  rig.device.answers = {{in_mailbox("0A 00 00 00 00 13 00 30 60 00 2F 00 00 00 00 00")},
                        {in_mailbox("0A 00 00 00 00 13 00 20 80 00 00 00 00 00 03 05")}};
  ASSERT_EQ(rig.write(value_of(512)), Outcome::kFailed);
  EXPECT_EQ(rig.sdo.abort(), 0x05030000u);
}

TEST(StationDownload, IsAbortedByUsWhereTheAnswerHasTheWrongToggleBit) {
  DownloadRig rig(512);
  rig.device.serve = {};
  rig.device.answers = {{in_mailbox("0A 00 00 00 00 13 00 30 60 00 2F 00 00 00 00 00")},
                        {in_mailbox(golden::kLongDownloadSegmentResponse1)}};
  ASSERT_EQ(rig.write(value_of(512)), Outcome::kFailed);
  EXPECT_THAT(rig.trouble(), HasSubstr("answers a segment of object 0x2F00:00 that was not sent (toggle bit)"));
  EXPECT_FALSE(rig.sdo.abort());  // the device did not say no
  ASSERT_EQ(rig.device.written.size(), 3u);
  EXPECT_EQ(rig.device.written[2], from_hex("0A 00 00 00 00 33 00 20 80 00 2F 00 00 00 03 05"));
}

// The device that does not take our abort is told no more about it.
TEST(StationDownload, FailsForItsOwnReasonWhereTheAbortDoesNotArrive) {
  DownloadRig rig(512);
  rig.device.serve = {};
  rig.device.answers = {{in_mailbox("0A 00 00 00 00 13 00 30 60 00 2F 00 00 00 00 00")},
                        {in_mailbox(golden::kLongDownloadSegmentResponse1)}};
  const auto loses = [&](const Access& a) {
    return a.address == 0x1000 && rig.device.written.size() == 2 ? Loss::kRequest : Loss::kNothing;
  };
  ASSERT_EQ(rig.write(value_of(512), loses), Outcome::kFailed);
  EXPECT_THAT(rig.trouble(), HasSubstr("(toggle bit)"));
  EXPECT_EQ(rig.device.written.size(), 2u);
}

TEST(StationDownload, GoesOnAfterATransferThatWasAborted) {
  DownloadRig rig(200);
  rig.device.answers = {{in_mailbox("0A 00 00 00 00 13 00 30 60 00 2F 00 00 00 00 00")},
                        {in_mailbox(golden::kLongDownloadSegmentResponse1)}};
  ASSERT_EQ(rig.write(value_of(200)), Outcome::kFailed);
  EXPECT_EQ(rig.write(value_of(200)), Outcome::kDone) << rig.trouble();
  EXPECT_EQ(rig.stored(), value_of(200));
}

TEST(StationDownload, OfMoreThanThereIsRoomForFailsBeforeAnythingIsSent) {
  DownloadRig rig(8);
  ASSERT_EQ(rig.write(value_of(SdoClient::kMostValue + 1)), Outcome::kFailed);
  EXPECT_EQ(rig.trouble(), "is to have 1025 bytes written to object 0x2F00:00, at most 1024 can be");
  EXPECT_TRUE(rig.device.written.empty());
  EXPECT_EQ(rig.write(value_of(8)), Outcome::kDone);
}

// ---- Uploads that cannot go on

TEST(StationUpload, OfAnObjectThatIsTooLongOrOfAnotherSizeIsAborted) {
  struct Case {
    std::vector<std::string_view> answers;
    std::string_view abort;
  };
  const Case cases[] = {
      {{"0A 00 00 00 00 13 00 30 41 00 2F 00 FF FF FF FF"}, "0A 00 00 00 00 23 00 20 80 00 2F 00 05 00 04 05"},
      {{"0A 00 00 00 00 13 00 30 41 00 2F 00 09 00 00 00", "0A 00 00 00 00 23 00 30 0D 70 00 00 00 00 00 00"},
       "0A 00 00 00 00 33 00 20 80 00 2F 00 10 00 07 06"}};
  for (const Case& one : cases) {
    DownloadRig rig(8);
    rig.device.serve = {};
    for (const auto answer : one.answers) rig.device.answers.push_back({in_mailbox(answer)});
    rig.sdo.upload(kObject, false, rig.now);
    ASSERT_EQ(run(rig.sdo, rig.device, rig.now), Outcome::kFailed);
    EXPECT_EQ(rig.device.written.back(), from_hex(one.abort));
  }
}

}  // namespace
}  // namespace meca::ethercat::station_test
