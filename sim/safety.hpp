// Safety stops of the Meca500: present, then ready to be reset, then reset (manual 4.5.9, spec 5.6).
#pragma once

#include <cstdint>

#include "sim/robot.hpp"
#include "transports/image/image.hpp"

namespace meca::sim {

class Safety {
 public:
  Safety(Product product, StopSeverity p_stop2_severity) noexcept
      : product_(product), p_stop2_severity_(p_stop2_severity) {}

  void press_e_stop() noexcept { e_stop_ = Stop::kPresent; }
  // On an R3 the E-Stop cuts all power and comes back without a word; an R4 waits for the Reset button.
  void release_e_stop() noexcept { release(e_stop_, product_ == Product::kMeca500R4); }
  void press_p_stop2() noexcept { p_stop2_ = Stop::kPresent; }
  void release_p_stop2() noexcept { release(p_stop2_, true); }
  void drop_connection() noexcept { connection_ = Stop::kPresent; }
  void restore_connection() noexcept { release(connection_, true); }
  // The Reset button on the power supply of an R4. inferred: it does nothing while the E-Stop is pressed.
  void press_reset_button() noexcept {
    if (e_stop_ != Stop::kPresent) e_stop_ = reboot_ = Stop::kReset;
  }
  // The robot comes up. What is pressed stays; inferred: what only waited for ResumeMotion is over. An R4 may wait for
  // the Reset button (spec 5.6, 128:7).
  void boot(bool reboot_stop) noexcept {
    reset_resettable();
    reboot_ = reboot_stop && product_ == Product::kMeca500R4 ? Stop::kResettable : Stop::kReset;
  }
  // ResumeMotion clears what it can (firmware 9: the ResetPStop2 bit).
  void reset_resettable() noexcept;

  StopSignals signals() const noexcept { return {e_stop_, p_stop2_, connection_, reboot_}; }
  bool motors_allowed() const noexcept { return e_stop_ == Stop::kReset && reboot_ == Stop::kReset; }
  bool present() const noexcept;        // any signal still there: ResumeMotion does nothing
  bool stops_motion() const noexcept;   // any signal not reset yet
  bool clears_motion() const noexcept;  // and no command is taken
  void report(image::Layout layout, image::Inputs& inputs) const noexcept;

 private:
  using Stop = StopSignal;
  static void release(Stop& stop, bool needs_reset) noexcept {
    if (stop == Stop::kPresent) stop = needs_reset ? Stop::kResettable : Stop::kReset;
  }

  Product product_;
  StopSeverity p_stop2_severity_;
  Stop e_stop_ = Stop::kReset, p_stop2_ = Stop::kReset, connection_ = Stop::kReset, reboot_ = Stop::kReset;
};

}  // namespace meca::sim
