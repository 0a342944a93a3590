// The command line of meca-sim.
#include "sim/meca_sim/arguments.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/unit/net/temporary_directory.hpp"

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

Arguments parse(std::vector<const char*> words) {
  words.insert(words.begin(), "meca-sim");
  return parse_arguments(static_cast<int>(words.size()), words.data());
}
std::string mistakes(std::vector<const char*> words) {
  const Arguments arguments = parse(std::move(words));
  if (!arguments.answer) return "(none)";
  EXPECT_EQ(arguments.answer->code, ExitCode::kArguments);
  return arguments.answer->text;
}

TEST(SimArguments, NoneAreNeeded) {
  const Arguments a = parse({});
  ASSERT_FALSE(a.answer);
  EXPECT_EQ(describe(a), "arm1: simulated Meca500 R4, firmware 11.3, serial number 1");
  EXPECT_EQ(a.bind, "127.0.0.1");
  EXPECT_EQ(a.adapter.identity.vendor_id, 1565);
  EXPECT_EQ(a.adapter.identity.device_type, 43);
  EXPECT_EQ(a.adapter.identity.product_code, 500);
  EXPECT_EQ(a.adapter.identity.major, 11);
  EXPECT_EQ(a.adapter.identity.minor, 3);
  EXPECT_EQ(a.on_loss, ConnectionLoss::kStop);
  EXPECT_TRUE(a.adapter.socket_items);
  EXPECT_FALSE(a.adapter.lenient_rpi);
}

TEST(SimArguments, AllAreTaken) {
  const Arguments a = parse({"--protocol",
                             "ethernet_ip",
                             "--bind",
                             "eth0",
                             "--name",
                             "arm2",
                             "--firmware",
                             "10.2",
                             "--product",
                             "R3",
                             "--serial",
                             "4711",
                             "--tool",
                             "MPM500",
                             "--key-policy",
                             "any-older",
                             "--ownership",
                             "keep",
                             "--on-connection-loss",
                             "continue",
                             "--lenient-rpi",
                             "--no-socket-items",
                             "--instant-homing",
                             "--no-noise",
                             "--seed",
                             "7",
                             "--control",
                             "off",
                             "--fault",
                             "late 50",
                             "--fault",
                             "api 20000",
                             "--for",
                             "1.5",
                             "--log-level",
                             "warn"});
  ASSERT_FALSE(a.answer) << a.answer->text;
  EXPECT_EQ(describe(a), "arm2: simulated Meca500 R3, firmware 10.2, serial number 4711");
  EXPECT_EQ(a.bind, "eth0");
  EXPECT_EQ(a.model.tool, ToolType::kMpm500);
  EXPECT_EQ(a.adapter.identity.serial_number, 4711u);
  EXPECT_EQ(a.adapter.key_policy, ethernet_ip::AdapterKeyPolicy::kCompatibleAnyOlder);
  EXPECT_EQ(a.adapter.ownership, ethernet_ip::OwnershipPolicy::kKeep);
  EXPECT_EQ(a.on_loss, ConnectionLoss::kContinue);
  EXPECT_TRUE(a.adapter.lenient_rpi);
  EXPECT_FALSE(a.adapter.socket_items);
  EXPECT_FALSE(a.model.noise);
  EXPECT_EQ(a.model.homing_time, 1ms);
  EXPECT_EQ(a.model.seed, 7u);
  EXPECT_EQ(a.control, "off");
  ASSERT_EQ(a.script.size(), 2u);
  EXPECT_EQ(a.script[1].words, "api 20000");
  EXPECT_EQ(a.script[1].at, 0s);
  EXPECT_EQ(a.run_for, 1500ms);
  EXPECT_EQ(a.log_level, "warn");
}

TEST(SimArguments, Firmware9HasTheRevisionOfItsEds) {
  const Arguments a = parse({"--firmware", "9.3"});
  EXPECT_EQ(a.model.layout, image::Layout::kFirmware9);
  EXPECT_EQ(a.model.firmware_minor, 3);
  EXPECT_EQ(a.adapter.identity.major, 2);
  EXPECT_EQ(a.adapter.identity.minor, 1);
}

