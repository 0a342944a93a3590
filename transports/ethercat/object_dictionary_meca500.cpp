// The objects of a Meca500. Indices, types and defaults: the vendor's ESI 9.3.3 and 10.2.1; process objects and their
// names: the field table; what differs on a robot that has just been switched on: read from one (firmware 9). inferred:
// names of objects where the ESI has none, and which objects are kept as settings. No ESI of firmware 11 is public:
// what is no process data is taken over from 10.2.1.
#include <algorithm>

#include "transports/ethercat/device.hpp"
#include "transports/ethercat/object_dictionary.hpp"
#include "transports/ethercat/pdo_objects.hpp"
#include "transports/text.hpp"

namespace meca::ethercat {
namespace {

using image::Layout;

// Complex data types of SDO information (ETG.1020); 0 for those of the vendor.
constexpr std::uint16_t kPdoMappingType = 0x0021, kIdentityType = 0x0023, kSyncManagerType = 0x0029;
constexpr std::uint16_t kWriteInPreop = access::kRead | access::kWriteInPreop,
                        kReadWrite = access::kRead | access::kWrite;

constexpr std::uint16_t bits_of_type(DataType type) noexcept {
  switch (type) {
    case DataType::kBoolean:
      return 1;
    case DataType::kInteger8:
    case DataType::kUnsigned8:
      return 8;
    case DataType::kUnsigned16:
      return 16;
    case DataType::kUnsigned32:
    case DataType::kReal32:
      return 32;
    case DataType::kUnsigned64:
      return 64;
    case DataType::kNone:
    case DataType::kVisibleString:
      break;
  }
  return 0;
}

constexpr DataType type_of(image::WireType type) noexcept {
  switch (type) {
    case image::WireType::kBool:
      return DataType::kBoolean;
    case image::WireType::kUint16:
      return DataType::kUnsigned16;
    case image::WireType::kUdint:
      return DataType::kUnsigned32;
    case image::WireType::kReal:
      return DataType::kReal32;
    case image::WireType::kSint:
      return DataType::kInteger8;
    case image::WireType::kUsint:
      return DataType::kUnsigned8;
  }
  return DataType::kNone;
}

std::string numbered(unsigned sub) { return std::string(FixedText<16>::format("SubIndex %03u", sub).view()); }

class Builder {
 public:
  explicit Builder(const DeviceSettings& settings) : settings_(settings) {}

  ObjectDictionary build() {
    identity();
    process_objects(image::kInputFields, Entry::Home::kInput, access::kRead | access::kTxPdo);
    process_objects(image::kOutputFields, Entry::Home::kOutput, kReadWrite | access::kRxPdo);
    mappings(rx_pdos(settings_.layout));
    mappings(tx_pdos(settings_.layout));
    communication();
    vendor_objects();
    out_.finish();
    return std::move(out_);
  }

 private:
  Entry number(unsigned sub, DataType type, std::uint64_t value, std::string name,
               std::uint16_t access = access::kRead) {
    std::array<std::byte, 8> bytes{};
    wire::Writer(bytes).u64(value);
    Entry entry{.sub = static_cast<std::uint8_t>(sub),
                .type = type,
                .bits = bits_of_type(type),
                .access = access,
                .name = std::move(name)};
    return out_.stored(entry, Bytes(bytes).first(entry.bytes()));
  }
  Entry count(std::size_t value, std::uint16_t access = access::kRead) {
    return number(0, DataType::kUnsigned8, value, numbered(0), access);
  }
  static Entry hole(unsigned sub, unsigned bits) {
    return {.sub = static_cast<std::uint8_t>(sub), .bits = static_cast<std::uint16_t>(bits), .access = 0, .name = {}};
  }

  void variable(std::uint16_t index, DataType type, std::uint64_t value, std::string name,
                std::uint16_t access = access::kRead) {
    out_.add(
        {index, ObjectCode::kVariable, static_cast<std::uint16_t>(type), name, {number(0, type, value, name, access)}});
  }
  void string(std::uint16_t index, std::string_view value, std::string name) {
    Entry entry{.type = DataType::kVisibleString, .bits = static_cast<std::uint16_t>(8 * value.size()), .name = name};
    out_.add({index,
              ObjectCode::kVariable,
              static_cast<std::uint16_t>(DataType::kVisibleString),
              name,
              {out_.stored(std::move(entry), std::as_bytes(std::span(value)))}});
  }

