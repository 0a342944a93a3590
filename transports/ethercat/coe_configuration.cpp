#include "transports/ethercat/coe_configuration.hpp"

#include <charconv>

namespace meca::ethercat {
namespace {

constexpr std::uint16_t kDeviceName = 0x1008, kSoftwareVersion = 0x100A;
constexpr std::array<std::uint16_t, 2> kSyncParameters{0x1C32, 0x1C33};  // of the outputs, of the inputs
constexpr std::uint8_t kSyncType = 1;
// Sync types (ETG.1020, 1C32h and 1C33h). The inputs follow the event of sync manager 2, as the robot has it by itself.
constexpr std::uint16_t kSmSynchronous = 0x01, kSm2Synchronous = 0x22, kDcSync0 = 0x02;

std::string_view text_of(Bytes bytes) noexcept {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.substr(0, text.find('\0'));
}

}  // namespace

transports::FirmwareVersion parse_firmware(std::string_view text) noexcept {
  std::array<std::uint16_t, 4> numbers{};
  std::size_t count = 0;
  if (text.starts_with('v') || text.starts_with('V')) text.remove_prefix(1);
  const char *at = text.data(), *const end = at + text.size();
  while (count < numbers.size()) {
    const auto [next, error] = std::from_chars(at, end, numbers[count]);
    if (error == std::errc::result_out_of_range) return {};
    if (error != std::errc{}) break;
    ++count;
    at = next;
    if (at == end || *at != '.') break;
    ++at;
  }
  if (count < 2) return {};
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

CoeConfiguration::CoeConfiguration(MailboxClient& mailbox, bool dc, StationCounters& counters)
    : mailbox_(mailbox),
      sdo_(mailbox, counters),
      array_(sdo_),
      dc_(dc),
      rx_{rx_pdos(image::Layout::kFirmware9), rx_pdos(image::Layout::kFirmware11)},
      tx_{tx_pdos(image::Layout::kFirmware9), tx_pdos(image::Layout::kFirmware11)} {}

void CoeConfiguration::start(Time now) noexcept {
  begin();
  forget();
  safety_ = false;
  begin_step(Step::kDrain, now);
}

void CoeConfiguration::forget() noexcept {
  name_ = {};
  firmware_ = {};
}

AccessMachine& CoeConfiguration::active() noexcept {
  switch (step_) {
    case Step::kDrain:
      return mailbox_;
    case Step::kReadAssignment:
    case Step::kReadMapping:
      return array_;
    case Step::kName:
    case Step::kFirmware:
    case Step::kSafety:
    case Step::kAssign:
    case Step::kSyncType:
      break;
  }
  return sdo_;
}

void CoeConfiguration::tick(Time now) noexcept {
  if (!running()) return;
  active().tick(now);
  proceed(now);
}

void CoeConfiguration::answered(std::uint16_t working_counter, Bytes data, Time now) noexcept {
  if (!running()) return;
  active().answered(working_counter, data, now);
  proceed(now);
}

Time CoeConfiguration::next_event() const noexcept { return active().next_event(); }

void CoeConfiguration::proceed(Time now) noexcept {
  switch (active().outcome()) {
    case Outcome::kRunning:
      return;
    case Outcome::kFailed:
      if (!may_refuse()) return fail(active().trouble());
      return finish_step(now);
    case Outcome::kDone:
      return finish_step(now);
  }
}

// Things that a device need not have, or need not let us choose.
bool CoeConfiguration::may_refuse() const noexcept {
  if (!sdo_.abort()) return false;
  if (step_ == Step::kSafety) return *sdo_.abort() == static_cast<std::uint32_t>(SdoAbort::kNoObject);
  return step_ == Step::kName || step_ == Step::kFirmware || step_ == Step::kSyncType;
}

void CoeConfiguration::finish_step(Time now) noexcept {
  const bool refused = step_ != Step::kDrain && active().outcome() == Outcome::kFailed;
  switch (step_) {
    case Step::kDrain:
      return begin_step(Step::kName, now);
    case Step::kName:
      if (!refused) name_ = text_of(sdo_.value());
      return begin_step(Step::kFirmware, now);
    case Step::kFirmware:
      if (!refused) firmware_ = parse_firmware(text_of(sdo_.value()));
      return begin_step(Step::kSafety, now);
    case Step::kSafety:
      safety_ = !refused;
      return begin_step(Step::kAssign, now);
    case Step::kAssign:
      ++item_;
      return write_assignment(now);
    case Step::kReadAssignment:
      return assignment_read(now);
    case Step::kReadMapping:
      return mapping_read(now);
    case Step::kSyncType:
      ++item_;
      return write_sync_type(now);
  }
}

void CoeConfiguration::begin_step(Step step, Time now) noexcept {
  step_ = step;
  item_ = direction_ = 0;
  switch (step) {
    case Step::kDrain:
      return mailbox_.drain(now);
    case Step::kName:
      return sdo_.upload({kDeviceName, 0}, false, now);
    case Step::kFirmware:
      return sdo_.upload({kSoftwareVersion, 0}, false, now);
    case Step::kSafety:
      return sdo_.upload({kSafetyPdo, 0}, false, now);
    case Step::kAssign:
      return write_assignment(now);
    case Step::kReadAssignment:
    case Step::kReadMapping:
      return array_.read(kDirections[0].assignment, sizeof(std::uint16_t), now);
    case Step::kSyncType:
      return write_sync_type(now);
  }
}

std::span<const std::uint16_t> CoeConfiguration::wanted(std::size_t direction) const noexcept {
  return direction == 0 ? rx_assignment() : tx_assignment(safety_);
}

// Number of entries 0, then the entries, then their number (ETG.1020, 13.3).
void CoeConfiguration::write_assignment(Time now) noexcept {
  if (item_ == wanted(direction_).size() + 2) {
    item_ = 0;
    ++direction_;
  }
  if (direction_ == kDirections.size()) return begin_step(Step::kReadAssignment, now);
  const auto pdos = wanted(direction_);
  const std::uint16_t index = kDirections[direction_].assignment;
  if (item_ == 0 || item_ > pdos.size()) {
    const std::array count{static_cast<std::byte>(item_ == 0 ? 0 : pdos.size())};
    return sdo_.download({index, 0}, count, now);
  }
  const std::uint16_t pdo = pdos[item_ - 1];
  const std::array value{static_cast<std::byte>(pdo & 0xFF), static_cast<std::byte>(pdo >> 8)};
  sdo_.download({index, static_cast<std::uint8_t>(item_)}, value, now);
}

void CoeConfiguration::assignment_read(Time now) noexcept {
  const auto pdos = wanted(direction_);
  const auto entries = array_.entries();
  const unsigned index = kDirections[direction_].assignment;
  if (entries.size() != pdos.size()) {
    return fail(
        Predicate::format("keeps %zu PDOs in its assignment 0x%04X, %zu were written; restart it, and check its "
                          "firmware",
                          entries.size(), index, pdos.size()));
  }
  for (std::size_t i = 0; i < pdos.size(); ++i) {
    if (entries[i] == pdos[i]) continue;
    return fail(
        Predicate::format("keeps PDO 0x%04X in its assignment 0x%04X:%02zX where 0x%04X was written; restart it, "
                          "and check its firmware",
                          static_cast<unsigned>(entries[i]), index, i + 1, unsigned{pdos[i]}));
  }
  item_ = bits_ = 0;
  difference_ = {};
  step_ = Step::kReadMapping;
  array_.read(pdos[0], sizeof(MappingEntry), now);
}

std::uint32_t CoeConfiguration::expected_bits(std::size_t direction, std::size_t pdo) const noexcept {
  return (direction == 0 ? rx_ : tx_)[safety_ ? 1 : 0][pdo].bits();
}

void CoeConfiguration::mapping_read(Time now) noexcept {
  std::uint32_t bits = 0;
  for (const MappingEntry entry : array_.entries()) bits += bits_of(entry);
  const auto pdos = wanted(direction_);
  const std::uint32_t expected = expected_bits(direction_, item_);
  if (bits != expected && difference_.empty()) {
    difference_ = FixedText<64>::format("PDO 0x%04X has %u bits, %u expected", unsigned{pdos[item_]},
                                        static_cast<unsigned>(bits), static_cast<unsigned>(expected));
  }
  bits_ += bits;
  if (++item_ == pdos.size()) return direction_done(now);
  array_.read(pdos[item_], sizeof(MappingEntry), now);
}

// The whole must have the size of the image; where in between a gap is counted differs between firmwares.
void CoeConfiguration::direction_done(Time now) noexcept {
  const Direction& direction = kDirections[direction_];
  if (bits_ != direction.bits) {
    return fail(Predicate::format("maps %u bits of %s, %u expected (%.*s); this firmware is not known, report it",
                                  static_cast<unsigned>(bits_), direction.name, static_cast<unsigned>(direction.bits),
                                  static_cast<int>(difference_.view().size()), difference_.view().data()));
  }
  if (++direction_ == kDirections.size()) return begin_step(Step::kSyncType, now);
  step_ = Step::kReadAssignment;
  array_.read(kDirections[direction_].assignment, sizeof(std::uint16_t), now);
}

void CoeConfiguration::write_sync_type(Time now) noexcept {
  if (item_ == kSyncParameters.size()) return done();
  const std::uint16_t type = dc_ ? kDcSync0 : item_ == 0 ? kSmSynchronous : kSm2Synchronous;
  const std::array value{static_cast<std::byte>(type), std::byte{0}};
  sdo_.download({kSyncParameters[item_], kSyncType}, value, now);
}

}  // namespace meca::ethercat
