// CIP messages: paths, Message Router, Connection Manager. Hex in, names out, and back.
#include "transports/ethernet_ip/cip.hpp"

#include <gtest/gtest.h>

#include "tests/unit/ethernet_ip/golden_messages.hpp"

namespace meca::ethernet_ip {
namespace {

using test::from_hex;
using test::to_hex;

template <class Write>
std::string written(Write write) {
  std::array<std::byte, 1024> buffer;
  wire::Writer out(buffer);
  write(out);
  EXPECT_TRUE(out.ok());
  return to_hex(out.written());
}

// The CIP message within a SendRRData.
std::vector<std::byte> message_of(std::string_view golden) {
  const auto bytes = from_hex(golden);
  wire::Reader in(wire::Bytes(bytes).subspan(kHeaderSize + 6));
  const auto items = read_items(in);
  const Item* item = items ? items->find(ItemType::kUnconnectedData) : nullptr;
  if (item == nullptr) throw std::invalid_argument("golden message without a CIP message");
  return {item->data.begin(), item->data.end()};
}

Path path_of(std::string_view hex) {
  Path path;
  EXPECT_EQ(read_path(from_hex(hex), path), PathError::kNone) << hex;
  return path;
}

PathError error_of(std::string_view hex) {
  Path path;
  return read_path(from_hex(hex), path);
}

TEST(Path, ToTheConnectionManagerIn8And16BitSegmentsIsTheSame) {
  for (const auto hex : {"20062401", "2100060025000100"}) {
    const Path path = path_of(hex);
    EXPECT_EQ(path.class_id, 6u) << hex;
    EXPECT_EQ(path.instance_id, 1u) << hex;
    EXPECT_FALSE(path.attribute_id) << hex;
  }
}

TEST(Path, OfAConnectionHasKeyClassAndTwoPointsInTheirOrder) {
  const Path path = path_of("34041D062B00F4018A02 20042C962C64");
  EXPECT_EQ(path.key, (ElectronicKey{1565, 43, 500, 10, 2, true}));
  EXPECT_EQ(path.class_id, 4u);
  ASSERT_EQ(path.connection_point_count, 2u);
  EXPECT_EQ(path.connection_points[0], 150u);
  EXPECT_EQ(path.connection_points[1], 100u);
}

TEST(Path, WithConfigurationHasItsInstanceAndItsDataSegment) {
  const Path path = path_of("200424002C962C64 8001FFFF");
  EXPECT_EQ(path.instance_id, 0u);
  EXPECT_TRUE(path.data_segment);
}

TEST(Path, ThatCannotBeReadSaysWhy) {
  EXPECT_EQ(error_of(""), PathError::kNone);
  EXPECT_EQ(error_of("20"), PathError::kMalformed);
  EXPECT_EQ(error_of("210006"), PathError::kMalformed);
  EXPECT_EQ(error_of("34041D06"), PathError::kMalformed);
  EXPECT_EQ(error_of("8002FFFF"), PathError::kMalformed);
  EXPECT_EQ(error_of("34051D062B00F4018A02"), PathError::kBadKeyFormat);
  EXPECT_EQ(error_of("2200060000000000"), PathError::kUnknown) << "32 bit class";
  EXPECT_EQ(error_of("0101"), PathError::kUnknown) << "port segment";
  EXPECT_EQ(error_of("9104"), PathError::kUnknown) << "symbolic segment";
  EXPECT_EQ(error_of("2C012C022C03"), PathError::kNone);
  EXPECT_EQ(error_of("2C012C022C032C04"), PathError::kTooMany);
}

TEST(Path, IsWrittenIn8BitSegmentsAsFarAsTheyGo) {
  EXPECT_EQ(written([](wire::Writer& out) { write_path(out, 6, 1); }), "20062401");
  EXPECT_EQ(written([](wire::Writer& out) { write_path(out, 4, 0x1234, 3); }), "2004250034123003");
  EXPECT_EQ(written([](wire::Writer& out) { write_connection_points(out, 150, 100); }), "20042C962C64");
  EXPECT_EQ(written([](wire::Writer& out) { write_key(out, {1565, 43, 500, 10, 2, true}); }), "34041D062B00F4018A02");
}

TEST(Request, OfTheIdentityIsWrittenAndReadAsItStandsOnTheWire) {
  const auto message = message_of(test::golden::kIdentityRequest);
  EXPECT_EQ(written([](wire::Writer& out) { write_request(out, Service::kGetAttributesAll, kIdentityClass, 1); }),
            to_hex(message));
  const auto request = read_request(message);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->service, 0x01);
  EXPECT_EQ(to_hex(request->path), "20012401");
  EXPECT_TRUE(request->data.empty());
}

TEST(Request, WithTheReplyBitIsNone) { EXPECT_FALSE(read_request(from_hex("810220012401"))); }

TEST(Reply, WithoutTheReplyBitIsNone) { EXPECT_FALSE(read_reply(from_hex("54000000"))); }

TEST(Reply, OfARefusalHasBothStatusesAndTheTriad) {
  const auto message = message_of(test::golden::kKeyRefused);
  const auto reply = read_reply(message);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->service, 0x54);
  EXPECT_EQ(reply->general, 0x01);
  ASSERT_EQ(reply->extended_count, 1u);
  EXPECT_EQ(reply->extended[0], 0x0116);
  const auto failure = read_connection_failure(reply->data);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->triad, (ConnectionTriad{0xCB03, 0x0BAD, 0x51515151}));
  EXPECT_EQ(failure->remaining_path_words, 0);
  EXPECT_EQ(written([&](wire::Writer& out) {
              const std::uint16_t words[] = {0x0116};
              write_reply(out, 0x54, GeneralStatus::kConnectionFailure, words);
              write(out, *failure);
            }),
            to_hex(message));
}

