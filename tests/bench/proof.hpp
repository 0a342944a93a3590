// A promise put to the proof: figures for people, and what was broken of it.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace meca::bench {

struct Proof {
  nlohmann::ordered_json figures;
  std::vector<std::string> broken;  // sentences; empty: the promise held
  std::string not_told;             // why this machine, in this run, could not tell; empty: it could

  void expect(bool holds, const std::string& sentence) {
    if (!holds) broken.push_back(sentence);
  }
};

}  // namespace meca::bench
