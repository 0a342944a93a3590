#include "transports/ethercat/scan.hpp"

#include <algorithm>

namespace meca::ethercat {
namespace {

constexpr Time kAgain = std::chrono::milliseconds(1);  // the reader waits for a slow SII
constexpr std::byte kSiiOfTheDevice{1};                // to 0500h
constexpr std::size_t kSourceAt = 6;                   // of the Ethernet header

// What is read of every device, in one frame.
struct Area {
  std::uint16_t address, size;
};
enum : std::size_t { kInformation, kAddresses, kDlStatus, kAlStatus, kErrors, kSii, kProcessData, kAreas };
constexpr std::array<Area, kAreas> kWanted{{
    {reg::kType, 10},
    {reg::kStationAddress, 4},
    {reg::kDlStatus, 2},
    {reg::kAlStatus, 6},
    {reg::kRxErrors, reg::kErrorCountersSize},
    {reg::kSiiOwner, 2},
    {reg::sync_manager(2), 2 * reg::kSyncManagerSize},
}};

std::uint8_t u8(Bytes data, std::size_t at) noexcept { return std::to_integer<std::uint8_t>(data[at]); }
std::uint16_t u16(Bytes data, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(u8(data, at) | u8(data, at + 1) << 8);
}

DcSupport dc_of(std::uint16_t features) noexcept {
  if ((features & kFeatureDc) == 0) return DcSupport::kNone;
  return (features & kFeatureDc64) != 0 ? DcSupport::k64Bit : DcSupport::k32Bit;
}

// DL status: bit 4 + p link, 8 + 2p loop closed, 9 + 2p communication. Port descriptor: two bits a port, 0 and 1 mean
// that there is none.
void read_ports(ScannedDevice& device, std::uint8_t descriptor, std::uint16_t dl_status, Bytes errors) noexcept {
  for (unsigned p = 0; p < device.ports.size(); ++p) {
    ScannedPort& port = device.ports[p];
    port.exists = (descriptor >> 2 * p & 3) >= 2;
    port.link = (dl_status >> (4 + p) & 1) != 0;
    port.loop_closed = (dl_status >> (8 + 2 * p) & 1) != 0;
    port.communication = (dl_status >> (9 + 2 * p) & 1) != 0;
    port.invalid_frames = u8(errors, 2 * p);
    port.rx_errors = u8(errors, 2 * p + 1);
    port.forwarded_errors = u8(errors, reg::kForwardedErrors - reg::kRxErrors + p);
    port.lost_links = u8(errors, reg::kLostLinks - reg::kRxErrors + p);
  }
  device.processing_errors = u8(errors, reg::kProcessingErrors - reg::kRxErrors);
  device.pdi_errors = u8(errors, reg::kPdiErrors - reg::kRxErrors);
}

// Start, length and "enabled" of both; the control byte may differ between masters.
bool are_of_meca500(Bytes sync_managers_2_and_3) noexcept {
  for (unsigned n = 2; n < 4; ++n) {
    const Bytes sm = sync_managers_2_and_3.subspan((n - 2) * reg::kSyncManagerSize, reg::kSyncManagerSize);
    if (u16(sm, 0) != kSyncManagers[n].start || u16(sm, 2) != kSyncManagers[n].length || (u8(sm, 6) & 1) == 0) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool is_meca500(const SiiIdentity& identity) noexcept {
  return identity.vendor == kMecademicVendor && identity.product == kMeca500Product;
}

bool runs_under_a_master(const ScannedDevice& device) noexcept {
  const auto state = static_cast<AlState>(device.al_status & kAlStateMask);
  return state == AlState::kSafeop || state == AlState::kOp;
}

Scan::Scan(const ScanSettings& settings, Time now) : settings_(settings), patience_ends_(now + settings.patience) {}

Time Scan::next_event() const noexcept {
  if (done()) return Time::max();
  return flight_ends_;
}

void Scan::tick(Time now) {
  if (done()) return;
  if (!in_flight_.empty() && now >= flight_ends_) give_up_frame(now);
  if (reader_) {
    reader_->tick(now);
    follow_reader();
  }
}

Bytes Scan::next_frame(Time now) {
  if (done() || !in_flight_.empty()) return {};
  FrameWriter frame(buffer_, settings_.source);
  ++index_;
  const std::uint16_t adp = auto_increment(static_cast<std::uint16_t>(current_));
  switch (step_) {
    case Step::kCounting:
      frame.add(Command::kBrd, index_, address_of(0, reg::kType), 1);
      break;
    case Step::kRegisters:
      for (const Area& area : kWanted) frame.add(Command::kAprd, index_, address_of(adp, area.address), area.size);
      break;
    case Step::kIdentity:
      if (const auto access = next_access(now)) {
        const auto data = frame.add(access->write ? Command::kApwr : Command::kAprd, index_,
                                    address_of(adp, access->address), access->size);
        if (access->write) std::ranges::copy(access->data, data.begin());
      }
      break;
    case Step::kGivingBack:
      frame.add(Command::kApwr, index_, address_of(adp, reg::kSiiOwner), 1)[0] = kSiiOfTheDevice;
      break;
    case Step::kDone:
      break;
  }
  in_flight_ = frame.finish();
  flight_ends_ = now + (in_flight_.empty() ? kAgain : settings_.frame_timeout);
  return in_flight_;
}

bool Scan::received(Bytes frame, Time now) {
  DatagramWalk walk(frame);
  if (!walk.next()) return false;
  MacAddress source;
  std::ranges::copy(frame.subspan(kSourceAt, source.size()), source.begin());
  source[0] &= ~kReplyBit;
  if (source != settings_.source) {
    ++frames_of_others_;
    return false;
  }
  if (in_flight_.empty() || !is_answer(frame)) return false;
  // Not by the reply bit: public simulators do not set it. But even who is not addressed adds one to ADP.
  if (std::ranges::equal(frame.first(std::min(frame.size(), in_flight_.size())), in_flight_)) {
    ++echoes_;
    return false;
  }
  in_flight_ = {};
  take(frame, now);
  return true;
}

// ADP is another one in the answer: every device adds one.
bool Scan::is_answer(Bytes frame) const {
  DatagramWalk sent(in_flight_), back(frame);
  while (const auto a = sent.next()) {
    const auto b = back.next();
    if (!b || a->raw_command() != b->raw_command() || a->index() != b->index() || a->ado() != b->ado() ||
        a->data().size() != b->data().size()) {
      return false;
    }
  }
  return true;
}

void Scan::take(Bytes frame, Time now) {
  lost_ = 0;
  switch (step_) {
    case Step::kCounting: {
      devices_.resize(DatagramWalk(frame).next()->working_counter());
      for (std::size_t i = 0; i < devices_.size(); ++i) devices_[i].position = static_cast<std::uint16_t>(i);
      step_ = devices_.empty() ? Step::kDone : Step::kRegisters;
      break;
    }
    case Step::kRegisters:
      take_registers(frame, now);
      break;
    case Step::kIdentity: {
      const auto datagram = *DatagramWalk(frame).next();
      reader_->answered(datagram.working_counter(), datagram.data(), now);
      follow_reader();
      break;
    }
    case Step::kGivingBack:
      next_device();
      break;
    case Step::kDone:
      break;
  }
}

void Scan::take_registers(Bytes frame, Time now) {
  std::array<Bytes, kAreas> data;
  DatagramWalk walk(frame);
  for (Bytes& area : data) {
    const auto datagram = *walk.next();
    // Every area is there in every ESC, but for the counters and sync managers of small ones: those read as zeros.
    if (&area == data.data() && datagram.working_counter() != 1) return next_device();
    area = datagram.data();
  }
  ScannedDevice& device = devices_[current_];
  device.answered = true;
  device.dc = dc_of(u16(data[kInformation], reg::kFeatures));
  device.station_address = u16(data[kAddresses], 0);
  device.alias = u16(data[kAddresses], 2);
  device.al_status = u16(data[kAlStatus], 0);
  device.al_code = u16(data[kAlStatus], reg::kAlStatusCode - reg::kAlStatus);
  device.sii_with_device = (u8(data[kSii], 0) & 1) != 0;
  device.process_data_of_meca500 = are_of_meca500(data[kProcessData]);
  read_ports(device, u8(data[kInformation], reg::kPortDescriptor), u16(data[kDlStatus], 0), data[kErrors]);
  const bool device_reads_it = (u8(data[kSii], 1) & 1) != 0;
  const bool in_init = static_cast<AlState>(device.al_status & kAlStateMask) == AlState::kInit;
  if (device.sii_with_device && (device_reads_it || !in_init)) {
    device.identity_trouble = "its SII belongs to the device while a master works with it, and is left alone";
    return next_device();
  }
  begin_identity(now);
}

void Scan::begin_identity(Time now) {
  step_ = Step::kIdentity;
  reader_.emplace();
  reader_->start(now);
}

// The reader takes the SII from the device and gives it back. Where it is with the master it stays there: what the
// reader writes to change that is not sent.
std::optional<Access> Scan::next_access(Time now) {
  auto access = reader_->next(now);
  while (access && access->write && access->address == reg::kSiiOwner && !devices_[current_].sii_with_device) {
    reader_->answered(1, {}, now);
    follow_reader();
    if (!reader_) return std::nullopt;
    access = reader_->next(now);
  }
  return access;
}

void Scan::follow_reader() {
  const bool failed = reader_->failed();
  if (!failed && !reader_->done()) return;
  ScannedDevice& device = devices_[current_];
  if (failed) {
    device.identity_trouble = reader_->trouble();
  } else {
    device.identity = reader_->identity();
  }
  reader_.reset();
  in_flight_ = {};
  if (failed && device.sii_with_device) {
    step_ = Step::kGivingBack;
  } else {
    next_device();
  }
}

void Scan::next_device() {
  lost_ = 0;
  ++current_;
  step_ = current_ < devices_.size() ? Step::kRegisters : Step::kDone;
}

void Scan::give_up_frame(Time now) {
  in_flight_ = {};
  if (step_ == Step::kCounting) {
    if (now >= patience_ends_) step_ = Step::kDone;
  } else if (step_ == Step::kIdentity) {
    reader_->lost(now);
  } else if (++lost_ >= kTries) {
    next_device();
  }
}

}  // namespace meca::ethercat
