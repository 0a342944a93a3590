// Any bytes for every reader of EtherNet/IP: quiet, and what could be read is written again and reads the same. The
// first byte chooses where reading begins, so that the same message serves as header, items or CIP message.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "transports/ethernet_ip/cip.hpp"
#include "transports/ethernet_ip/io_packet.hpp"

namespace {

using namespace meca::ethernet_ip;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "ethernet_ip_wire_fuzz: %s\n", what);
  std::abort();
}

template <class Write>
std::vector<std::byte> written(std::size_t room, Write write) {
  std::vector<std::byte> buffer(room);
  meca::wire::Writer out(buffer);
  write(out);
  require(out.ok(), "what was read does not fit when it is written");
  buffer.resize(out.size());
  return buffer;
}

void check_encapsulation(Bytes bytes) {
  if (const auto header = read_header(bytes)) {
    const auto again = written(kHeaderSize, [&](auto& out) { write(out, *header); });
    require(std::ranges::equal(again, bytes.first(kHeaderSize)), "a header changes when it is written");
  }
  meca::wire::Reader in(bytes);
  if (const auto items = read_items(in)) {
    require(items->count <= Items::kMost, "more items than there is room for");
    for (std::size_t i = 0; i < items->count; ++i) {
      const Bytes data = items->all[i].data;
      require(data.empty() || (data.data() >= bytes.data() && data.data() + data.size() <= bytes.data() + bytes.size()),
              "an item outside of its message");
    }
  }
  if (const auto address = read_socket_address(bytes)) {
    const auto again = written(16, [&](auto& out) { write(out, *address); });
    require(read_socket_address(again) == address, "a socket address changes when it is written");
  }
  meca::wire::Reader identity_bytes(bytes);
  if (const auto identity = read_identity(identity_bytes)) {
    const auto again = written(64, [&](auto& out) { write(out, *identity); });
    meca::wire::Reader back(again);
    require(read_identity(back) == identity, "an identity changes when it is written");
  }
  if (const auto listed = read_listed_identity(bytes)) {
    const auto again = written(96, [&](auto& out) { write(out, *listed); });
    const auto back = read_listed_identity(again);
    require(back && back->identity == listed->identity, "a listed identity changes when it is written");
  }
}

void check_cip(Bytes bytes) {
  Path path;
  read_path(bytes, path);
  require(path.connection_point_count <= path.connection_points.size(), "more points than there is room for");
  read_request(bytes);
  if (const auto reply = read_reply(bytes)) {
    require(reply->extended_count <= Reply::kMostExtended, "more extended words than there is room for");
  }
  for (const bool large : {false, true}) {
    ForwardOpen open;
    if (read_forward_open(bytes, large, open) != GeneralStatus::kSuccess) continue;
    const auto again = written(bytes.size(), [&](auto& out) {
      write_forward_open(out, open);
      out.u8(static_cast<std::uint8_t>(open.path.size() / 2));
      out.bytes(open.path);
    });
    ForwardOpen back;
    require(read_forward_open(again, large, back) == GeneralStatus::kSuccess, "a Forward Open cannot be read back");
    require(back.triad == open.triad && back.o_to_t == open.o_to_t && back.t_to_o == open.t_to_o &&
                back.multiplier_code == open.multiplier_code && std::ranges::equal(back.path, open.path),
            "a Forward Open changes when it is written");
  }
  ForwardClose close;
  if (read_forward_close(bytes, close) == GeneralStatus::kSuccess) {
    const auto again = written(bytes.size(), [&](auto& out) { write_forward_close(out, close, close.path); });
    ForwardClose back;
    require(read_forward_close(again, back) == GeneralStatus::kSuccess && back.triad == close.triad,
            "a Forward Close changes when it is written");
  }
  if (const auto reply = read_forward_open_reply(bytes)) {
    const auto again = written(26, [&](auto& out) { write(out, *reply); });
    require(std::ranges::equal(Bytes(again).first(24), bytes.first(24)), "a reply changes when it is written");
  }
  read_connection_failure(bytes);
  read_forward_close_reply(bytes);
}

void check_io(Bytes bytes) {
  const auto packet = read_io_packet(bytes);
  if (!packet) return;
  const auto again = written(kIoOverhead + packet->data.size(), [&](auto& out) {
    write_io_packet(out, packet->connection_id, packet->sequence, packet->data.size());
    out.bytes(packet->data);
  });
  const auto back = read_io_packet(again);
  require(back && back->connection_id == packet->connection_id && back->sequence == packet->sequence &&
              std::ranges::equal(back->data, packet->data),
          "an I/O packet changes when it is written");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t skipped = data[0];
  const auto bytes = std::as_bytes(std::span(data + 1, size - 1));
  const Bytes from = bytes.subspan(std::min(skipped, bytes.size()));
  check_encapsulation(from);
  check_cip(from);
  check_io(from);
  return 0;
}
