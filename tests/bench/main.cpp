// meca-bench: speed as ratios, measured in one run beside raw Fast DDS and bare system calls.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "tests/bench/process.hpp"
#include "tests/bench/raw_dds.hpp"
#include "tests/bench/readers.hpp"
#include "tests/bench/scenarios.hpp"
#include "tests/bench/table.hpp"

using namespace meca::bench;

int main(int argc, char** argv) try {
  Setting setting;
  setting.bridge = std::filesystem::path(own_path()).parent_path() / "meca-bridge";
  long seconds = 10;
  std::string json_file;
  RawWriterOptions raw;
  raw.whole_image = false;

  CLI::App app{
      "Measures the bridge beside raw Fast DDS and bare system calls, in one run.\n"
      "Read the ratios: absolute figures belong to this machine and this moment."};
  app.require_subcommand(1);
  app.fallthrough();
  app.add_option("--seconds", seconds, "Length of each measurement")->check(CLI::Range(3, 600))->capture_default_str();
  app.add_option("--domain", setting.domain, "DDS domain")->capture_default_str();
  app.add_option("--json", json_file, "Also write the figures to this file");

  nlohmann::ordered_json figures;
  const auto scenario = [&](const char* name, const char* about, auto measure) {
    app.add_subcommand(name, about)->callback([&, name, measure] {
      setting.duration = std::chrono::seconds(seconds);
      std::fprintf(stderr, "%s ...\n", name);
      figures[name] = measure(setting);
    });
  };
  scenario("latency", "Robot image -> sample in another process", measure_latency);
  scenario("cpu", "CPU per robot at 1 kHz for 1, 4, 16, 64 robots", measure_cpu);
  scenario("wakeup", "Lateness of the cycle thread", measure_wakeup);
  scenario("stopped-reader", "Missed cycles of four robots with a stopped reliable reader", measure_stopped_reader);

  // The other ends of the measurements, started by the scenarios.
  app.add_subcommand("latency-reader", "")->group("")->callback([&] {
    run_latency_reader(setting.domain, std::chrono::seconds(seconds));
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

  CLI11_PARSE(app, argc, argv);
  if (!figures.is_null()) {
    for (const auto& [name, figure] : figures.items()) std::printf("%s", table(name, figure).c_str());
    if (!json_file.empty()) std::ofstream(json_file) << figures.dump(2) << "\n";
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "meca-bench: %s\n", error.what());
  return 1;
}