  void identity() {
    variable(0x1000, DataType::kUnsigned32, 0x1389, "Device type");  // profile 5001
    variable(0x1001, DataType::kUnsigned8, 0, "Error register");
    string(0x1008, "Meca500", "Device name");
    string(0x1009, "3", "Hardware version");
    string(0x100A, settings_.firmware, "Software version");
    out_.add({0x1018,
              ObjectCode::kRecord,
              kIdentityType,
              "Identity",
              {count(4), number(1, DataType::kUnsigned32, settings_.vendor, "Vendor ID"),
               number(2, DataType::kUnsigned32, settings_.product, "Product code"),
               number(3, DataType::kUnsigned32, settings_.revision, "Revision"),
               number(4, DataType::kUnsigned32, settings_.serial, "Serial number")}});
    out_.add({0x10F1,
              ObjectCode::kRecord,
              0,
              "Error Settings",
              {count(2), number(1, DataType::kUnsigned32, 1, "Local Error Reaction", kReadWrite | access::kSetting),
               number(2, DataType::kUnsigned16, 4, "Sync Error Counter Limit", kReadWrite | access::kSetting)}});
    variable(0x10F8, DataType::kUnsigned64, 0, "Timestamp Object", kReadWrite | access::kTxPdo);
  }

  // Objects with subindex 0 alone are variables, the others records.
  void process_objects(const auto& fields, Entry::Home home, std::uint16_t access) {
    for (const auto& field : fields) {
      if (!field.layouts.has(settings_.layout) || field.robots != image::Robots::kMeca500) continue;
      const image::CoeObject coe = coe_object(field, settings_.layout);
      Entry entry{.sub = coe.sub,
                  .type = type_of(field.type),
                  .bits = static_cast<std::uint16_t>(field.bits()),
                  .access = access,
                  .name = std::string(field.name)};
      entry.home = home;
      entry.first_bit = field.first_bit();
      if (entry.type == DataType::kBoolean) entry.most = 1;
      if (coe.sub == 0) {
        out_.add({coe.index, ObjectCode::kVariable, static_cast<std::uint16_t>(entry.type), entry.name, {entry}});
        continue;
      }
      Object& object = record(coe.index, field.section);
      const auto place = std::ranges::lower_bound(object.entries, entry.sub, {}, &Entry::sub);
      object.entries.insert(place, entry);
      out_.set_number({coe.index, 0}, object.most_sub());
    }
  }
  Object& record(std::uint16_t index, std::string_view name) {
    if (Object* object = out_.building(index)) return *object;
    return out_.add({index, ObjectCode::kRecord, 0, std::string(name), {count(0)}});
  }

  void mappings(const std::vector<Pdo>& pdos) {
    for (const Pdo& pdo : pdos) {
      const Object* mapped = out_.find(static_cast<std::uint16_t>(pdo.entries.front() >> 16));
      Object object{pdo.index, ObjectCode::kRecord, kPdoMappingType, mapped->name, {count(pdo.entries.size())}};
      for (unsigned i = 0; i < pdo.entries.size(); ++i) {
        object.entries.push_back(number(i + 1, DataType::kUnsigned32, pdo.entries[i], numbered(i + 1)));
      }
      out_.add(std::move(object));
    }
  }

  // A robot that was just switched on [ROBOT]: the counts say 9 and 11, but 1C12h:01 is 0. inferred: so are the others.
  void assignment(std::uint16_t index, std::string name, std::span<const std::uint16_t> pdos, std::size_t fresh_count) {
    Object object{index,
                  ObjectCode::kArray,
                  static_cast<std::uint16_t>(DataType::kUnsigned16),
                  std::move(name),
                  {count(settings_.assigned ? pdos.size() : fresh_count, kWriteInPreop | access::kSetting)}};
    for (unsigned i = 0; i < pdos.size(); ++i) {
      object.entries.push_back(number(i + 1, DataType::kUnsigned16, settings_.assigned ? pdos[i] : 0, numbered(i + 1),
                                      kWriteInPreop | access::kSetting));
    }
    out_.add(std::move(object));
  }

