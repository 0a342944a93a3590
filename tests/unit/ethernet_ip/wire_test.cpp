// Encapsulation and I/O packets: hex in, names out, and back.
#include <gtest/gtest.h>

#include "tests/unit/ethernet_ip/golden_messages.hpp"
#include "transports/ethernet_ip/io_packet.hpp"

namespace meca::ethernet_ip {
namespace {

using test::from_hex;
using test::to_hex;

constexpr std::uint32_t kTarget = 0xAC1C0103, kGroup = 0xEFC00140;  // 172.28.1.3, 239.192.1.64

template <class Write>
std::string written(Write write) {
  std::array<std::byte, 1024> buffer;
  wire::Writer out(buffer);
  write(out);
  EXPECT_TRUE(out.ok());
  return to_hex(out.written());
}

TEST(Header, IsReadAsRecorded) {
  const auto header = read_header(from_hex(test::golden::kKeyRefused));
  ASSERT_TRUE(header);
  EXPECT_EQ(header->command, 0x006F);
  EXPECT_EQ(header->length, 0x20);
  EXPECT_EQ(header->session, 1u);
  EXPECT_EQ(header->status, 0u);
  EXPECT_EQ(to_hex(header->context), "70726F6265000000") << "'probe'";
  EXPECT_EQ(header->options, 0u);
}

TEST(Header, IsWrittenAsItWasRead) {
  for (const auto message : test::golden::kMessages) {
    const auto header = read_header(from_hex(message));
    ASSERT_TRUE(header) << message;
    EXPECT_EQ(written([&](wire::Writer& out) { write(out, *header); }), message.substr(0, 2 * kHeaderSize));
    EXPECT_EQ(header->length, message.size() / 2 - kHeaderSize) << message;
  }
}

TEST(Header, NeedsAllOfIts24Bytes) {
  const auto bytes = from_hex(test::golden::kRegisterReply);
  EXPECT_TRUE(read_header(wire::Bytes(bytes).first(24)));
  EXPECT_FALSE(read_header(wire::Bytes(bytes).first(23)));
}

TEST(Items, OfAMulticastReplyAreFour) {
  const auto bytes = from_hex(test::golden::kMulticastOpenReply);
  wire::Reader in(wire::Bytes(bytes).subspan(kHeaderSize + 6));
  const auto items = read_items(in);
  ASSERT_TRUE(items);
  ASSERT_EQ(items->count, 4u);
  ASSERT_NE(items->find(ItemType::kSocketAddressOToT), nullptr);
  ASSERT_NE(items->find(ItemType::kSocketAddressTToO), nullptr);
  EXPECT_EQ(items->find(ItemType::kConnectedData), nullptr);
  EXPECT_EQ(read_socket_address(items->find(ItemType::kSocketAddressOToT)->data), (SocketAddress{0, 2222}));
  EXPECT_EQ(read_socket_address(items->find(ItemType::kSocketAddressTToO)->data), (SocketAddress{kGroup, 2222}));
}

TEST(Items, MoreThanAMessageCanHaveAreRefused) {
  auto bytes = from_hex("0900");
  bytes.resize(2 + 9 * 4);
  wire::Reader nine(bytes);
  EXPECT_FALSE(read_items(nine));
  bytes[0] = std::byte{8};
  wire::Reader eight(bytes);
  EXPECT_TRUE(read_items(eight));
}

TEST(Items, AreWrittenWithTypeAndLength) {
  EXPECT_EQ(written([](wire::Writer& out) { write_item(out, ItemType::kUnconnectedData, 0x34); }), "B2003400");
}

TEST(SocketAddress, IsBigEndianAndOfFamilyInternet) {
  EXPECT_EQ(written([](wire::Writer& out) {
              write(out, SocketAddress{kGroup, 2222});
            }),
            "000208AEEFC001400000000000000000");
  EXPECT_EQ(read_socket_address(from_hex("0002AF12AC1C01030000000000000000")), (SocketAddress{kTarget, 44818}));
  EXPECT_FALSE(read_socket_address(from_hex("0A00AF12AC1C01030000000000000000"))) << "another family";
  EXPECT_FALSE(read_socket_address(from_hex("0002AF12AC1C0103"))) << "8 bytes";
}

TEST(ListIdentity, NamesTheDeviceAndWhereItIs) {
  const auto listed = read_listed_identity(from_hex(test::golden::kListedIdentity));
  ASSERT_TRUE(listed);
  EXPECT_EQ(listed->address, (SocketAddress{kTarget, 44818}));
  EXPECT_EQ(listed->identity.vendor_id, 1565);
  EXPECT_EQ(listed->identity.device_type, 43);
  EXPECT_EQ(listed->identity.product_code, 500);
  EXPECT_EQ(listed->identity.major, 11);
  EXPECT_EQ(listed->identity.minor, 3);
  EXPECT_EQ(listed->identity.serial_number, 123456789u);
  EXPECT_EQ(listed->identity.name(), "Meca500");
  EXPECT_EQ(listed->identity.state, 0);
  EXPECT_EQ(written([&](wire::Writer& out) { write(out, *listed); }), test::golden::kListedIdentity);
}

TEST(Identity, OfALongNameKeepsItsBeginning) {
  Identity identity;
  identity.set_name(std::string(40, 'x'));
  EXPECT_EQ(identity.name(), std::string(32, 'x'));
}

TEST(IoPacket, OfTheRobotHasIdSequenceAndData) {
  const auto bytes = from_hex(test::golden::kInputPacket3, 272);
  const auto packet = read_io_packet(bytes);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->connection_id, 0xDC2D0001u);
  EXPECT_EQ(packet->sequence, 3u);
  EXPECT_EQ(packet->data.size(), 254u);
  EXPECT_EQ(wire::Reader(packet->data).u16(), 3) << "sequence count";
}

TEST(IoPacket, OfTheOriginatorIsWrittenAsRecorded) {
  const auto bytes = from_hex(test::golden::kOutputPacket1);
  ASSERT_EQ(bytes.size(), 84u);
  const auto packet = read_io_packet(bytes);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->connection_id, 0x3FE60013u);
  EXPECT_EQ(packet->data.size(), 66u);
  EXPECT_EQ(written([&](wire::Writer& out) {
              write_io_packet(out, packet->connection_id, packet->sequence, packet->data.size());
              out.bytes(packet->data);
            }),
            test::golden::kOutputPacket1);
}

