#include <nlohmann/json.hpp>

#include "cli/decode.hpp"
#include "cli/errors.hpp"
#include "cli/format.hpp"
#include "cli/names.hpp"
#include "cli/plan.hpp"
#include "cli/run.hpp"

namespace meca::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kGlance = 20ms;

bool all_of(const Views& robots, bool (*good)(const RobotView&)) {
  for (const auto& [name, view] : robots) {
    if (!good(view)) return false;
  }
  return !robots.empty();
}

std::int64_t unix_ns() { return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count(); }

// A retained sample proves nothing: a second one shows that the bridge is alive now.
bool is_alive(const RobotView& view) { return view.bridge_samples >= 2; }

std::string sickness(const RobotView& view) {
  if (!view.bridge) return "no BridgeStatus";
  if (!is_alive(view)) return "the bridge has fallen silent";
  if (view.bridge->link() == meca500::LinkState::LINK_UP) return "";
  std::string text = "link not up";
  if (view.bridge->link_detail().size() != 0) text += " (" + std::string(view.bridge->link_detail().c_str()) + ")";
  return text;
}

bool is_healthy(const RobotView& view) { return sickness(view).empty(); }

ExitCode report_health(const Views& robots, const Report& report) {
  std::string text;
  Json list = Json::object();
  bool healthy = true;
  for (const auto& [name, view] : robots) {
    const std::string why = sickness(view);
    healthy = healthy && why.empty();
    text += (text.empty() ? "" : "; ") + name + " " + (why.empty() ? "ok" : why);
    list[name] = why.empty() ? "ok" : why;
  }
  report.text((healthy ? "healthy: " : "not healthy: ") + text);
  report.object({{"healthy", healthy}, {"robots", list}});
  return healthy ? ExitCode::kDone : ExitCode::kRefused;
}

}  // namespace

Views chosen(const Views& robots, const std::string& wanted) {
  if (wanted.empty()) return robots;
  const auto found = robots.find(wanted);
  return found == robots.end() ? Views{} : Views{*found};
}

ExitCode run_status(const Invocation& call, const Report& report) {
  Bus bus(call);
  Observer observer(bus, Interest::kState);
  observer.discover(call.robot, discovery_timeout(call));
  observer.fill(call.robot, kPatience);
  bool first = true;
  for (const auto& [name, view] : chosen(observer.robots(), call.robot)) {
    report.text((first ? "" : "\n") + status_text(name, view, unix_ns()));
    report.object(to_json(name, view));
    first = false;
  }
  return interrupted ? ExitCode::kInterrupted : ExitCode::kDone;
}

ExitCode run_health(const Invocation& call, const Report& report) {
  Bus bus(call);
  Observer observer(bus, Interest::kControl);
  const auto start = Clock::now();
  observer.discover(call.robot, discovery_timeout(call));
  while (!interrupted && Clock::now() - start < discovery_timeout(call) &&
         !all_of(chosen(observer.robots(), call.robot), is_healthy)) {
    observer.pump(kGlance);
  }
  return interrupted ? ExitCode::kInterrupted : report_health(chosen(observer.robots(), call.robot), report);
}

ExitCode run_receipts(const Invocation& call, const Report& report) {
  Bus bus(call);
  Observer observer(bus, Interest::kControl);
  auto receipts = bus.latest<meca500::CommandReceipt>("CommandReceipt", 256);
  observer.discover(call.robot, discovery_timeout(call));
  const auto start = Clock::now();
  meca500::CommandReceipt receipt;
  dds::SampleInfo info;
  while (!interrupted && (!call.duration_s || Clock::now() - start < seconds_of(*call.duration_s))) {
    observer.pump(kGlance);
    while (receipts.take(receipt, info)) {
      if (!info.valid_data || (!call.robot.empty() && receipt.robot().c_str() != call.robot)) continue;
      report.text(
          receipt_text(receipt, std::string(receipt.client().c_str()) + " #" + std::to_string(receipt.command_id())));
      report.object(to_json(receipt));
    }
  }
  return ExitCode::kDone;
}

ExitCode run_decode(const Invocation& call, const Report& report) {
  const image::Format format{parse_firmware(call.firmware), call.big_endian ? std::endian::big : std::endian::little};
  const auto bytes = read_image(call.input);
  const std::string rendered = render_image(bytes, format, report.json());
  if (report.json()) {
    report.object(Json::parse(rendered));
  } else {
    report.text(rendered);
  }
  return ExitCode::kDone;
}

ExitCode run_errors(const Invocation& call, const Report& report) {
  if (call.trouble.empty()) {
    report.text(call.markdown ? troubles_page() : troubles_list());
    for (const Trouble& trouble : all_troubles()) report.object(to_json(trouble));
  } else {
    const Trouble trouble = find_trouble(call.trouble);
    report.text(explain(trouble));
    report.object(to_json(trouble));
  }
  return ExitCode::kDone;
}

ExitCode run(const Invocation& call, const Report& report) {
  switch (call.verb) {
    case Verb::kStatus:
      return run_status(call, report);
    case Verb::kWatch:
      return run_watch(call, report);
    case Verb::kCommand:
      return run_command(call, report);
    case Verb::kVelocity:
      return run_velocity(call, report);
    case Verb::kTake:
      return run_take(call, report);
    case Verb::kTopics:
      return run_topics(call, report);
    case Verb::kDecode:
      return run_decode(call, report);
    case Verb::kHealth:
      return run_health(call, report);
    case Verb::kReceipts:
      return run_receipts(call, report);
    case Verb::kErrors:
      return run_errors(call, report);
    case Verb::kSim:
      return run_sim(call, report);
    case Verb::kScan:
      return call.scan_bus == ScanBus::kEthercat ? run_scan_ethercat(call, report) : run_scan(call, report);
  }
  return ExitCode::kArguments;
}

}  // namespace meca::cli
