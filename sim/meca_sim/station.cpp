#include "sim/meca_sim/station.hpp"

#include <algorithm>
#include <stdexcept>

#include "transports/net/clock.hpp"

namespace meca::sim {
namespace {

// Where `meca-ctl sim` looks unless it is told otherwise.
constexpr int kDomain = 0;
constexpr std::string_view kTopicPrefix = "meca500/";

ethernet_ip::AdapterSettings with_address(ethernet_ip::AdapterSettings settings, const net::Interface& own) {
  settings.address = own.address;
  settings.netmask = own.netmask;
  return settings;
}

std::string list_of(const std::vector<net::Interface>& interfaces) {
  std::string text;
  for (const auto& i : interfaces) text += (text.empty() ? "" : ", ") + i.name + " " + net::to_string(i.address);
  return text;
}

}  // namespace

net::Interface find_own_interface(const std::string& bind) {
  const auto interfaces = net::ipv4_interfaces();
  const auto address = net::parse_ipv4(bind);
  const auto found = std::ranges::find_if(interfaces, [&](const net::Interface& i) {
    const bool loopback = i.address >> 24 == 127;  // the whole of 127/8 is this machine's
    if (!address) return i.name == bind;
    return loopback ? ((*address ^ i.address) & i.netmask) == 0 : *address == i.address;
  });
  if (found == interfaces.end()) {
    throw std::runtime_error("--bind: '" + bind + "' is neither an address nor an interface of this machine; it has " +
                             list_of(interfaces));
  }
  net::Interface own = *found;
  if (address) own.address = *address;
  return own;
}

Station::Station(const Arguments& arguments, Narrator::Say say)
    : say_(std::move(say)),
      own_(find_own_interface(arguments.bind)),
      robot_(arguments.model, with_address(arguments.adapter, own_), arguments.on_loss, net::monotonic()),
      sockets_(robot_, own_),
      narrator_(robot_, say_),
      script_(arguments.script),
      begin_(net::monotonic()) {
  open_panel(arguments);
}

void Station::open_panel(const Arguments& arguments) {
  if (arguments.control == "off") return;
  try {
    std::filesystem::path path = arguments.control;
    if (arguments.control == "auto") {
      path = transports::default_control_socket(kDomain, kTopicPrefix, arguments.name);
    }
    panel_ = std::make_unique<transports::ControlPanel>(std::move(path));
    say_(Narrator::Level::kInfo, "buttons and faults are at " + panel_->socket().string());
  } catch (const std::runtime_error& error) {
    say_(Narrator::Level::kWarning,
         "no control socket, buttons cannot be pressed; another --name or --control may help: " +
             std::string(error.what()));
  }
}

void Station::follow_script(Time now) {
  for (; next_line_ < script_.size() && begin_ + script_[next_line_].at <= now; ++next_line_) {
    const ScriptLine& line = script_[next_line_];
    PanelAnswer answer;
    apply(line.request, robot_.robot(), &robot_.faults(), answer);
    std::string text = to_text(answer);
    text.pop_back();
    say_(Narrator::Level::kInfo, "'" + line.words + "': " + text);
  }
}

void Station::run(int stop, std::optional<Time> run_for) {
  net::Poller poller(1 + EthernetIpSockets::kSlots);
  poller.watch(0, stop);
  begin_ = net::monotonic();
  const Time end = run_for ? begin_ + *run_for : Time::max();
  for (Time now = begin_; now < end; now = net::monotonic()) {
    follow_script(now);
    if (panel_) panel_->serve(robot_.robot(), &robot_.faults());
    robot_.advance(now);
    sockets_.exchange(now);
    narrator_.look(now);
    if (sockets_.trouble() != trouble_) {
      trouble_ = sockets_.trouble();
      if (!trouble_.empty()) say_(Narrator::Level::kWarning, trouble_);
    }
    sockets_.wait_for(poller, 1, now);
    poller.wait(std::min({robot_.next_event(), sockets_.next_event(now), end}));
    if (poller.ready(0)) return;
  }
}

}  // namespace meca::sim