TEST(SimArguments, MistakesAreSaidTogetherWithAGuess) {
  EXPECT_EQ(mistakes({"--protocol",
                      "ethernetip",
                      "--product",
                      "R5",
                      "--firmware",
                      "12.1",
                      "--serial",
                      "0",
                      "--tool",
                      "MEGP25",
                      "--key-policy",
                      "excat",
                      "--ownership",
                      "kep",
                      "--on-connection-loss",
                      "stopp",
                      "--seed",
                      "-1",
                      "--for",
                      "soon",
                      "--log-level",
                      "loud",
                      "--name",
                      "arm 1",
                      "--fault",
                      "unplgu",
                      "--faults",
                      "/nowhere/faults.txt"}),
            "meca-sim: --protocol: found 'ethernetip'; this version speaks ethernet_ip only; did you mean "
            "'ethernet_ip'?\n"
            "meca-sim: --name: found 'arm 1'; expected 1 to 32 letters, digits, '-' or '_'\n"
            "meca-sim: --firmware: found '12.1'; expected a version of the firmware from 9.0 to 11.x, e.g. 11.3\n"
            "meca-sim: --product: found 'R5'; expected one of R3, R4; did you mean 'R3'?\n"
            "meca-sim: --serial: found '0'; expected a number from 1 to 4294967295\n"
            "meca-sim: --tool: found 'MEGP25'; expected one of none, MEGP25E, MEGP25LS, MPM500; did you mean "
            "'MEGP25E'?\n"
            "meca-sim: --key-policy: found 'excat'; expected one of exact, same-major, any-older, off; did you mean "
            "'exact'?\n"
            "meca-sim: --ownership: found 'kep'; expected one of release, keep; did you mean 'keep'?\n"
            "meca-sim: --on-connection-loss: found 'stopp'; expected one of stop, continue; did you mean 'stop'?\n"
            "meca-sim: --seed: found '-1'; expected a whole number\n"
            "meca-sim: --log-level: found 'loud'; expected one of trace, debug, info, warn, error, off\n"
            "meca-sim: --for: found 'soon'; expected seconds, from 0 to a year of 31536000\n"
            "meca-sim: --fault: there is no word 'unplgu', did you mean 'unplug'?\n"
            "meca-sim: --faults: /nowhere/faults.txt cannot be read; name an existing file, e.g. config/faults.txt\n"
            "meca-sim --help shows the options and examples\n");
}

TEST(SimArguments, BusesOfLaterVersionsAreRefusedWithWhatThereIs) {
  EXPECT_THAT(mistakes({"--protocol", "ethercat"}), HasSubstr("'ethercat'; this version speaks ethernet_ip only\n"));
}

TEST(SimArguments, OptionsThatAreMistypedAreGuessed) {
  EXPECT_THAT(mistakes({"--instant-homin"}), HasSubstr("did you mean '--instant-homing'?\n"));
}

TEST(SimArguments, FirmwareIsAVersionOfThreeGenerations) {
  for (const char* bad : {"", "11", "11.", ".3", "8.4", "11.3.1", "11.x", "11.256"}) {
    EXPECT_THAT(mistakes({"--firmware", bad}), HasSubstr("expected a version of the firmware")) << bad;
  }
}

TEST(SimArguments, ScriptsActBehindTheFaultsOfTheBeginningAndTellTheirMistakes) {
  const test::TemporaryDirectory directory;
  const std::string path = directory / "faults.txt";
  std::ofstream(path) << "at 1s unplug\n";
  const Arguments good = parse({"--faults", path.c_str(), "--fault", "late 5"});
  ASSERT_EQ(good.script.size(), 2u);
  EXPECT_EQ(good.script[0].words, "late 5");
  EXPECT_EQ(good.script[1].words, "unplug");

  std::ofstream(path) << "at 1s unplgu\nfoo\n";
  EXPECT_EQ(mistakes({"--faults", path.c_str()}),
            path + ":1: there is no word 'unplgu', did you mean 'unplug'?\n" + path +
                ":2: found 'foo'; a line begins with 'at TIME' or 'after TIME', e.g. 'at 2.5s unplug'\n"
                "meca-sim --help shows the options and examples\n");
}

}  // namespace
}  // namespace meca::sim
