// Tells a person what becomes of a simulated robot's connection: what happens once, in sentences; the rest in numbers
// at the end.
#pragma once

#include <functional>
#include <string>

#include "sim/meca_sim/ethernet_ip_robot.hpp"

namespace meca::sim {

class Narrator {
 public:
  enum class Level : std::uint8_t { kInfo, kWarning };
  using Say = std::function<void(Level, const std::string&)>;

  Narrator(const EthernetIpRobot& robot, Say say) : robot_(robot), say_(std::move(say)) {}

  void look(Time now);  // often: says what has happened since the last look
  std::string summary() const;

 private:
  void look_at_connection();
  void look_at_refused_packets();
  void look_at_violations(Time now);

  const EthernetIpRobot& robot_;
  Say say_;
  ethernet_ip::AdapterCounters seen_;
  bool present_ = true;
  bool running_ = false;
  std::uint64_t violations_ = 0;
  Time quiet_until_{};  // violations come in crowds
};

}  // namespace meca::sim
