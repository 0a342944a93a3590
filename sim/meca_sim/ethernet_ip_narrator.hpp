// What meca-sim tells of a robot on EtherNet/IP.
#pragma once

#include "sim/meca_sim/ethernet_ip_robot.hpp"
#include "sim/meca_sim/narrator.hpp"

namespace meca::sim {

class EthernetIpNarrator final : public Narrator {
 public:
  EthernetIpNarrator(const EthernetIpRobot& robot, Say say) : Narrator(robot.robot(), std::move(say)), robot_(robot) {}

 private:
  void look_at_connection() override;
  void look_at_host();
  void look_at_refused_packets();
  std::string connection_summary() const override;

  const EthernetIpRobot& robot_;
  ethernet_ip::AdapterCounters seen_;
  bool running_ = false;
};

}  // namespace meca::sim
