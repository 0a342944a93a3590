// Any bytes for every reader of EtherCAT: quiet, and what could be read is written again and reads the same. The first
// byte chooses where reading begins, so that the same frame serves as frame, mail or SDO message.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "transports/ethercat/mailbox.hpp"
#include "transports/ethercat/sii.hpp"

namespace {

using namespace meca::ethercat;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "ethercat_wire_fuzz: %s\n", what);
  std::abort();
}

bool equal(Bytes a, Bytes b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); }

bool inside(Bytes part, Bytes whole) {
  return part.empty() || (part.data() >= whole.data() && part.data() + part.size() <= whole.data() + whole.size());
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

void check_again(Bytes again, Bytes frame) {
  DatagramWalk<const std::byte> before(frame), after(again);
  while (const auto back = after.next()) {
    const auto datagram = before.next();
    require(datagram && back->raw_command() == datagram->raw_command() && back->index() == datagram->index() &&
                back->address() == datagram->address() && equal(back->data(), datagram->data()),
            "a datagram changes when it is written");
  }
  require(after.ok(), "a written frame cannot be read");
}

// All datagrams of a frame into a frame of ours, as far as it has room.
void check_frame(Bytes frame) {
  DatagramWalk<const std::byte> walk(frame);
  std::vector<std::byte> buffer(kLongestFrame);
  FrameWriter writer(buffer, {});
  bool fits = true;
  while (const auto datagram = walk.next()) {
    require(inside(datagram->data(), frame), "a datagram outside of its frame");
    const auto data = datagram->data();
    const auto room = writer.room();
    const auto copy = writer.add(datagram->command(), datagram->index(), datagram->address(), data.size());
    require(copy.empty() == (data.empty() || data.size() > room),
            "a datagram fits where there is no room, or does not");
    std::copy_n(data.begin(), copy.size(), copy.begin());
    fits = fits && !copy.empty();
  }
  const Bytes again = writer.finish();
  require(again.size() <= kLongestFrame && again.empty() == (writer.count() == 0), "a frame too long or not there");
  if (writer.count() > 0 && fits) check_again(again, frame);
}

// A device changes a frame in place: nothing but what it means to change.
void check_in_place(Bytes frame) {
  std::vector<std::byte> changed(frame.begin(), frame.end());
  DatagramWalk<std::byte> walk(changed);
  std::size_t count = 0;
  while (auto datagram = walk.next()) {
    const std::uint16_t counter = datagram->working_counter();
    datagram->set_working_counter(static_cast<std::uint16_t>(counter + 1));
    datagram->set_working_counter(counter);
    datagram->set_adp(datagram->adp());
    datagram->set_irq(datagram->irq());
    ++count;
  }
  require(count == 0 || equal(changed, frame), "a frame changes where it should not");
}

void check_sdo(CoeService service, Bytes bytes) {
  const auto sdo = parse_sdo(service, bytes);
  if (!sdo) return;
  require(inside(sdo->data, bytes), "data outside of its message");
  require(sdo->kind == SdoMessage::Kind::kUploadSegmentResponse ||
              sdo->kind == SdoMessage::Kind::kDownloadSegmentRequest || sdo->data.size() <= sdo->size,
          "more data than its size");
  if (sdo->kind == SdoMessage::Kind::kUnknown) return;
  const auto again = written(bytes.size() + kSdoHeader, [&](auto& out) { write(out, *sdo); });
  const auto back = parse_sdo(service, again);
  require(back && back->kind == sdo->kind && back->address == sdo->address &&
              back->complete_access == sdo->complete_access && back->expedited == sdo->expedited &&
              back->toggle == sdo->toggle && back->last == sdo->last && back->size == sdo->size &&
              back->abort == sdo->abort && equal(back->data, sdo->data),
          "an SDO message changes when it is written");
}

void check_coe(Bytes payload) {
  for (const auto service : {CoeService::kSdoRequest, CoeService::kSdoResponse}) check_sdo(service, payload);
  meca::wire::Reader in(payload);
  const CoeHeader header = read_coe_header(in);
  if (!in.ok()) return;
  const Bytes body = in.rest();
  check_sdo(static_cast<CoeService>(header.service), body);
  if (const auto emergency = parse_emergency(body)) {
    const auto again = written(kSdoHeader, [&](auto& out) { write(out, *emergency); });
    require(equal(again, body.first(again.size())), "an emergency changes when it is written");
  }
  meca::wire::Reader information_bytes(body);
  const auto information = read_sdo_information_header(information_bytes);
  const auto again = written(4, [&](auto& out) { write(out, information); });
  meca::wire::Reader back_bytes(again);
  const auto back = read_sdo_information_header(back_bytes);
  require(back.opcode == information.opcode && back.incomplete == information.incomplete &&
              back.fragments_left == information.fragments_left,
          "an SDO information header changes when it is written");
}

void check_mail(Bytes memory) {
  const auto mail = parse_mail(memory);
  if (!mail) return;
  require(inside(mail->payload, memory) && mail->payload.size() == mail->header.length,
          "a payload outside of its mail");
  const auto again = written(kMailboxHeader + mail->payload.size(), [&](auto& out) {
    write(out, mail->header);
    out.bytes(mail->payload);
  });
  const auto back = parse_mail(again);
  require(back && back->header.address == mail->header.address && back->header.channel == mail->header.channel &&
              back->header.priority == mail->header.priority && back->header.type == mail->header.type &&
              back->header.counter == mail->header.counter && equal(back->payload, mail->payload),
          "a mail changes when it is written");
  parse_mailbox_error(mail->payload);
  check_coe(mail->payload);
}

void check_sii(Bytes words) {
  const auto identity = parse_sii_identity(words);
  if (!identity) return;
  const auto image = make_meca500_sii(identity->alias, identity->serial);
  const auto robot = parse_sii_identity(image);
  require(robot && robot->checksum_right && robot->alias == identity->alias && robot->serial == identity->serial,
          "an SII without its alias or serial number");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t skipped = data[0];
  const auto bytes = std::as_bytes(std::span(data + 1, size - 1));
  const Bytes from = bytes.subspan(std::min(skipped, bytes.size()));
  check_frame(from);
  check_in_place(from);
  check_mail(from);
  check_coe(from);
  check_sii(from);
  return 0;
}
