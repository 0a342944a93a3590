// The command line of meca-sim.
#include "sim/meca_sim/arguments.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/unit/net/temporary_directory.hpp"

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
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
            "meca-sim: --protocol: found 'ethernetip'; expected one of ethernet_ip, ethercat; did you mean "
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
  EXPECT_THAT(mistakes({"--protocol", "profinet"}), HasSubstr("'profinet'; expected one of ethernet_ip, ethercat\n"));
}

TEST(SimArguments, OfEthercatAreTaken) {
  const Arguments a = parse({"--protocol",
                             "ethercat",
                             "--interface",
                             "eth1",
                             "--redundant-interface",
                             "eth2",
                             "--count",
                             "3",
                             "--alias",
                             "100",
                             "--firmware",
                             "9.3",
                             "--serial",
                             "4711",
                             "--seed",
                             "7",
                             "--foreign",
                             "arm2",
                             "--reply-delay",
                             "2.5",
                             "--clock-ppm",
                             "20",
                             "--no-lrw",
                             "--old-sync-manager-types"});
  ASSERT_FALSE(a.answer) << a.answer->text;
  EXPECT_EQ(a.bus, Fieldbus::kEthercat);
  EXPECT_EQ(a.interface, "eth1");
  EXPECT_EQ(a.redundant_interface, "eth2");
  EXPECT_THAT(a.names, ElementsAre("arm1", "arm2", "arm3"));
  EXPECT_EQ(describe(a, 2), "arm3: simulated Meca500 R4, firmware 9.3, serial number 4713");
  EXPECT_EQ(model_of(a, 2).seed, 9u);

  const ethercat::DeviceSettings last = device_of(a, 2);
  EXPECT_EQ(last.layout, image::Layout::kFirmware9);
  EXPECT_EQ(last.firmware, "9.3.0.1");
  EXPECT_EQ(last.alias, 102);
  EXPECT_EQ(last.serial, 4713u);
  EXPECT_EQ(last.product, ethercat::kMeca500Product);
  EXPECT_EQ(last.mailbox_reply, 2500us);
  EXPECT_EQ(last.esc.clock_ppm, 20);
  EXPECT_NE(last.esc.features & ethercat::kFeatureNoLrw, 0);
  EXPECT_TRUE(last.old_sync_manager_types);

  const ethercat::DeviceSettings middle = device_of(a, 1);
  EXPECT_EQ(middle.esc.clock_ppm, -20);
  EXPECT_NE(middle.esc.clock_start, last.esc.clock_start);
  EXPECT_THAT(a.foreign, ElementsAre("arm2"));
}

TEST(SimArguments, WithoutAnAliasNoRobotHasOne) {
  const Arguments a = parse({"--protocol", "ethercat", "--interface", "eth1", "--count", "2"});
  EXPECT_EQ(device_of(a, 1).alias, 0);
}

TEST(SimArguments, SeveralRobotsCountOnFromTheirName) {
  const auto names = [](const char* name) {
    return parse({"--protocol", "ethercat", "--interface", "eth1", "--count", "2", "--name", name}).names;
  };
  EXPECT_THAT(names("arm9"), ElementsAre("arm9", "arm10"));
  EXPECT_THAT(names("left"), ElementsAre("left1", "left2"));
  EXPECT_THAT(names("7"), ElementsAre("7", "8"));
  EXPECT_THAT(parse({"--name", "left"}).names, ElementsAre("left"));
}

TEST(SimArguments, MistakesOfEthercatAreSaidTogether) {
  EXPECT_EQ(mistakes({"--protocol", "ethercat", "--count", "33", "--alias", "65536", "--foreign", "arm7",
                      "--reply-delay", "soon", "--clock-ppm", "2000"}),
            "meca-sim: --interface is missing: the network interface that the master's cable is in, e.g. --interface "
            "eth1\n"
            "meca-sim: --count: found '33'; expected a number from 1 to 32\n"
            "meca-sim: --alias: found '65536'; expected a number from 0 to 65535\n"
            "meca-sim: --foreign: there is no robot 'arm7'; the first is arm1, the last arm1\n"
            "meca-sim: --reply-delay: found 'soon'; expected milliseconds from 0 to 60000\n"
            "meca-sim: --clock-ppm: found '2000'; expected a number from -1000 to 1000\n"
            "meca-sim --help shows the options and examples\n");
  EXPECT_THAT(mistakes({"--protocol", "ethercat", "--interface", "eth1", "--redundant-interface", "eth1"}),
              HasSubstr("--redundant-interface: found 'eth1', which is --interface already; a ring has two ends\n"));
  EXPECT_THAT(mistakes({"--protocol", "ethercat", "--interface", "eth1", "--count", "4", "--alias", "65533"}),
              HasSubstr("--alias: found '65533'; expected a number from 0 to 65532\n"));
}

TEST(SimArguments, OptionsOfTheOtherBusAreRefused) {
  EXPECT_EQ(mistakes({"--protocol", "ethercat", "--interface", "eth1", "--bind", "eth1", "--lenient-rpi"}),
            "meca-sim: --bind is an option of --protocol ethernet_ip, and this is ethercat\n"
            "meca-sim: --lenient-rpi is an option of --protocol ethernet_ip, and this is ethercat\n"
            "meca-sim --help shows the options and examples\n");
  EXPECT_EQ(mistakes({"--interface", "eth1", "--count", "2"}),
            "meca-sim: --interface is an option of --protocol ethercat, and this is ethernet_ip\n"
            "meca-sim: --count is an option of --protocol ethercat, and this is ethernet_ip\n"
            "meca-sim --help shows the options and examples\n");
}

TEST(SimArguments, FaultsOfTheOtherBusOrOfNobodyAreRefused) {
  EXPECT_EQ(
      mistakes({"--fault", "cut", "--fault", "arm2: unplug"}),
      "meca-sim: --fault: 'cut': that is a word for EtherCAT, and this robot is on EtherNet/IP; 'help' says which "
      "words are for it\n"
      "meca-sim: --fault: there is no robot 'arm2'; there is arm1\n"
      "meca-sim --help shows the options and examples\n");
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
