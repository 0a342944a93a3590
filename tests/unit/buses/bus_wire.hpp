// What a test asks of a fieldbus that stands in place of the bench's direct link, whichever it is.
#pragma once

#include <cstdint>
#include <string>

#include "tests/unit/control/bench.hpp"
#include "transports/image/image.hpp"

namespace meca::test {

// Tables over them stand in this order. kBuiltin is the bench's direct link.
enum class Bus : std::uint8_t { kBuiltin, kEthernetIp, kEthercat };
inline constexpr std::array kAllBuses{Bus::kBuiltin, Bus::kEthernetIp, Bus::kEthercat};

inline std::string name_of(Bus bus) {
  constexpr std::array kNames{"builtin", "ethernet_ip", "ethercat"};
  return kNames[static_cast<std::size_t>(bus)];
}
inline std::string name_of(Layout layout) { return "firmware_" + std::to_string(9 + static_cast<int>(layout)); }

class BusWire {
 public:
  virtual ~BusWire() = default;
  BusWire(const BusWire&) = delete;
  BusWire& operator=(const BusWire&) = delete;

  // The last outputs that the robot's end took: what went over the wire, not what was meant to.
  virtual const image::OutputBytes& heard() const = 0;
  // As the robot's end sees it.
  virtual bool connected() const = 0;
  // Times that the robot's end was connected, over all lives of the bridge.
  virtual std::uint64_t connections() const = 0;
  // What both ends counted, for people.
  virtual std::string figures() const = 0;

 protected:
  BusWire() = default;
};

// Runs the bench for that long in the robot's time, whatever the cycle of the bus is.
inline void run(Bench& bench, std::chrono::nanoseconds time) {
  bench.steps(static_cast<int>(time / bench.settings.cycle));
}

}  // namespace meca::test
