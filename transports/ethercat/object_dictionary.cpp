#include "transports/ethercat/object_dictionary.hpp"

#include <algorithm>

#include "transports/ethercat/pdo_objects.hpp"

namespace meca::ethercat {
namespace {

bool bit_at(Bytes bytes, std::size_t bit) noexcept {
  return (bytes[bit / 8] >> (bit % 8) & std::byte{1}) != std::byte{0};
}
void copy_bits(Bytes from, std::size_t from_bit, std::span<std::byte> to, std::size_t to_bit,
               std::size_t bits) noexcept {
  for (std::size_t i = 0; i < bits; ++i) {
    const std::byte mask = std::byte{1} << ((to_bit + i) % 8);
    std::byte& byte = to[(to_bit + i) / 8];
    byte = bit_at(from, from_bit + i) ? byte | mask : byte & ~mask;
  }
}

// In the low three bits of the access: PREOP, SAFEOP, OP. No mailbox is served in the other states.
std::uint16_t state_bit(AlState state) noexcept {
  switch (state) {
    case AlState::kPreop:
      return 0x1;
    case AlState::kSafeop:
      return 0x2;
    case AlState::kOp:
      return 0x4;
    case AlState::kInit:
    case AlState::kBoot:
      return 0;
  }
  return 0;
}

std::optional<SdoAbort> check_writable(const Entry& entry, AlState state) noexcept {
  if ((entry.access & access::kWrite) == 0) return SdoAbort::kReadOnly;
  if ((entry.access & state_bit(state) << 3) == 0) return SdoAbort::kState;
  return std::nullopt;
}

std::uint32_t number_of(Bytes value) noexcept {
  std::uint32_t out = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(value.size(), 4); ++i) {
    out |= std::to_integer<std::uint32_t>(value[i]) << 8 * i;
  }
  return out;
}

std::optional<SdoAbort> check_value(const Entry& entry, Bytes value) noexcept {
  if (value.size() > entry.bytes()) return SdoAbort::kTooLong;
  if (value.size() < entry.bytes()) return SdoAbort::kTooShort;
  const std::uint32_t number = number_of(value);
  if (number < entry.least || number > entry.most) return SdoAbort::kValueRange;
  return std::nullopt;
}

bool is_assignment(const Object& object) noexcept {
  return object.index == kRxPdoAssignment || object.index == kTxPdoAssignment;
}

// In Complete Access subindex 0 takes 16 bits, everything behind it follows without gaps (ETG.1000.6, 5.6.2.1).
std::size_t bits_in_complete_access(const Entry& entry) noexcept { return entry.sub == 0 ? 16 : entry.bits; }

}  // namespace

const Entry* Object::find(std::uint8_t sub) const noexcept {
  for (const Entry& entry : entries) {
    if (entry.sub == sub && entry.exists()) return &entry;
  }
  return nullptr;
}

std::uint8_t Object::most_sub() const noexcept { return entries.empty() ? std::uint8_t{0} : entries.back().sub; }

std::uint16_t Object::access() const noexcept {
  std::uint16_t all = 0;
  for (const Entry& entry : entries) all |= entry.access;
  return all;
}

Entry ObjectDictionary::stored(Entry entry, Bytes value) {
  entry.home = Entry::Home::kStore;
  entry.first_bit = 8 * store_.size();
  store_.insert(store_.end(), value.begin(), value.end());
  return entry;
}

Object& ObjectDictionary::add(Object object) {
  const auto place = std::ranges::lower_bound(objects_, object.index, {}, &Object::index);
  return *objects_.insert(place, std::move(object));
}

Object* ObjectDictionary::building(std::uint16_t index) noexcept {
  const auto place = std::ranges::lower_bound(objects_, index, {}, &Object::index);
  return place != objects_.end() && place->index == index ? &*place : nullptr;
}

void ObjectDictionary::finish() { initial_ = store_; }

void ObjectDictionary::reset() noexcept {
  std::ranges::copy(initial_, store_.begin());
  input = {};
  output = {};
}

const Object* ObjectDictionary::find(std::uint16_t index) const noexcept {
  const auto place = std::ranges::lower_bound(objects_, index, {}, &Object::index);
  return place != objects_.end() && place->index == index ? &*place : nullptr;
}