  void communication() {
    Object types{
        0x1C00, ObjectCode::kArray, static_cast<std::uint16_t>(DataType::kUnsigned8), "Sync manager type", {count(4)}};
    constexpr std::array<std::uint8_t, 4> kTypes{1, 2, 3, 4}, kOldTypes{2, 1, 3, 4};
    for (unsigned i = 0; i < 4; ++i) {
      types.entries.push_back(number(i + 1, DataType::kUnsigned8,
                                     (settings_.old_sync_manager_types ? kOldTypes : kTypes)[i], numbered(i + 1)));
    }
    out_.add(std::move(types));
    assignment(kRxPdoAssignment, "SM2", rx_assignment(), 9);
    assignment(kTxPdoAssignment, "SM3", tx_assignment(settings_.layout != Layout::kFirmware9), 11);
    synchronization(0x1C32, "SM output parameter", 1);
    synchronization(0x1C33, "SM input parameter", 0x22);
  }

  void synchronization(std::uint16_t index, std::string name, std::uint32_t type) {
    constexpr std::uint32_t kTypesSupported = 0x8007, kMinimumCycle = 1'000'000;  // ns
    const auto setting = [](Entry entry, std::uint32_t most) {
      entry.access = kWriteInPreop | access::kSetting;
      entry.most = most;
      return entry;
    };
    constexpr std::uint32_t kMostType = 0x22;  // synchronous with SM2; inferred: as far as the check goes
    out_.add({index,
              ObjectCode::kRecord,
              kSyncManagerType,
              std::move(name),
              {count(32), setting(number(1, DataType::kUnsigned16, type, "Synchronization Type"), kMostType),
               number(2, DataType::kUnsigned32, 0, "Cycle Time"), hole(3, 32),
               number(4, DataType::kUnsigned16, kTypesSupported, "Synchronization Types supported"),
               number(5, DataType::kUnsigned32, kMinimumCycle, "Minimum Cycle Time"),
               number(6, DataType::kUnsigned32, 0, "Calc and Copy Time"), hole(7, 32),
               number(8, DataType::kUnsigned16, 0, "Get Cycle Time", kReadWrite),
               number(9, DataType::kUnsigned32, 0, "Delay Time"),
               number(10, DataType::kUnsigned32, 0, "Sync0 Cycle Time", kReadWrite),
               number(11, DataType::kUnsigned16, 0, "SM-Event Missed"),
               number(12, DataType::kUnsigned16, 0, "Cycle Time Too Small"), hole(13, 160),
               number(32, DataType::kBoolean, 0, "Sync Error")}});
  }

  void vendor_objects() {
    const auto port = [this](unsigned sub, std::string name) {
      Entry entry = number(sub, DataType::kUnsigned8, 1, std::move(name), kReadWrite | access::kBackup);
      entry.least = 1;
      entry.most = 2;
      return entry;
    };
    out_.add(
        {0x8000, ObjectCode::kRecord, 0, "Communication Mode", {count(2), port(1, "Port In"), port(2, "Port Out")}});
    array(0xA000, "setDbg", std::array<std::uint32_t, 6>{1, 3}, kReadWrite);
    variable(0xAF00, DataType::kInteger8, 0, "State");
    array(0xAFFF, "Internal Status", std::array<std::uint32_t, 10>{}, access::kRead | access::kTxPdo);
  }
  void array(std::uint16_t index, std::string name, const auto& values, std::uint16_t access) {
    Object object{index,
                  ObjectCode::kArray,
                  static_cast<std::uint16_t>(DataType::kUnsigned32),
                  std::move(name),
                  {count(values.size())}};
    for (unsigned i = 0; i < values.size(); ++i) {
      object.entries.push_back(number(i + 1, DataType::kUnsigned32, values[i], numbered(i + 1), access));
    }
    out_.add(std::move(object));
  }

  const DeviceSettings& settings_;
  ObjectDictionary out_;
};

}  // namespace

ObjectDictionary make_meca500_dictionary(const DeviceSettings& settings) { return Builder(settings).build(); }

}  // namespace meca::ethercat
