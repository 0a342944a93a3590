#include "transports/ethercat/chain_scan.hpp"

#include <algorithm>
#include <utility>

#include "transports/ethercat/registers.hpp"

namespace meca::ethercat {
namespace {

// So many answers in a row may be missing before the chain is looked through again from the start.
constexpr unsigned kMostFailures = 20;
// Service frames stay short, so that they do not stand in a cyclic one's way for long.
constexpr std::size_t kMostBytes = 640, kLargestRequest = 16;
// Logical addresses that another master gave a device, or we did before a restart, are another robot's now: it would
// take that one's outputs for its own. So the FMMUs of every new device are cleared first, also of those left alone.
constexpr std::uint16_t kAllFmmus = 8 * reg::kFmmuSize;

std::uint16_t u16(Bytes data) noexcept {
  wire::Reader in(data);
  return in.u16();
}

}  // namespace

ChainScan::ChainScan(Time sii_timeout) : probes_(kMostDevices, Probe{.sii = SiiReader(sii_timeout)}) {
  devices_.reserve(kMostDevices);
  next_devices_.reserve(kMostDevices);
}

void ChainScan::begin(Step step) noexcept {
  step_ = step;
  ++generation_;
  first_item_ = 0;
  for (Probe& probe : probes_) {
    probe.answered = probe.asked = false;
    probe.failures = 0;
  }
}

void ChainScan::start() noexcept { begin(Step::kCount); }

void ChainScan::stop() noexcept {
  begin(Step::kIdle);
  ended_ = false;
}

bool ChainScan::take_end() noexcept { return std::exchange(ended_, false); }

bool ChainScan::by_position() const noexcept {
  return step_ == Step::kCount || step_ == Step::kAddresses || step_ == Step::kAssign;
}

// kAddresses: positions. kOthers: devices of before. kAssign, kRead: devices as they are now.
std::size_t ChainScan::items() const noexcept {
  switch (step_) {
    case Step::kIdle:
      return 0;
    case Step::kCount:
      return 1;
    case Step::kAddresses:
      return count_;
    case Step::kOthers:
      return devices_.size();
    case Step::kAssign:
    case Step::kRead:
      return next_devices_.size();
  }
  return 0;
}

bool ChainScan::add_to(InFlight& frame, Time now) noexcept {
  const std::size_t all = items(), room = frame.room();
  bool added = false;
  for (std::size_t k = 0; k < all; ++k) {
    const std::size_t item = (first_item_ + k) % all;
    if (room - frame.room() > kMostBytes || frame.room() < kLargestRequest) {
      first_item_ = item;
      break;
    }
    if (!probes_[item].answered && !probes_[item].asked && add_item(frame, item, now)) added = true;
  }
  return added;
}

bool ChainScan::add_item(InFlight& frame, std::size_t item, Time now) noexcept {
  const Purpose purpose{Purpose::Kind::kScan, generation_, static_cast<std::uint16_t>(item)};
  const auto position = static_cast<std::uint16_t>(item);
  std::array<std::byte, 2> bytes{};
  Request request{Command::kBrd, address_of(0, reg::kType), 1, {}, purpose};
  switch (step_) {
    case Step::kIdle:
      return false;
    case Step::kCount:
      break;
    case Step::kAddresses:
      request = {Command::kAprd, address_of(auto_increment(position), reg::kStationAddress), 2, {}, purpose};
      break;
    case Step::kOthers:
      request = {Command::kFprd, address_of(devices_[item].address, reg::kStationAddress), 2, {}, purpose};
      break;
    case Step::kAssign: {
      const Device& device = next_devices_[item];
      bytes = {static_cast<std::byte>(device.address & 0xFF), static_cast<std::byte>(device.address >> 8)};
      request = {Command::kApwr, address_of(auto_increment(device.position), reg::kStationAddress), 2, bytes, purpose};
      break;
    }
    case Step::kRead:
      return add_reading(frame, item, now);
  }
  probes_[item].asked = frame.add(request);
  return probes_[item].asked;
}

bool ChainScan::add_reading(InFlight& frame, std::size_t item, Time now) noexcept {
  Probe& probe = probes_[item];
  Request request{.command = Command::kFprd,
                  .size = 2,
                  .purpose = {Purpose::Kind::kScan, generation_, static_cast<std::uint16_t>(item)}};
  std::uint16_t ado = 0;
  switch (probe.ask) {
    case Ask::kMapping:
      request.command = Command::kFpwr;
      request.size = kAllFmmus;
      ado = reg::kFmmu;
      break;
    case Ask::kFeatures:
      ado = reg::kFeatures;
      break;
    case Ask::kDlStatus:
      ado = reg::kDlStatus;
      break;
    case Ask::kAlias:
      ado = reg::kStationAlias;
      break;
    case Ask::kSii: {
      const auto access = probe.sii.next(now);
      if (!access) return false;
      request.command = access->write ? Command::kFpwr : Command::kFprd;
      request.size = access->size;
      request.data = access->data;
      ado = access->address;
      break;
    }
    case Ask::kDone:
      return false;
  }
  request.address = address_of(next_devices_[item].address, ado);
  probe.asked = frame.add(request);
  return probe.asked;
}

void ChainScan::tick(Time now) noexcept {
  if (step_ != Step::kRead) return;
  for (std::size_t i = 0; i < next_devices_.size(); ++i) {
    if (probes_[i].answered || probes_[i].ask != Ask::kSii) continue;
    probes_[i].sii.tick(now);
    sii_moved(i);
  }
  next_step(now);
}

void ChainScan::answered(const Purpose& purpose, std::uint16_t working_counter, Bytes data, Time now) noexcept {
  if (purpose.step != generation_ || purpose.of >= items()) return;
  Probe& probe = probes_[purpose.of];
  probe.asked = false;
  switch (step_) {
    case Step::kIdle:
      return;
    case Step::kCount:
      count_ = std::min<std::size_t>(working_counter, kMostDevices);
      probe.answered = true;
      break;
    case Step::kAddresses:
    case Step::kAssign:
      if (working_counter != 1) return start();  // the chain is not as long as it was counted
      probe.answered = true;
      if (step_ == Step::kAddresses) probe.address = u16(data);
      break;
    case Step::kOthers:
      probe.answered = true;
      probe.address = working_counter == 1 ? u16(data) : 0;
      break;
    case Step::kRead:
      answered_reading(purpose.of, working_counter, data, now);
      break;
  }
  next_step(now);
}

void ChainScan::lost(const Purpose& purpose, Time now) noexcept {
  if (purpose.step != generation_ || purpose.of >= items()) return;
  Probe& probe = probes_[purpose.of];
  probe.asked = false;
  if (step_ == Step::kRead && probe.ask == Ask::kSii) {
    probe.sii.lost(now);
    sii_moved(purpose.of);
    return next_step(now);
  }
  // Asked again, also where an address was written: the master stops the scan when the chain moves meanwhile.
  if (++probe.failures > kMostFailures) start();
}

void ChainScan::answered_reading(std::size_t item, std::uint16_t working_counter, Bytes data, Time now) noexcept {
  Probe& probe = probes_[item];
  Device& device = next_devices_[item];
  if (probe.ask == Ask::kSii) {
    probe.sii.answered(working_counter, data, now);
    return sii_moved(item);
  }
  if (working_counter != 1) {
    if (++probe.failures > kMostFailures) start();
    return;
  }
  probe.failures = 0;
  switch (probe.ask) {
    case Ask::kMapping:
      probe.ask = Ask::kFeatures;
      break;
    case Ask::kFeatures:
      device.features = u16(data);
      probe.ask = Ask::kAlias;
      break;
    case Ask::kAlias:
      device.alias = u16(data);
      probe.ask = Ask::kDlStatus;
      break;
    case Ask::kDlStatus:
      device.dl_status = u16(data);
      probe.ask = device.identified ? Ask::kDone : Ask::kSii;
      if (probe.ask == Ask::kSii) probe.sii.start(now);
      break;
    case Ask::kSii:
    case Ask::kDone:
      break;
  }
  probe.answered = probe.ask == Ask::kDone;
}

void ChainScan::sii_moved(std::size_t item) noexcept {
  Probe& probe = probes_[item];
  if (!probe.sii.done() && !probe.sii.failed()) return;
  Device& device = next_devices_[item];
  device.identified = probe.sii.done();
  if (device.identified)
    device.identity = probe.sii.identity();
  else
    device.trouble = probe.sii.trouble();
  probe.ask = Ask::kDone;
  probe.answered = true;
}

void ChainScan::next_step(Time now) noexcept {
  for (std::size_t i = 0; i < items(); ++i)
    if (!probes_[i].answered) return;
  switch (step_) {
    case Step::kIdle:
      return;
    case Step::kCount:
      begin(Step::kAddresses);
      break;
    case Step::kAddresses:
      recognise();
      // Who of the known ones was not met may be behind the break of a ring, where its address still reaches it.
      begin(Step::kOthers);
      for (std::size_t i = 0; i < devices_.size(); ++i) probes_[i].answered = taken(devices_[i].address);
      break;
    case Step::kOthers:
      take_others();
      give_addresses();
      begin(Step::kAssign);
      for (std::size_t i = 0; i < next_devices_.size(); ++i) probes_[i].answered = next_devices_[i].life != 0;
      break;
    case Step::kAssign:
      begin(Step::kRead);
      for (std::size_t i = 0; i < next_devices_.size(); ++i) {
        Device& device = next_devices_[i];
        probes_[i].ask = device.life == 0 ? Ask::kMapping : Ask::kDlStatus;
        if (device.life == 0) device.life = ++lives_;
      }
      break;
    case Step::kRead:
      std::swap(devices_, next_devices_);
      ended_ = true;
      return begin(Step::kIdle);
  }
  next_step(now);
}

bool ChainScan::taken(std::uint16_t address) const noexcept {
  return std::ranges::find(next_devices_, address, &Device::address) != next_devices_.end();
}

// Two devices with the same address of ours: the one that stands where it stood is meant.
void ChainScan::recognise() noexcept {
  next_devices_.clear();
  for (std::size_t position = 0; position < count_; ++position)
    next_devices_.push_back({.position = static_cast<std::uint16_t>(position)});
  for (const bool where_it_stood : {true, false}) {
    for (Device& next : next_devices_) {
      const std::uint16_t address = probes_[next.position].address;
      const auto known = std::ranges::find(devices_, address, &Device::address);
      if (next.life != 0 || known == devices_.end() || taken(address)) continue;
      if (where_it_stood && known->position != next.position) continue;
      const std::uint16_t position = next.position;
      next = *known;
      next.position = position;
    }
  }
}

void ChainScan::take_others() noexcept {
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    const Device& device = devices_[i];
    const bool free = std::ranges::find(next_devices_, device.position, &Device::position) == next_devices_.end();
    if (probes_[i].address == device.address && !taken(device.address) && free && next_devices_.size() < kMostDevices)
      next_devices_.push_back(device);
  }
  std::ranges::sort(next_devices_, {}, &Device::position);
}

void ChainScan::give_addresses() noexcept {
  std::uint16_t address = kFirstAddress;
  for (Device& device : next_devices_) {
    if (device.life != 0) continue;
    while (taken(address)) ++address;
    device.address = address;
  }
}

}  // namespace meca::ethercat