Bytes ObjectDictionary::home(Entry::Home home) const noexcept {
  switch (home) {
    case Entry::Home::kInput:
      return input;
    case Entry::Home::kOutput:
      return output;
    case Entry::Home::kStore:
      return store_;
    case Entry::Home::kNothing:
      break;
  }
  return {};
}
std::span<std::byte> ObjectDictionary::home(Entry::Home home) noexcept {
  switch (home) {
    case Entry::Home::kInput:
      return input;
    case Entry::Home::kOutput:
      return output;
    case Entry::Home::kStore:
      return store_;
    case Entry::Home::kNothing:
      break;
  }
  return {};
}

std::optional<SdoAbort> ObjectDictionary::upload(SdoAddress address, bool complete_access, AlState state,
                                                 std::span<std::byte> to, std::size_t& size) const noexcept {
  size = 0;
  const Object* object = find(address.index);
  if (object == nullptr) return SdoAbort::kNoObject;
  if (state_bit(state) == 0) return SdoAbort::kState;
  if (complete_access) return upload_all(*object, address.sub, to, size);
  const Entry* entry = object->find(address.sub);
  if (entry == nullptr) return SdoAbort::kNoSubindex;
  if (entry->bytes() > to.size()) return SdoAbort::kMemory;
  size = entry->bytes();
  std::ranges::fill(to.first(size), std::byte{0});
  copy_bits(home(entry->home), entry->first_bit, to, 0, entry->bits);
  return std::nullopt;
}

std::optional<SdoAbort> ObjectDictionary::upload_all(const Object& object, std::uint8_t first, std::span<std::byte> to,
                                                     std::size_t& size) const noexcept {
  if (object.code == ObjectCode::kVariable || first > 1) return SdoAbort::kNoCompleteAccess;
  const std::uint32_t last = is_assignment(object) ? number(object.entries.front()) : object.most_sub();
  const auto counts = [&](const Entry& entry) { return entry.sub >= first && entry.sub <= last; };
  std::size_t bits = 0;
  for (const Entry& entry : object.entries) bits += counts(entry) ? bits_in_complete_access(entry) : 0;
  if ((bits + 7) / 8 > to.size()) return SdoAbort::kMemory;
  size = (bits + 7) / 8;
  std::ranges::fill(to.first(size), std::byte{0});
  std::size_t at = 0;
  for (const Entry& entry : object.entries) {
    if (!counts(entry)) continue;
    if (entry.exists()) copy_bits(home(entry.home), entry.first_bit, to, at, entry.bits);
    at += bits_in_complete_access(entry);
  }
  return std::nullopt;
}

std::optional<SdoAbort> ObjectDictionary::download(SdoAddress address, bool complete_access, AlState state,
                                                   Bytes value) noexcept {
  const Object* object = find(address.index);
  if (object == nullptr) return SdoAbort::kNoObject;
  if (complete_access) return download_all(*object, address.sub, state, value);
  const Entry* entry = object->find(address.sub);
  if (entry == nullptr) return SdoAbort::kNoSubindex;
  if (const auto abort = check_writable(*entry, state)) return abort;
  if (const auto abort = check_value(*entry, value)) return abort;
  if (is_assignment(*object)) return download_assignment(*object, address.sub, number_of(value));
  copy_bits(value, 0, home(entry->home), entry->first_bit, entry->bits);
  return std::nullopt;
}

std::optional<SdoAbort> ObjectDictionary::download_all(const Object& object, std::uint8_t first, AlState state,
                                                       Bytes value) noexcept {
  if (object.code == ObjectCode::kVariable || first > 1) return SdoAbort::kNoCompleteAccess;
  std::size_t bits = 0;
  for (const Entry& entry : object.entries) {
    if (entry.sub < first) continue;
    bits += bits_in_complete_access(entry);
    const bool count_that_stays = entry.sub == 0 && !is_assignment(object);
    if (!entry.exists() || count_that_stays) continue;
    if (const auto abort = check_writable(entry, state)) return abort;
  }
  if (is_assignment(object)) return first == 0 ? assign_all(object, value) : SdoAbort::kNoCompleteAccess;
  if (value.size() != (bits + 7) / 8) return SdoAbort::kLength;
  std::array<std::byte, 8> one{};
  for (const bool write : {false, true}) {  // all of it, or nothing
    std::size_t at = 0;
    for (const Entry& entry : object.entries) {
      if (entry.sub < first) continue;
      if (entry.sub != 0 && entry.exists()) {
        one = {};
        copy_bits(value, at, one, 0, entry.bits);
        const auto abort = check_value(entry, Bytes(one).first(entry.bytes()));
        if (abort) return abort;
        if (write) copy_bits(one, 0, home(entry.home), entry.first_bit, entry.bits);
      }
      at += bits_in_complete_access(entry);
    }
  }
  return std::nullopt;
}

