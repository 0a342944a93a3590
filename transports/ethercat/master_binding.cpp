// Which device of the chain is which robot, and what to say of those that are none.
#include <algorithm>
#include <iterator>

#include "transports/ethercat/master_state.hpp"

namespace meca::ethercat {
namespace {

using Text = transports::LinkDetail;

constexpr std::uint32_t kMcs500Product = 0x04DC5500;

const char* product_name(std::uint32_t vendor, std::uint32_t product) noexcept {
  if (vendor != kMecademicVendor) return "";
  return product == kMeca500Product ? " (Meca500)" : product == kMcs500Product ? " (MCS500)" : " (Mecademic)";
}

bool is_meca500(const SiiIdentity& identity) noexcept {
  return identity.vendor == kMecademicVendor && identity.product == kMeca500Product;
}

// In a ring there may be devices behind it.
Text not_there(unsigned position, std::span<const ChainScan::Device> devices) noexcept {
  const char* const answer = devices.size() == 1 ? "device answers" : "devices answer";
  if (devices.empty())
    return Text::format("position %u is not there: no device answers; check cable and power", position);
  const auto behind = std::ranges::lower_bound(devices, position, {}, &ChainScan::Device::position);
  if (behind == devices.begin())
    return Text::format("position %u is not there: %zu %s; check its power and the cable to it", position,
                        devices.size(), answer);
  return Text::format("position %u is not there: %zu %s; check cable and power behind position %u", position,
                      devices.size(), answer, unsigned{std::prev(behind)->position});
}

// The alias is one of the words that the checksum is for.
bool is_believed(const ChainScan::Device& device) noexcept {
  return device.identified && is_meca500(device.identity) && device.identity.checksum_right;
}

Text no_such_alias(unsigned alias, std::span<const ChainScan::Device> devices) noexcept {
  const char* const answer = devices.size() == 1 ? "device answers" : "devices answer";
  const auto doubtful = std::ranges::find_if(devices, [](const ChainScan::Device& device) {
    return device.identified && is_meca500(device.identity) && !device.identity.checksum_right;
  });
  if (doubtful != devices.end())
    return Text::format(
        "no robot with alias %u is there: %zu %s, and the checksum of the SII at position %u is wrong, so that its "
        "alias "
        "is not believed; write that SII anew, or name its position",
        alias, devices.size(), answer, unsigned{doubtful->position});
  return Text::format("no robot with alias %u is there: %zu %s; check cable and power, and the alias in its SII", alias,
                      devices.size(), answer);
}

}  // namespace

const ChainScan::Device* MasterState::device_of(const Robot& robot, Text& why) const noexcept {
  const auto devices = scan.devices();
  const auto alias_of = [](const ChainScan::Device& device) {
    return is_believed(device) ? device.identity.alias : std::uint16_t{0};
  };
  if (robot.place.alias) {
    const unsigned alias = *robot.place.alias;
    const ChainScan::Device* found = nullptr;
    for (const ChainScan::Device& device : devices) {
      if (alias_of(device) != alias) continue;
      if (found != nullptr) {
        why = Text::format("alias %u is there twice, at positions %u and %u; give each robot its own", alias,
                           unsigned{found->position}, unsigned{device.position});
        return nullptr;
      }
      found = &device;
    }
    if (found == nullptr) why = no_such_alias(alias, devices);
    return found;
  }
  const unsigned position = robot.place.position;
  const auto at = std::ranges::find(devices, robot.place.position, &ChainScan::Device::position);
  if (at == devices.end()) {
    why = not_there(position, devices);
    return nullptr;
  }
  const SiiIdentity& id = at->identity;
  if (!at->identified) {
    const auto trouble = at->trouble.view();
    why = Text::format("position %u does not say who it is: %.*s", position, static_cast<int>(trouble.size()),
                       trouble.data());
    return nullptr;
  }
  if (!is_meca500(id)) {
    why = Text::format(
        "position %u is vendor 0x%08X, product 0x%08X%s, not a Meca500 (vendor 0x%08X, product 0x%08X): "
        "it is left alone; check the order of the cables and the positions in the configuration",
        position, id.vendor, id.product, product_name(id.vendor, id.product), kMecademicVendor, kMeca500Product);
    return nullptr;
  }
  const auto wanted_by = std::ranges::find_if(
      robots, [&](const Robot& other) { return other.place.alias && *other.place.alias == id.alias; });
  if (wanted_by != robots.end()) {
    why = Text::format("position %u is the robot with alias %u, which is another one in the configuration", position,
                       unsigned{id.alias});
    return nullptr;
  }
  return &*at;
}

void MasterState::bind(Robot& robot, Time now) noexcept {
  Text why;
  const ChainScan::Device* const device = device_of(robot, why);
  if (device != nullptr && device->life == robot.life) return;  // it runs on as if nothing had been
  if (robot.life != 0 || device == nullptr)
    robot.station.absent(device == nullptr ? why.view() : "it was switched off and on, or exchanged", now);
  robot.trouble = why;
  robot.life = 0;
  robot.misses = robot.silent = 0;
  robot.errors.clear = false;
  ++robot.generation;
  if (device == nullptr) return;
  robot.life = device->life;
  robot.cannot_lrw = (device->features & kFeatureNoLrw) != 0;
  if (settings.dc && (device->features & kFeatureDc) == 0)
    robot.trouble = Text::format("position %u has no distributed clock; set dc: false", unsigned{device->position});
  robot.al_due = true;
  robot.next_errors = now;
  robot.station.found(device->address, device->identity, now);
}

void MasterState::bind(Time now) noexcept {
  for (Robot& robot : robots) bind(robot, now);
  if (settings.dc) clocks.start(scan.devices());
}

}  // namespace meca::ethercat
