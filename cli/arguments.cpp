#include "cli/arguments.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <charconv>
#include <functional>
#include <map>

#include "cli/errors.hpp"
#include "cli/plan.hpp"
#include "cli/suggest.hpp"

namespace meca::cli {
namespace {

constexpr const char* kFooter = R"(
Examples:
  meca-ctl status                             what each robot is doing, and why not
  meca-ctl activate && meca-ctl home          from cold to ready
  meca-ctl move-joints -10 0 0 0 0 0 --wait   move and wait until it is there
  meca-ctl move-lin 190 50 250 0 90 0         mm and degrees, tool in the world frame
  meca-ctl velocity lin-wrf 0 0 -20 0 0 0 --for 1.5
  meca-ctl send SetJointVel 50                any command of the manual's table, by name or number
  meca-ctl --robot arm2 watch                 live view; with --json one object a line
  meca-ctl errors 1007                        what an error or stop means and what to do; all without a code
  meca-ctl sim press p-stop2                  buttons of a simulated robot here; 'meca-ctl sim' lists them
  meca-ctl scan ethernet_ip --interface eth1  which devices are there, before any bridge runs; 'scan ethercat' too
  meca-ctl decode --input image.bin --firmware 11.3

Exit codes: 0 done, 1 refused, aborted or discarded, 2 arguments, 4 no bridge or no DDS, 5 time-out, 130 interrupted.
Control ends with the command (unless you 'take' it); motion that the robot has queued is finished.
meca-ctl is no safety device: the emergency stop is the button.)";

constexpr const char* kScanFooter = R"(
ethernet_ip: asks on every interface of --interface, or on all of this machine but the loopback (meca-sim there:
--interface lo). Waits --timeout seconds, default 2.5.

ethercat: lists the devices of the chain on --interface in the order of the cable: address and alias, who each one is,
its AL state and error, which ports have a link, what the error counters have counted since power-on, and whether it
has a distributed clock. In a ring, name both interfaces. Waits --timeout seconds, default 1, for a first answer.
It only reads, so it may be used beside a running bridge; who a device is cannot be read then from all of them, and
another master counts frames that it did not send. Raw frames need root or CAP_NET_RAW:
  sudo meca-ctl scan ethercat --interface eth1)";

// What the subcommands collect before it is checked.
struct Words {
  std::vector<std::string> arguments;
  std::string first;  // on | off, joints | lin-wrf | lin-trf, ID or NAME, CODE
  std::string byte_order = "little";
  bool no_shared_memory = false;
  bool use_variables = false;
};

using Finish = std::function<void(Invocation&, const Words&)>;

void add_global_options(CLI::App& app, Invocation& call, Words& words) {
  app.add_option("--robot", call.robot, "Robot by name; may be left out when there is only one")->envname("MECA_ROBOT");
  app.add_option("--domain", call.domain, "DDS domain")
      ->check(CLI::Range(0, 232))
      ->envname("MECA_DOMAIN")
      ->capture_default_str();
  app.add_option("--prefix", call.prefix, "What the topic names begin with")
      ->envname("MECA_PREFIX")
      ->capture_default_str();
  app.add_option("--interface", call.interfaces,
                 "IPv4 address of a network interface to use (scan: or its name); repeat for several")
      ->envname("MECA_INTERFACE")
      ->allow_extra_args(false);
  app.add_flag("--no-shared-memory", words.no_shared_memory, "UDP only: for containers that do not share /dev/shm")
      ->envname("MECA_NO_SHARED_MEMORY");
  app.add_option("--client", call.client, "Name to appear under; default meca-ctl@host:pid")
      ->envname("MECA_CLIENT")
      ->check(CLI::Validator(
          [](const std::string& name) {
            return name.size() <= 63 ? std::string() : "a client name has at most 63 bytes";
          },
          ""));
  app.add_flag("--json", call.json, "One JSON object a line");
  app.add_flag("--wait", call.wait, "Motion: wait until it has been executed, not only queued");
  app.add_option("--timeout", call.timeout_s, "Seconds to wait: for a bridge (default 5), for an answer (default 60)")
      ->check(CLI::Range(0.01, 1e6));
}