bool ObjectDictionary::assignable(std::uint16_t assignment, std::uint32_t pdo) const noexcept {
  const std::uint32_t first = assignment == kRxPdoAssignment ? 0x1600 : 0x1A00;
  return pdo >= first && pdo < first + 0x200 && find(static_cast<std::uint16_t>(pdo)) != nullptr;
}

// Entries are written while the count is 0; the count that is written last makes them valid.
std::optional<SdoAbort> ObjectDictionary::download_assignment(const Object& object, std::uint8_t sub,
                                                              std::uint32_t value) noexcept {
  const Entry& count = object.entries.front();
  if (sub != 0) {
    if (number(count) != 0) return SdoAbort::kSubindex0NotZero;
    if (!assignable(object.index, value)) return SdoAbort::kNotMappable;
    set_number(*object.find(sub), value);
    return std::nullopt;
  }
  if (value > object.most_sub()) return SdoAbort::kMappingTooLong;
  if (value != 0 && number(count) != 0) return SdoAbort::kSubindex0NotZero;
  for (std::uint32_t i = 1; i <= value; ++i) {
    if (!assignable(object.index, number(object.entries[i]))) return SdoAbort::kNotMappable;
  }
  set_number(count, value);
  return std::nullopt;
}

std::optional<SdoAbort> ObjectDictionary::assign_all(const Object& object, Bytes value) noexcept {
  wire::Reader in(value);
  const std::uint16_t count = in.u16();
  if (!in.ok()) return SdoAbort::kTooShort;
  if (count > object.most_sub()) return SdoAbort::kMappingTooLong;
  if (in.remaining() < 2U * count) return SdoAbort::kTooShort;
  if (in.remaining() > 2U * object.most_sub()) return SdoAbort::kTooLong;
  wire::Reader check(value.subspan(2));
  for (std::uint16_t i = 0; i < count; ++i) {
    if (!assignable(object.index, check.u16())) return SdoAbort::kNotMappable;
  }
  set_number(object.entries.front(), count);
  for (std::uint16_t i = 1; i <= count; ++i) set_number(object.entries[i], in.u16());
  return std::nullopt;
}

bool ObjectDictionary::assigned(std::uint16_t assignment, std::span<const std::uint16_t> pdos) const noexcept {
  const Object* object = find(assignment);
  if (object == nullptr || number(object->entries.front()) != pdos.size()) return false;
  for (std::size_t i = 0; i < pdos.size(); ++i) {
    if (number(object->entries[i + 1]) != pdos[i]) return false;
  }
  return true;
}

std::uint32_t ObjectDictionary::number(const Entry& entry) const noexcept {
  std::array<std::byte, 4> value{};
  copy_bits(home(entry.home), entry.first_bit, value, 0, std::min<std::size_t>(entry.bits, 32));
  return number_of(value);
}

void ObjectDictionary::set_number(const Entry& entry, std::uint64_t value) noexcept {
  std::array<std::byte, 8> bytes{};
  wire::Writer(bytes).u64(value);
  copy_bits(bytes, 0, home(entry.home), entry.first_bit, std::min<std::size_t>(entry.bits, 64));
}

std::uint32_t ObjectDictionary::number(SdoAddress address) const noexcept {
  const Object* object = find(address.index);
  const Entry* entry = object != nullptr ? object->find(address.sub) : nullptr;
  return entry != nullptr ? number(*entry) : 0;
}

void ObjectDictionary::set_number(SdoAddress address, std::uint64_t value) noexcept {
  const Object* object = find(address.index);
  if (const Entry* entry = object != nullptr ? object->find(address.sub) : nullptr) set_number(*entry, value);
}

}  // namespace meca::ethercat
