// The simulated Meca500: a model stepped by time, without threads, clocks or I/O. It takes the decoded output image and
// answers with the input image of the robot manual (firmware 11.x, section 4), stricter than the real one.
#pragma once

#include <bit>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/equipment.hpp"
#include "sim/journal.hpp"
#include "transports/image/image.hpp"

namespace meca::sim {

enum class Product : std::uint8_t { kMeca500R3 = 3, kMeca500R4 = 4 };
enum class StopSeverity : std::uint8_t {
  kPause = 2,
  kClear = 3
};  // SetPStop2Cfg (not reachable over cyclic protocols)

// A stop signal is there, gone but not reset yet, or reset (manual 4.5.9).
enum class StopSignal : std::uint8_t { kReset, kPresent, kResettable };
struct StopSignals {
  StopSignal e_stop, p_stop2, connection_dropped, reboot;
};

struct RobotOptions {
  Product product = Product::kMeca500R4;
  image::Layout layout = image::Layout::kFirmware11;  // firmware generation the model behaves like
  std::uint16_t firmware_minor = 3, firmware_patch = 0, firmware_build = 1;
  std::uint32_t serial_number = 1;
  // Not published by the vendor; inferred defaults (spec 6.5).
  Time activation_time = std::chrono::seconds(2);
  Time homing_time = std::chrono::seconds(4);
  Time deactivation_time = std::chrono::milliseconds(500);
  Time boot_time = std::chrono::seconds(20);
  int echo_cycles = 0;       // steps until a MoveID is echoed; a real robot needs one or two (inferred)
  bool reboot_stop = false;  // R4: after every boot, the first too, the "Reboot" stop waits for the Reset button
  bool noise = true;         // plausible noise on actual values (seeded)
  std::uint64_t seed = 1;
  StopSeverity p_stop2_severity = StopSeverity::kClear;  // inferred: the default of the vendor's Python call
  ToolType tool = ToolType::kNone;                       // on the flange
  std::vector<Program> programs = example_programs();    // saved over TCP/IP before; kept by the robot
  std::vector<Variable> variables;                       // created over TCP/IP before; kept by the robot
  std::size_t journal_capacity = 4096;                   // commands the journal remembers
};

class Robot {
 public:
  // Throws std::invalid_argument with a sentence for a variable or a program number that no robot can have.
  explicit Robot(const RobotOptions& options = {});
  ~Robot();
  Robot(Robot&&) noexcept;
  Robot& operator=(Robot&&) noexcept;

  // One bus cycle: takes the outputs received in it and advances the model by `dt` (> 0). Does not allocate.
  void step(const image::Outputs& outputs, Time dt) noexcept;
  // The same from the bytes of the bus, which show reserved bits too.
  void step(const image::OutputBytes& outputs, std::endian byte_order, Time dt) noexcept;
  // No output image arrived in this cycle: the model only advances (velocity time-out runs).
  void step_without_outputs(Time dt) noexcept;

  const image::Inputs& inputs() const noexcept;  // as of the last step in which the robot was present
  // False while it boots, after RebootRobot or a power cycle: nobody answers on the bus.
  bool present() const noexcept;

  // What tests and users may do to a robot.
  void press_e_stop() noexcept;
  void release_e_stop() noexcept;
  void press_reset_button() noexcept;  // of the power supply (R4): resets an E-Stop that has been released
  void press_p_stop2() noexcept;
  void release_p_stop2() noexcept;
  void drop_connection() noexcept;  // the "connection dropped" safety stop
  void restore_connection() noexcept;
  // An outside force on a joint (1..6), as torque in percent of what its motor can give; it stays until changed.
  void push(int joint, double percent) noexcept;
  // A sphere in the base frame (mm) that the robot sees coming; radius 0 takes it away. It is watched with
  // SetCollisionCfg, as the arm's own links are.
  void place_obstacle(double x, double y, double z, double radius) noexcept;
  void raise_error(std::uint16_t code) noexcept;
  // Power fails and comes back at once: the robot is away for `boot_time`, then it is off, not homed, without error
  // (inferred: also without one that ResetError does not clear), its settings at their defaults and MoveID at 0. The
  // arm stays where it was; what the robot saves (configuration, variables, programs) is kept.
  void power_cycle() noexcept;
  // Puts a part of this width between the gripper's fingers, which close on it; 0 takes it away. False: no gripper, or
  // its fingers are not open wider than that.
  bool place_part(double width_mm) noexcept;
  void set_monitoring(bool monitoring) noexcept;  // this connection may only watch: outputs are ignored

  // What has been pressed, also where the image does not tell: the E-Stop of an R3, firmware 9.
  StopSignals stops() const noexcept;
  bool monitoring() const noexcept;

  // The referees: every command and what became of it, and every rule the host broke.
  const Journal& journal() const noexcept;
  const Log<Violation>& violations() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace meca::sim
