// The promise of one owner at a time, put to the proof: eight processes fight for one robot.
#pragma once

#include "tests/bench/proof.hpp"
#include "tests/bench/scenarios.hpp"

namespace meca::bench {

// For setting.duration. Two of the fighters have a priority. What is judged: fight_judge.hpp.
Proof prove_fight(const Setting& setting);

}  // namespace meca::bench