void add_duration(CLI::App& sub, Invocation& call, const std::string& about) {
  sub.add_option("--for", call.duration_s, about)->check(CLI::Range(0.0, 1e6));
}

CLI::App* add_verb(CLI::App& app, std::string_view name, const std::string& about, const Finish& finish,
                   std::map<const CLI::App*, Finish>& finishers) {
  CLI::App* sub = app.add_subcommand(std::string(name), about);
  sub->fallthrough();
  sub->footer("");
  sub->allow_extras();
  finishers[sub] = finish;
  return sub;
}

void add_commands(CLI::App& app, Words& words, std::map<const CLI::App*, Finish>& finishers) {
  for (const ActionVerb& verb : action_verbs()) {
    auto* sub = add_verb(
        app, verb.name, std::string(verb.about),
        [&verb](Invocation& call, const Words& w) {
          call.verb = Verb::kCommand;
          call.command = plan_action(verb, w.first);
        },
        finishers);
    if (verb.on_off) sub->add_option("state", words.first, "on or off");
  }
  for (const MotionVerb& verb : motion_verbs()) {
    const std::string wanted = expected_arguments(verb.motion_command_id);
    auto* sub = add_verb(
        app, verb.name, std::string(verb.about) + ": " + wanted,
        [&verb](Invocation& call, const Words& w) {
          call.verb = Verb::kCommand;
          call.command = plan_motion(verb, w.arguments);
        },
        finishers);
    sub->add_option("numbers", words.arguments, wanted);
  }
  auto* send = add_verb(
      app, "send", "Any motion command of the robot manual, by name or number",
      [](Invocation& call, const Words& w) {
        if (w.first.empty()) throw UsageError("send wants a command first, as in 'send SetJointVel 50'");
        call.verb = Verb::kCommand;
        call.command = plan_send(w.first, w.arguments, w.use_variables);
      },
      finishers);
  send->add_option("command", words.first, "Name or number: SetJointVel, 8");
  send->add_option("numbers", words.arguments, "Arguments in the manual's order and units");
  send->add_flag("--use-variables", words.use_variables, "Arguments are cyclic ids of robot variables (firmware 11)");
}

void add_velocity(CLI::App& app, Invocation& call, Words& words, std::map<const CLI::App*, Finish>& finishers) {
  auto* sub = add_verb(
      app, "velocity", "Move at a velocity for a while, then stop",
      [](Invocation& c, const Words& w) {
        if (w.first.empty()) throw UsageError("velocity wants joints, lin-wrf or lin-trf first");
        c.verb = Verb::kVelocity;
        c.velocity = plan_velocity(w.first, w.arguments);
        if (!c.duration_s) throw UsageError("velocity wants --for SECONDS: how long the robot may move");
      },
      finishers);
  sub->add_option("kind", words.first, "joints (deg/s) | lin-wrf | lin-trf (mm/s and deg/s)");
  sub->add_option("numbers", words.arguments, "Six velocities");
  add_duration(*sub, call, "Seconds to move");
}

