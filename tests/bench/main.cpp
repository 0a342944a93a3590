// meca-bench: speed as ratios, measured in one run beside raw Fast DDS and bare system calls; and promises about
// control, put to the proof with real processes.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "tests/bench/bare_ethernet.hpp"
#include "tests/bench/deaths.hpp"
#include "tests/bench/eip_cell.hpp"
#include "tests/bench/eip_scenarios.hpp"
#include "tests/bench/ethercat_scenarios.hpp"
#include "tests/bench/fight.hpp"
#include "tests/bench/fighter.hpp"
#include "tests/bench/owner.hpp"
#include "tests/bench/process.hpp"
#include "tests/bench/proof.hpp"
#include "tests/bench/raw_dds.hpp"
#include "tests/bench/readers.hpp"
#include "tests/bench/scenarios.hpp"
#include "tests/bench/table.hpp"
#include "tests/bench/throughput.hpp"

using namespace meca::bench;

constexpr int kBroken = 1, kNotTold = 3;

int main(int argc, char** argv) try {
  Setting setting;
  setting.bridge = std::filesystem::path(own_path()).parent_path() / "meca-bridge";
  long seconds = 10;
  std::string json_file;
  RawWriterOptions raw;
  raw.whole_image = false;

  CLI::App app{
      "Measures the bridge beside raw Fast DDS and bare system calls, in one run; proves promises (deaths, fight,\n"
      "throughput, ethercat-throughput), then the exit code is 1 for a broken one and 3 when the machine was too busy\n"
      "to tell or does not permit what it takes. ethercat-*: on a virtual cable in a network of its own, as root "
      "(then\n"
      "with real-time priority on both sides) or in a user namespace.\n"
      "Read the ratios: absolute figures belong to this machine and this moment."};
  app.require_subcommand(1);
  app.fallthrough();
  app.add_option("--seconds", seconds,
                 "Length of each measurement; unless given, two minutes of a fight and one of ethercat-period")
      ->check(CLI::Range(3, 600))
      ->capture_default_str();
  app.add_option("--domain", setting.domain, "DDS domain")->capture_default_str();
  app.add_option("--json", json_file, "Also write the figures to this file");

  nlohmann::ordered_json figures;
  std::vector<std::string> broken, not_told;
  const auto scenario = [&](const char* name, const char* about, auto measure, long usual_seconds = 10) {
    app.add_subcommand(name, about)->callback([&, name, measure, usual_seconds] {
      setting.duration = std::chrono::seconds(app.count("--seconds") == 0 ? usual_seconds : seconds);
      std::fprintf(stderr, "%s ...\n", name);
      try {
        figures[name] = measure(setting);
      } catch (const NotTold& why) {
        not_told.push_back(why.what());
      }
    });
  };
  scenario("latency", "Robot image -> sample in another process", measure_latency);
  scenario("cpu", "CPU per robot at 1 kHz for 1, 4, 16, 64 robots", measure_cpu);
  scenario("wakeup", "Lateness of the cycle thread", measure_wakeup);
  scenario("stopped-reader", "Missed cycles of four robots with a stopped reliable reader", measure_stopped_reader);
  scenario("ethernet-ip-period", "How regular O->T is on the wire at 10 ms and 2 ms", measure_eip_period);
  scenario("ethernet-ip-latency", "T->O packet -> sample in another process", measure_eip_latency);
  scenario("ethernet-ip-robots", "1, 8, 32 EtherNet/IP robots at 10 ms: CPU, losses, regularity", measure_eip_robots);
  scenario("ethercat-period", "How regular EtherCAT cycles are on the wire at 1 ms, and the round trip; over a minute",
           measure_ethercat_period, 60);
  scenario("ethercat-latency", "EtherCAT frame -> sample in another process", measure_ethercat_latency);
  scenario("ethercat-robots", "1, 8, 16, 32 robots in a segment at 1 ms: CPU, losses, round trip",
           measure_ethercat_robots);

  // Proofs: their exit code says whether the promise held, or that this machine could not tell.
  const auto proof = [&](const char* name, const char* about, auto prove) {
    auto* command = app.add_subcommand(name, about);
    command->callback([&, name, prove] {
      setting.duration = std::chrono::seconds(seconds);
      try {
        Proof result = prove();
        figures[name] = std::move(result.figures);
        broken.insert(broken.end(), result.broken.begin(), result.broken.end());
        if (!result.not_told.empty()) not_told.push_back(result.not_told);
      } catch (const NotTold& why) {
        not_told.push_back(why.what());
      }
    });
    return command;
  };
  int deaths = 500;
  proof("deaths", "Owners die: stop image within lease + 2 cycles, and quiet after it",
        [&] { return prove_deaths(setting, deaths); })
      ->add_option("--deaths", deaths, "How many")
      ->check(CLI::Range(3, 100000))
      ->capture_default_str();

  proof("fight", "Eight clients fight for one robot: one owner at a time, one end of every command", [&] {
    if (app.count("--seconds") == 0) setting.duration = std::chrono::minutes(2);
    return prove_fight(setting);
  });

  proof("throughput", "Queued commands per cycle, beside what the MoveID handshake allows",
        [&] { return prove_throughput(setting); });

  proof("ethercat-throughput", "The same over EtherCAT, where the handshake takes two cycles",
        [&] { return prove_ethercat_throughput(setting); });

  // The other ends of the measurements, started by the scenarios.
  bool from_robot = false;
  auto* latency_role = app.add_subcommand("latency-reader", "")->group("");
  latency_role->add_flag("--from-robot", from_robot);
  latency_role->callback([&] { run_latency_reader(setting.domain, std::chrono::seconds(seconds), from_robot); });
  long period_us = 10'000;
  int streams = 1;
  auto* bare_role = app.add_subcommand("bare-sender", "")->group("");
  bare_role->add_option("--period-us", period_us);
  bare_role->add_option("--streams", streams);
  bare_role->callback(
      [&] { run_bare_sender(std::chrono::microseconds(period_us), streams, std::chrono::seconds(seconds)); });
  BareLoopOptions bare_loop;
  long long begin_ns = 0;
  auto* bare_ethernet_role = app.add_subcommand("bare-ethernet", "")->group("");
  bare_ethernet_role->add_option("--begin-ns", begin_ns);
  bare_ethernet_role->add_option("--frame", bare_loop.frames);
  bare_ethernet_role->callback([&] {
    bare_loop.begin = std::chrono::nanoseconds(begin_ns);
    bare_loop.duration = std::chrono::seconds(seconds);
    std::printf("%s\n", run_bare_ethernet(bare_loop).dump().c_str());
  });
  app.add_subcommand("counting-reader", "")->group("")->callback([&] {
    run_counting_reader(setting.domain, std::chrono::seconds(seconds));
  });
  auto* raw_writer = app.add_subcommand("raw-writer", "")->group("");
  raw_writer->add_flag("--whole-image", raw.whole_image);
  raw_writer->add_option("--robots", raw.instances);
  raw_writer->add_option("--rate", raw.writes_per_second);
  raw_writer->callback([&] {
    raw.domain = setting.domain;
    raw.duration = std::chrono::seconds(seconds);
    run_raw_writer(raw);
  });

  OwnerOptions owner;
  auto* owner_role = app.add_subcommand("owner", "")->group("");
  owner_role->add_option("--name", owner.name)->required();
  owner_role->add_option("--board", owner.board)->required();
  owner_role->add_flag("--velocity", owner.velocity);
  owner_role->callback([&] {
    owner.domain = setting.domain;
    run_owner(owner);
  });

  FighterOptions fighter;
  auto* fighter_role = app.add_subcommand("fighter", "")->group("");
  fighter_role->add_option("--name", fighter.name)->required();
  fighter_role->add_option("--diary", fighter.diary)->required();
  fighter_role->add_option("--seed", fighter.seed)->required();
  fighter_role->callback([&] {
    fighter.domain = setting.domain;
    run_fighter(fighter);
  });

  bool moves = false, report_completion = false;
  auto* throughput_role = app.add_subcommand("throughput-client", "")->group("");
  throughput_role->add_flag("--moves", moves);
  throughput_role->add_flag("--report-completion", report_completion);
  throughput_role->callback(
      [&] { run_throughput_client(setting.domain, moves, report_completion, std::chrono::seconds(seconds)); });

  CLI11_PARSE(app, argc, argv);
  if (!figures.is_null()) {
    for (const auto& [name, figure] : figures.items()) std::printf("%s", table(name, figure).c_str());
    if (!json_file.empty()) std::ofstream(json_file) << figures.dump(2) << "\n";
  }
  for (const auto& sentence : broken) std::fprintf(stderr, "broken: %s\n", sentence.c_str());
  for (const auto& sentence : not_told) std::fprintf(stderr, "not told: %s\n", sentence.c_str());
  return !broken.empty() ? kBroken : !not_told.empty() ? kNotTold : 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "meca-bench: %s\n", error.what());
  return kBroken;
}
