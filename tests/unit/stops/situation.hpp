// One row of the table: how a robot comes to stand still, what a person must read then, and what the words of the
// remedy mean for hands in the cell. Commands in the remedy need no row: they are typed as they stand in the text.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "tests/unit/stops/cell.hpp"

namespace meca::test {

struct Deed {
  std::string words;                // of the remedy
  std::function<void(Cell&)> done;  // by hands
};

struct Situation {
  std::string name;                  // of the test
  std::function<void(Cell&)> enter;  // from a bridge that has just started
  std::string cause;                 // what the line "Ready" begins with, behind "no: "
  std::string remedy;                // what follows
  std::vector<Deed> deeds = {};
  sim::RobotOptions robot = {};
  CycleSettings settings = {};
  bool owner_lets_go = false;  // "let it release control first", rather than "command from there"
};
inline std::ostream& operator<<(std::ostream& out, const Situation& s) { return out << s.name; }

// Quick where a robot takes its time.
inline sim::RobotOptions robot(image::Layout layout = image::Layout::kFirmware11,
                               sim::Product product = sim::Product::kMeca500R4) {
  sim::RobotOptions o;
  o.layout = layout;
  o.product = product;
  o.activation_time = 200ms;
  o.homing_time = 300ms;
  o.deactivation_time = 100ms;
  o.noise = false;
  return o;
}

std::vector<Situation> safety_situations();
std::vector<Situation> error_situations();
std::vector<Situation> motion_situations();
std::vector<Situation> link_situations();
std::vector<Situation> watch_situations();

}  // namespace meca::test
