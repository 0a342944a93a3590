// The CANopen objects of a device: what SDO services and SDO information read and write (ETG.1000.6, 5.6.2 and 5.6.3).
// Knows what may be read and written in which AL state; abort codes say why not. No allocation once it is built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "transports/ethercat/mailbox.hpp"
#include "transports/ethercat/registers.hpp"
#include "transports/image/image.hpp"

namespace meca::ethercat {

struct DeviceSettings;

enum class DataType : std::uint16_t {  // ETG.1020, base data types
  kNone = 0,
  kBoolean = 0x01,
  kInteger8 = 0x02,
  kUnsigned8 = 0x05,
  kUnsigned16 = 0x06,
  kUnsigned32 = 0x07,
  kReal32 = 0x08,
  kVisibleString = 0x09,
  kUnsigned64 = 0x1B
};
enum class ObjectCode : std::uint8_t { kVariable = 7, kArray = 8, kRecord = 9 };

// Object access of SDO information: in which states an entry is read and written, what it is good for.
namespace access {
inline constexpr std::uint16_t kRead = 0x0007, kWrite = 0x0038, kWriteInPreop = 0x0008, kRxPdo = 0x0040,
                               kTxPdo = 0x0080, kBackup = 0x0100, kSetting = 0x0200;
}

struct Entry {
  enum class Home : std::uint8_t { kNothing, kStore, kInput, kOutput };  // where the value is; nothing: a hole
  std::uint8_t sub = 0;
  DataType type = DataType::kNone;
  std::uint16_t bits = 0;
  std::uint16_t access = access::kRead;
  std::string name;
  std::uint32_t least = 0, most = 0xFFFFFFFF;  // of what may be written
  Home home = Home::kNothing;
  std::size_t first_bit = 0;

  bool exists() const noexcept { return home != Home::kNothing; }
  std::size_t bytes() const noexcept { return (bits + 7U) / 8U; }
};

struct Object {
  std::uint16_t index = 0;
  ObjectCode code = ObjectCode::kVariable;
  std::uint16_t type = 0;
  std::string name;
  // Ascending; those of records and arrays begin with subindex 0. Holes keep the places of Complete Access.
  std::vector<Entry> entries;

  const Entry* find(std::uint8_t sub) const noexcept;  // null for a hole too
  std::uint8_t most_sub() const noexcept;
  std::uint16_t access() const noexcept;  // of all entries together
};

class ObjectDictionary {
 public:
  // ---- Building. `value`: the entry's, as many bytes as it has.
  Entry stored(Entry entry, Bytes value);
  Object& add(Object object);                      // in any order of the indices, each once
  Object* building(std::uint16_t index) noexcept;  // what was added, to add entries
  void finish();                                   // what is stored now is what reset() comes back to

  // ---- Use
  void reset() noexcept;  // as after power-on
  const Object* find(std::uint16_t index) const noexcept;
  std::span<const Object> objects() const noexcept { return objects_; }  // by index

  // The value into `to`; `size`: of the value. An abort where it cannot be had.
  std::optional<SdoAbort> upload(SdoAddress address, bool complete_access, AlState state, std::span<std::byte> to,
                                 std::size_t& size) const noexcept;
  std::optional<SdoAbort> download(SdoAddress address, bool complete_access, AlState state, Bytes value) noexcept;

  // The device's own access, of numbers; entries that are not there read 0.
  std::uint32_t number(SdoAddress address) const noexcept;
  void set_number(SdoAddress address, std::uint64_t value) noexcept;

  // Whether a PDO assignment (1C12h, 1C13h) names exactly these.
  bool assigned(std::uint16_t assignment, std::span<const std::uint16_t> pdos) const noexcept;

  image::InputBytes input{};    // behind the 60xxh objects
  image::OutputBytes output{};  // behind the 7xxxh objects

 private:
  std::optional<SdoAbort> upload_all(const Object& object, std::uint8_t first, std::span<std::byte> to,
                                     std::size_t& size) const noexcept;
  std::optional<SdoAbort> download_all(const Object& object, std::uint8_t first, AlState state, Bytes value) noexcept;
  std::optional<SdoAbort> download_assignment(const Object& object, std::uint8_t sub, std::uint32_t value) noexcept;
  std::optional<SdoAbort> assign_all(const Object& object, Bytes value) noexcept;
  bool assignable(std::uint16_t assignment, std::uint32_t pdo) const noexcept;
  Bytes home(Entry::Home home) const noexcept;
  std::span<std::byte> home(Entry::Home home) noexcept;
  std::uint32_t number(const Entry& entry) const noexcept;
  void set_number(const Entry& entry, std::uint64_t value) noexcept;

  std::vector<Object> objects_;
  std::vector<std::byte> store_, initial_;
};

// The objects of a Meca500 in the layout of the settings. Sources: the vendor's ESI 9.3.3 and 10.2.1, the field table,
// and what a real robot answered; see the .cpp.
ObjectDictionary make_meca500_dictionary(const DeviceSettings& settings);

}  // namespace meca::ethercat
