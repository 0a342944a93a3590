// The promise about an owner that is gone, put to the proof with processes that die.
//
// Promise: the stop image (PauseMotion, SetPoint 0, no velocity) is on the wire within lease + 2 cycles, and nothing
// moves the robot after it before a client resumes it and sends a fresh command.
//
// Measured, in cycles of the bridge: (cycle whose exchange gives the first stop image to the robot) - (cycle that took
// the owner's last sign of life). The first is the cycle after the one whose MotionControl and MotionCommand samples
// show the stop; the second is ControlStatus.last_renewal_ns of the loss, which is the stamp of a cycle, so both are
// exact and not bounds. That the bridge does not take for a sign of life what is none is seen from outside: the owner
// stamps each one before it sends it, in memory that outlives it. The wall clock from that stamp to the cycle that
// sends the stop image is an upper bound (transport to the bridge and the wait for its next cycle included; a renewal
// that was sent but not yet stamped as sent counts as not sent), and its median is judged.
//
// Noise of the machine: a cycle that the bridge could not run has no number, so it makes the count smaller and never
// larger. So that this hides nothing, time is judged beside it, by the bridge's own stamps: no cycle that ran later
// than the lease allows was without the stop. The stamp of the wall clock and the one that decides are not read in the
// same instant; a cycle is allowed for that. Wall-clock figures include missed cycles and are reported for what they
// are.
#pragma once

#include "tests/bench/proof.hpp"
#include "tests/bench/scenarios.hpp"

namespace meca::bench {

// `deaths`: by SIGKILL, by SIGSTOP and by a hung application in turn; of owners with queued motion and owners with a
// velocity stream in turn.
Proof prove_deaths(const Setting& setting, int deaths);

}  // namespace meca::bench
