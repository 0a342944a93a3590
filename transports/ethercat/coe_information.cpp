// SDO information: lists of the objects, what an object is, what an entry is (ETG.1000.6, 5.6.3).
#include <algorithm>

#include "transports/ethercat/coe_server.hpp"

namespace meca::ethercat {
namespace {

// Behind the header of SDO information. Not more than a normal upload carries: so devices in the field cut their lists.
constexpr std::size_t kMostPart = CoeServer::kMostPayload - kCoeHeader - kSdoHeader;  // 112
constexpr std::uint16_t kCounts = 0, kAll = 1, kRxMappable = 2, kTxMappable = 3, kStored = 4, kSettings = 5;

void write_headers(wire::Writer& out, SdoInformation opcode, std::uint16_t fragments_left = 0) noexcept {
  write(out, CoeHeader{.service = static_cast<std::uint8_t>(CoeService::kSdoInformation)});
  write(out, SdoInformationHeader{.opcode = static_cast<std::uint8_t>(opcode),
                                  .incomplete = fragments_left > 0,
                                  .fragments_left = fragments_left});
}

void write_error(wire::Writer& out, SdoAbort code) noexcept {
  write_headers(out, SdoInformation::kError);
  out.u32(static_cast<std::uint32_t>(code));
}

bool is_in_list(const Object& object, std::uint16_t list) noexcept {
  switch (list) {
    case kAll:
      return true;
    case kRxMappable:
      return (object.access() & access::kRxPdo) != 0;
    case kTxMappable:
      return (object.access() & access::kTxPdo) != 0;
    case kStored:
      return (object.access() & access::kBackup) != 0;
    case kSettings:
      return (object.access() & access::kSetting) != 0;
    default:
      return false;
  }
}
std::size_t length_of(const ObjectDictionary& objects, std::uint16_t list) noexcept {
  return static_cast<std::size_t>(
      std::ranges::count_if(objects.objects(), [list](const Object& object) { return is_in_list(object, list); }));
}

void write_object(const ObjectDictionary& objects, std::uint16_t index, wire::Writer& out) noexcept {
  const Object* object = objects.find(index);
  if (object == nullptr) return write_error(out, SdoAbort::kNoObject);
  write_headers(out, SdoInformation::kObjectResponse);
  out.u16(index);
  out.u16(object->type);
  out.u8(object->most_sub());
  out.u8(static_cast<std::uint8_t>(object->code));
  out.text(object->name);
}

// No units, defaults and limits, whatever was asked for: the answer says so.
void write_entry(const ObjectDictionary& objects, std::uint16_t index, std::uint8_t sub, wire::Writer& out) noexcept {
  const Object* object = objects.find(index);
  if (object == nullptr) return write_error(out, SdoAbort::kNoObject);
  const Entry* entry = object->find(sub);
  if (entry == nullptr) return write_error(out, SdoAbort::kNoSubindex);
  write_headers(out, SdoInformation::kEntryResponse);
  out.u16(index);
  out.u8(sub);
  out.u8(0);
  out.u16(static_cast<std::uint16_t>(entry->type));
  out.u16(entry->bits);
  out.u16(entry->access);
  out.text(entry->name);
}

}  // namespace

void CoeServer::information(const ObjectDictionary& objects, wire::Reader& in, wire::Writer& out) noexcept {
  const SdoInformationHeader header = read_sdo_information_header(in);
  const std::uint16_t what = in.u16();  // a list, or an index
  const std::uint8_t sub = in.remaining() > 0 ? in.u8() : std::uint8_t{0};
  switch (static_cast<SdoInformation>(header.opcode)) {
    case SdoInformation::kListRequest:
      if (what > kSettings) return write_error(out, SdoAbort::kUnsupportedAccess);
      list_ = what;
      list_at_ = 0;
      if (list_ == kCounts) {
        write_headers(out, SdoInformation::kListResponse);
        out.u16(kCounts);
        for (std::uint16_t list = kAll; list <= kSettings; ++list) {
          out.u16(static_cast<std::uint16_t>(length_of(objects, list)));
        }
        return;
      }
      // The number of the list counts as an entry of the first fragment.
      fragments_left_ = static_cast<std::uint16_t>((2 * (length_of(objects, list_) + 1) + kMostPart - 1) / kMostPart);
      return next_fragment(objects, out);
    case SdoInformation::kObjectRequest:
      return write_object(objects, what, out);
    case SdoInformation::kEntryRequest:
      return write_entry(objects, what, sub, out);
    case SdoInformation::kListResponse:
    case SdoInformation::kObjectResponse:
    case SdoInformation::kEntryResponse:
    case SdoInformation::kError:
      break;
  }
  write_error(out, SdoAbort::kCommand);
}

void CoeServer::next_fragment(const ObjectDictionary& objects, wire::Writer& out) noexcept {
  if (fragments_left_ == 0) return;
  --fragments_left_;
  write_headers(out, SdoInformation::kListResponse, fragments_left_);
  std::size_t room = kMostPart / 2;
  if (list_at_ == 0) {
    out.u16(list_);
    --room;
  }
  std::size_t at = 0;
  const std::size_t end = list_at_ + room;
  for (const Object& object : objects.objects()) {
    if (!is_in_list(object, list_)) continue;
    if (at >= list_at_ && at < end) out.u16(object.index);
    ++at;
  }
  list_at_ = std::min(end, at);
}

}  // namespace meca::ethercat
