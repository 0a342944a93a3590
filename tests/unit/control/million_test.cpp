// The long proof of the receipts on the built-in robot, in simulated time.
#include "tests/unit/control/million.hpp"

namespace meca::test {
namespace {

// MECA_COMMANDS=1000000 is ./meca prove million.
std::uint64_t commands() {
  const char* wanted = std::getenv("MECA_COMMANDS");
  return wanted ? std::strtoull(wanted, nullptr, 10) : 60000;
}

TEST(MillionCommands, executed_are_exactly_those_with_a_completed_receipt) {
  Million(Layout::kFirmware11, commands(), 1).play();
}
// Pauses, clears, errors and lost owners a dozen times as often.
TEST(MillionCommands, in_a_rough_life_are_told_as_exactly) {
  const bool every_pair = std::getenv("MECA_COMMANDS") != nullptr;  // else each seed on one firmware
  for (unsigned seed = 1; seed <= 3; ++seed) {
    for (const Layout layout : {Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11}) {
      if (!every_pair && seed != 1 + static_cast<unsigned>(layout)) continue;
      SCOPED_TRACE("seed " + std::to_string(seed) + ", firmware " + std::to_string(9 + static_cast<int>(layout)));
      Million(layout, commands() / 5 + 48000, seed, 12).play();
    }
  }
}
TEST(MillionCommands, executed_are_exactly_those_with_a_completed_receipt_on_firmware_10) {
  Million(Layout::kFirmware10, commands() / 5 + 48000, 2).play();
}
TEST(MillionCommands, executed_are_exactly_those_with_a_completed_receipt_on_firmware_9) {
  Million(Layout::kFirmware9, commands() / 5 + 48000, 3).play();
}

}  // namespace
}  // namespace meca::test