TEST(Reply, KeepsTheFirstSixExtendedWordsAndFindsTheDataBehindAll) {
  const auto bytes = from_hex("D4000107 0100 0200 0300 0400 0500 0600 0700 AA");
  const auto reply = read_reply(bytes);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->extended_count, 6u);
  EXPECT_EQ(reply->extended[5], 6);
  EXPECT_EQ(to_hex(reply->data), "AA");
}

ForwardOpen open_of(std::string_view golden, std::vector<std::byte>& message) {
  message = message_of(golden);
  const auto request = read_request(message);
  EXPECT_TRUE(request);
  ForwardOpen open;
  EXPECT_EQ(read_forward_open(request->data, request->service == 0x5B, open), GeneralStatus::kSuccess);
  return open;
}

TEST(ForwardOpen, OfEipScannerIsReadAsRecorded) {
  std::vector<std::byte> message;
  const ForwardOpen open = open_of(test::golden::kOpenRequest, message);
  EXPECT_EQ(open.priority_tick, 0x0A);
  EXPECT_EQ(open.timeout_ticks, 0xF5);
  EXPECT_EQ(open.o_to_t_id, 0u);
  EXPECT_EQ(open.t_to_o_id, 0xDC2D0001u);
  EXPECT_EQ(open.triad, (ConnectionTriad{1, 0x1234, 0x6B02695B}));
  EXPECT_EQ(open.multiplier_code, 0);
  EXPECT_EQ(open.o_to_t_rpi_us, 10'000u);
  EXPECT_EQ(open.t_to_o_rpi_us, 10'000u);
  EXPECT_EQ(open.o_to_t, (NetworkParameters{.size = 66}));
  EXPECT_EQ(open.t_to_o, (NetworkParameters{.size = 254}));
  EXPECT_EQ(open.transport, kClass1Cyclic);
  EXPECT_EQ(to_hex(open.path), "20042C962C64");
}

TEST(ForwardOpen, OfTheVendorsProjectAsksForMulticastAndAKey) {
  std::vector<std::byte> message;
  const ForwardOpen open = open_of(test::golden::kKeyedOpenRequest, message);
  EXPECT_EQ(open.t_to_o, (NetworkParameters{.type = ConnectionType::kMulticast, .size = 254}));
  EXPECT_EQ(open.t_to_o_rpi_us, 50'000u);
  Path path;
  ASSERT_EQ(read_path(open.path, path), PathError::kNone);
  EXPECT_EQ(path.key, (ElectronicKey{1565, 43, 500, 10, 2, true}));
}

TEST(ForwardOpen, IsWrittenAsItWasRecorded) {
  for (const auto golden :
       {test::golden::kOpenRequest, test::golden::kMulticastOpenRequest, test::golden::kHeaderOpenRequest,
        test::golden::kKeyedOpenRequest, test::golden::kKeyed113OpenRequest, test::golden::kLargeOpenRequest}) {
    std::vector<std::byte> message;
    const ForwardOpen open = open_of(golden, message);
    const auto request = read_request(message);
    EXPECT_EQ(written([&](wire::Writer& out) {
                write_forward_open(out, open);
                out.u8(static_cast<std::uint8_t>(open.path.size() / 2));
                out.bytes(open.path);
              }),
              to_hex(request->data));
  }
}

TEST(ForwardOpen, LargeSaysTheSameInLongWords) {
  std::vector<std::byte> message;
  const ForwardOpen open = open_of(test::golden::kLargeOpenRequest, message);
  EXPECT_TRUE(open.large);
  EXPECT_EQ(open.o_to_t, (NetworkParameters{.size = 66}));
  EXPECT_EQ(open.t_to_o, (NetworkParameters{.size = 254}));
}

TEST(ForwardOpen, WhosePathIsShorterOrLongerThanItSaysIsRefused) {
  const auto message = message_of(test::golden::kOpenRequest);
  const auto request = read_request(message);
  std::vector<std::byte> data(request->data.begin(), request->data.end());
  ForwardOpen open;
  data.push_back(std::byte{});
  EXPECT_EQ(read_forward_open(data, false, open), GeneralStatus::kTooMuchData);
  data.resize(data.size() - 2);
  EXPECT_EQ(read_forward_open(data, false, open), GeneralStatus::kNotEnoughData);
}

TEST(NetworkParameters, AreTheWordsOfTheVendorsFiles) {
  EXPECT_EQ(to_word({.size = 66}), 0x4842);
  EXPECT_EQ(to_word({.size = 254}), 0x48FE);
  EXPECT_EQ(to_word({.type = ConnectionType::kMulticast, .size = 254}), 0x28FE);
  EXPECT_EQ(to_long_word({.size = 66}), 0x48000042u);
  EXPECT_EQ(to_long_word({.type = ConnectionType::kMulticast, .size = 254}), 0x280000FEu);
}

TEST(NetworkParameters, EveryWordReadsAndWritesTheSame) {
  for (unsigned word = 0; word <= 0xFFFF; ++word) {
    const unsigned unused = 0x1000;  // bit 12 says nothing
    ASSERT_EQ(to_word(from_word(static_cast<std::uint16_t>(word))), word & ~unused) << word;
  }
}

TEST(ForwardOpenReply, GivesIdsTriadAndIntervals) {
  const auto message = message_of(test::golden::kOpenReply);
  const auto reply = read_reply(message);
  ASSERT_TRUE(reply);
  const auto opened = read_forward_open_reply(reply->data);
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->o_to_t_id, 0x3FE60013u);
  EXPECT_EQ(opened->t_to_o_id, 0xDC2D0001u);
  EXPECT_EQ(opened->triad, (ConnectionTriad{1, 0x1234, 0x6B02695B}));
  EXPECT_EQ(opened->o_to_t_api_us, 10'000u);
  EXPECT_EQ(opened->t_to_o_api_us, 10'000u);
  EXPECT_EQ(written([&](wire::Writer& out) { write(out, *opened); }), to_hex(reply->data));
}

TEST(ForwardClose, HasAPadByteBehindThePathSize) {
  for (const auto golden : {test::golden::kCloseRequest, test::golden::kMulticastCloseRequest}) {
    const auto message = message_of(golden);
    const auto request = read_request(message);
    ASSERT_TRUE(request);
    ForwardClose close;
    ASSERT_EQ(read_forward_close(request->data, close), GeneralStatus::kSuccess);
    EXPECT_EQ(written([&](wire::Writer& out) { write_forward_close(out, close, close.path); }), to_hex(request->data));
  }
}

TEST(ForwardCloseReply, RepeatsTheTriad) {
  const auto message = message_of(test::golden::kCloseReply);
  const auto reply = read_reply(message);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->service, 0x4E);
  const auto triad = read_forward_close_reply(reply->data);
  ASSERT_TRUE(triad);
  EXPECT_EQ(*triad, (ConnectionTriad{1, 0x1234, 0x6B02695B}));
  EXPECT_EQ(written([&](wire::Writer& out) { write_forward_close_reply(out, *triad); }), to_hex(reply->data));
}

TEST(IdentityReply, IsTheOneOfTheRobot) {
  const auto message = message_of(test::golden::kIdentityReply);
  const auto reply = read_reply(message);
  ASSERT_TRUE(reply);
  wire::Reader in(reply->data);
  const auto identity = read_identity(in);
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->product_code, 500);
  EXPECT_EQ(identity->major, 11);
  EXPECT_EQ(identity->name(), "Meca500");
  EXPECT_EQ(identity->state, 0xFF) << "not given";
  EXPECT_EQ(written([&](wire::Writer& out) { write(out, *identity); }), to_hex(reply->data));
}

TEST(Multiplier, GoesFrom4To512) {
  EXPECT_EQ(timeout_multiplier(0), 4u);
  EXPECT_EQ(timeout_multiplier(2), 16u);
  EXPECT_EQ(timeout_multiplier(kMaxMultiplierCode), 512u);
}

// ---- Truncation: every beginning of every message, in memory of exactly its size, so that ASan sees a byte too far.

void read_everything(const std::vector<std::byte>& bytes) {
  read_header(bytes);
  wire::Reader items(bytes);
  read_items(items);
  read_socket_address(bytes);
  wire::Reader identity(bytes);
  read_identity(identity);
  read_listed_identity(bytes);
  Path path;
  read_path(bytes, path);
  read_request(bytes);
  read_reply(bytes);
  ForwardOpen open;
  read_forward_open(bytes, false, open);
  read_forward_open(bytes, true, open);
  read_forward_open_reply(bytes);
  read_connection_failure(bytes);
  ForwardClose close;
  read_forward_close(bytes, close);
  read_forward_close_reply(bytes);
}

TEST(Truncation, OfAnyMessageIsQuietForEveryReader) {
  for (const auto golden : test::golden::kMessages) {
    const auto whole = from_hex(golden);
    for (std::size_t from : {std::size_t{0}, kHeaderSize, kHeaderSize + 6, kHeaderSize + 16}) {
      for (std::size_t to = from; to <= whole.size(); ++to) {
        const auto at = [&](std::size_t i) { return whole.begin() + static_cast<std::ptrdiff_t>(i); };
        read_everything({at(from), at(to)});
      }
    }
  }
}

TEST(Truncation, OfACipMessageIsNeverTakenForAWholeOne) {
  const auto open = message_of(test::golden::kOpenRequest);
  const auto data = read_request(open)->data;
  for (std::size_t size = 0; size < data.size(); ++size) {
    ForwardOpen out;
    const std::vector<std::byte> part(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(read_forward_open(part, false, out), GeneralStatus::kNotEnoughData) << size;
  }
  const auto close = message_of(test::golden::kCloseRequest);
  const auto close_data = read_request(close)->data;
  for (std::size_t size = 0; size < close_data.size(); ++size) {
    ForwardClose out;
    EXPECT_EQ(read_forward_close(close_data.first(size), out), GeneralStatus::kNotEnoughData) << size;
  }
  const auto opened = message_of(test::golden::kOpenReply);
  const auto reply_data = read_reply(opened)->data;
  for (std::size_t size = 0; size < 24; ++size) EXPECT_FALSE(read_forward_open_reply(reply_data.first(size))) << size;
  for (std::size_t size = 0; size < 8; ++size) EXPECT_FALSE(read_forward_close_reply(reply_data.first(size))) << size;
}

}  // namespace
}  // namespace meca::ethernet_ip
