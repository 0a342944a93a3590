// What meca-sim tells of a robot on EtherCAT.
#pragma once

#include "sim/meca_sim/ethercat_robot.hpp"
#include "sim/meca_sim/narrator.hpp"

namespace meca::sim {

class EthercatNarrator final : public Narrator {
 public:
  EthercatNarrator(const EthercatRobot& robot, Say say) : Narrator(robot.robot(), std::move(say)), robot_(robot) {}

 private:
  void look_at_connection() override;
  std::string connection_summary() const override;

  const EthercatRobot& robot_;
  std::uint16_t al_status_ = static_cast<std::uint16_t>(ethercat::AlState::kInit);
  std::uint64_t operational_ = 0, aborts_ = 0, strict_ = 0;
};

}  // namespace meca::sim