void add_views(CLI::App& app, Invocation& call, std::map<const CLI::App*, Finish>& finishers) {
  const auto verb = [](Verb v) { return [v](Invocation& c, const Words&) { c.verb = v; }; };
  add_verb(app, "status", "What each robot is doing, and why not", verb(Verb::kStatus), finishers);
  auto* watch = add_verb(app, "watch", "Live view until Ctrl-C", verb(Verb::kWatch), finishers);
  watch->add_option("--rate", call.rate_hz, "Redraws a second; default 10, or 1 line a second when not on a terminal")
      ->check(CLI::Range(0.1, 100.0));
  add_duration(*watch, call, "Seconds to watch; default: until Ctrl-C");
  auto* take = add_verb(app, "take", "Take control and hold it until Ctrl-C", verb(Verb::kTake), finishers);
  add_duration(*take, call, "Seconds to hold; default: until Ctrl-C");
  auto* topics =
      add_verb(app, "topics", "Every topic with type, rate and who is there", verb(Verb::kTopics), finishers);
  add_duration(*topics, call, "Seconds to measure the received rate; default 2");
  auto* receipts =
      add_verb(app, "receipts", "What became of everybody's commands, live", verb(Verb::kReceipts), finishers);
  add_duration(*receipts, call, "Seconds to follow; default: until Ctrl-C");
  add_verb(app, "health", "Exit 0 when every robot's link is up (for HEALTHCHECK)", verb(Verb::kHealth), finishers);
}

void add_sim(CLI::App& app, Invocation& call, Words& words, std::map<const CLI::App*, Finish>& finishers) {
  auto* sub = add_verb(
      app, "sim", "Buttons and faults of a simulated robot on this machine; without words: which there are",
      [](Invocation& c, const Words& w) {
        c.verb = Verb::kSim;
        for (const auto& word : w.arguments) c.sim_line += (c.sim_line.empty() ? "" : " ") + word;
      },
      finishers);
  sub->add_option("words", words.arguments, "As in: press e-stop");
  sub->add_option("--socket", call.socket, "Control socket of the robot, when it is not at its usual place");
}

ScanBus scan_bus(const std::string& word) {
  if (word == "ethernet_ip") return ScanBus::kEthernetIp;
  if (word == "ethercat") return ScanBus::kEthercat;
  if (word.empty())
    throw UsageError("scan wants a fieldbus, as in 'scan ethernet_ip' or 'scan ethercat --interface eth1'");
  const std::vector<std::string> buses{"ethernet_ip", "ethercat"};
  throw UsageError("scan does not know '" + word + "', only ethernet_ip and ethercat" + did_you_mean(word, buses));
}

void check_ethercat_scan(const Invocation& call) {
  if (call.interfaces.empty()) {
    throw UsageError(
        "scan ethercat wants --interface NAME, the network interface that the chain is wired to ('ip link' lists "
        "them): "
        "its frames would disturb other networks");
  }
  if (!call.address.empty()) {
    throw UsageError("scan ethercat takes no --address: devices have positions there, and all of them are asked");
  }
}

void add_scan(CLI::App& app, Invocation& call, Words& words, std::map<const CLI::App*, Finish>& finishers) {
  auto* sub = add_verb(
      app, "scan", "Who is there on a fieldbus; needs no bridge",
      [](Invocation& c, const Words& w) {
        c.verb = Verb::kScan;
        c.scan_bus = scan_bus(w.first);
        if (c.scan_bus == ScanBus::kEthercat) check_ethercat_scan(c);
      },
      finishers);
  sub->add_option("bus", words.first, "ethernet_ip or ethercat");
  sub->add_option(
      "--address", call.address,
      "ethernet_ip: ask this IPv4 address alone, or a subnet's broadcast address; default: everybody on the "
      "interfaces");
  sub->footer(kScanFooter);
}

void add_decode(CLI::App& app, Invocation& call, Words& words, std::map<const CLI::App*, Finish>& finishers) {
  auto* sub = add_verb(
      app, "decode", "Name the fields of a 60 or 252 byte process image",
      [](Invocation& c, const Words& w) {
        c.verb = Verb::kDecode;
        if (c.input.empty()) throw UsageError("decode wants --input: hex digits, a file, or - for stdin");
        c.big_endian = w.byte_order == "big";
      },
      finishers);
  sub->add_option("--input", call.input, "Hex digits, or a file with hex digits or raw bytes, or - for stdin");
  sub->add_option("--firmware", call.firmware, "Firmware the image is from: 9.x, 10.x or 11.x")->capture_default_str();
  sub->add_option("--byte-order", words.byte_order, "little (EtherCAT, EtherNet/IP) or big")
      ->check(CLI::IsMember({"little", "big"}))
      ->capture_default_str();
}