TEST(IoPacket, NeedsASequencedAddressAndConnectedDataInThisOrder) {
  EXPECT_TRUE(read_io_packet(from_hex("0200 02800800 01000000 02000000 B1000000")));
  EXPECT_FALSE(read_io_packet(from_hex("0200 A1000400 01000000 B1000000"))) << "address of class 3";
  EXPECT_FALSE(read_io_packet(from_hex("0200 B1000000 02800800 01000000 02000000"))) << "swapped";
  EXPECT_FALSE(read_io_packet(from_hex("0100 02800800 01000000 02000000"))) << "no data";
  EXPECT_FALSE(read_io_packet(from_hex("0200 02800400 01000000 B1000000"))) << "address of 4 bytes";
}

TEST(Sequence, NewerIsLessThanHalfTheRangeAhead) {
  EXPECT_TRUE(newer(std::uint32_t{1}, std::uint32_t{0}));
  EXPECT_FALSE(newer(std::uint32_t{1}, std::uint32_t{1}));
  EXPECT_TRUE(newer(std::uint32_t{0}, std::uint32_t{0xFFFFFFFF}));
  EXPECT_TRUE(newer(std::uint32_t{0x7FFFFFFF}, std::uint32_t{0}));
  EXPECT_FALSE(newer(std::uint32_t{0x80000001}, std::uint32_t{0}));
  EXPECT_TRUE(newer(std::uint16_t{3}, std::uint16_t{0xFFFE}));
  EXPECT_FALSE(newer(std::uint16_t{0xFFFE}, std::uint16_t{3}));
}

}  // namespace
}  // namespace meca::ethernet_ip