void add_errors(CLI::App& app, Invocation& call, Words& words, std::map<const CLI::App*, Finish>& finishers) {
  auto* sub = add_verb(
      app, "errors", "What the robot's error codes and stops mean, and what to do",
      [](Invocation& c, const Words& w) {
        c.verb = Verb::kErrors;
        c.trouble = w.first;
        if (!c.trouble.empty()) find_trouble(c.trouble);
        if (c.markdown && (c.json || !c.trouble.empty())) {
          throw UsageError("errors --markdown prints the whole page, without a code and without --json");
        }
      },
      finishers);
  sub->add_option("code", words.first, "Code or name of one of them: 1007, JOINT_OVER_LIMIT, EStop");
  sub->add_flag("--markdown", call.markdown, "The page docs/errors.md");
}

// CLI11 takes "-10" for a number but ".5" behind a minus for an option.
void spell_out_fractions(std::vector<std::string>& words) {
  for (auto& word : words) {
    if (word.size() > 2 && word.starts_with("-.") && word[2] >= '0' && word[2] <= '9') word.insert(1, "0");
  }
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// What is left over after parsing is a mistake; say which.
void refuse_leftovers(const CLI::App& app, const CLI::App* sub) {
  auto left = app.remaining(true);
  std::erase(left, "--");  // only says that what follows are no options
  if (sub == nullptr) {
    std::vector<std::string> verbs;
    for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
    for (const auto& word : left) {
      if (word.starts_with("-")) continue;
      throw UsageError("there is no command '" + word + "'" + did_you_mean(word, verbs));
    }
  }
  if (left.empty()) return;
  if (left.front().starts_with("-")) {
    auto known = option_names(app);
    if (sub != nullptr) {
      for (auto& name : option_names(*sub)) known.push_back(std::move(name));
    }
    throw UsageError("there is no option '" + left.front() + "'" + did_you_mean(left.front(), known));
  }
  throw UsageError(sub->get_name() + " does not take '" + left.front() + "'");
}

}  // namespace

std::variant<Invocation, Answer> parse_arguments(std::vector<std::string> words) {
  Invocation call;
  Words collected;
  std::map<const CLI::App*, Finish> finishers;
  CLI::App app{"Watch and command Mecademic Meca500 robots over DDS, through meca-bridge.", "meca-ctl"};
  app.footer(kFooter);
  app.require_subcommand(0, 1);
  app.allow_extras();
  add_global_options(app, call, collected);
  add_views(app, call, finishers);
  add_commands(app, collected, finishers);
  add_velocity(app, call, collected, finishers);
  add_sim(app, call, collected, finishers);
  add_scan(app, call, collected, finishers);
  add_decode(app, call, collected, finishers);
  add_errors(app, call, collected, finishers);

  spell_out_fractions(words);
  std::ranges::reverse(words);  // CLI11 takes them from the back
  try {
    app.parse(words);
    const auto chosen = app.get_subcommands();
    const CLI::App* sub = chosen.empty() ? nullptr : chosen.front();
    refuse_leftovers(app, sub);
    if (sub == nullptr) return Answer{ExitCode::kArguments, app.help()};
    call.shared_memory = !collected.no_shared_memory;
    finishers.at(sub)(call, collected);
    return call;
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    return Answer{ExitCode::kDone, chosen.empty() ? app.help() : chosen.front()->help()};
  } catch (const CLI::Error& error) {
    return Answer{ExitCode::kArguments, "meca-ctl: " + std::string(error.what()) + "\n"};
  } catch (const UsageError& error) {
    return Answer{ExitCode::kArguments,
                  "meca-ctl: " + std::string(error.what()) + "\n'meca-ctl --help' shows what there is.\n"};
  }
}

}  // namespace meca::cli
