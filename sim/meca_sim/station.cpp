#include "sim/meca_sim/station.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/meca_sim/ethercat_network.hpp"
#include "sim/meca_sim/ethernet_ip_network.hpp"
#include "transports/net/clock.hpp"

namespace meca::sim {
namespace {

using Level = Narrator::Level;

// Where `meca-ctl sim` looks unless it is told otherwise.
constexpr int kDomain = 0;
constexpr std::string_view kTopicPrefix = "meca500/";

std::unique_ptr<Network> open_network(const Arguments& a, const std::vector<Narrator::Say>& say) {
  const Time now = net::monotonic();
  switch (a.bus) {
    case Fieldbus::kEthernetIp:
      return std::make_unique<EthernetIpNetwork>(a.model, a.adapter, a.on_loss, find_own_interface(a.bind), now,
                                                 say.front());
    case Fieldbus::kEthercat: {
      std::vector<EthercatSegment::Member> members;
      for (std::size_t i = 0; i < a.names.size(); ++i) {
        const bool foreign = std::ranges::find(a.foreign, a.names[i]) != a.foreign.end();
        members.push_back({model_of(a, i), device_of(a, i), foreign});
      }
      return std::make_unique<EthercatNetwork>(members, a.on_loss, a.interface, a.redundant_interface, now, say);
    }
  }
  return nullptr;
}

// A path of its own for each of several robots: in the directory that was named.
std::filesystem::path control_path(const Arguments& arguments, const std::string& name) {
  if (arguments.control == "auto") return transports::default_control_socket(kDomain, kTopicPrefix, name);
  const std::filesystem::path path = arguments.control;
  return arguments.names.size() == 1 ? path : path / (name + ".sock");
}

}  // namespace

Station::Station(const Arguments& arguments, Narrator::Say say) : say_(std::move(say)), script_(arguments.script) {
  std::vector<Narrator::Say> sayings;
  for (const std::string& name : arguments.names) sayings.push_back(saying(name));
  network_ = open_network(arguments, sayings);
  for (const std::string& name : arguments.names) open_panel(arguments, seats_.emplace_back(Seat{name, nullptr}));
  // Last, because whoever reads it may begin.
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    say_(Level::kInfo, describe(arguments, i) + "; " + network_->place(i));
  }
}

Narrator::Say Station::saying(const std::string& name) const {
  return [say = say_, name](Level level, const std::string& text) { say(level, name + ": " + text); };
}

void Station::open_panel(const Arguments& arguments, Seat& seat) {
  if (arguments.control == "off") return;
  try {
    seat.panel = std::make_unique<transports::ControlPanel>(control_path(arguments, seat.name));
    say_(Level::kInfo, seat.name + ": buttons and faults are at " + seat.panel->socket().string());
  } catch (const std::runtime_error& error) {
    say_(Level::kWarning, seat.name +
                              ": no control socket, buttons cannot be pressed; another --name or --control may help: " +
                              std::string(error.what()));
  }
}

void Station::follow_script(Time now) {
  for (; next_line_ < script_.size() && begin_ + script_[next_line_].at <= now; ++next_line_) {
    const ScriptLine& line = script_[next_line_];
    for (std::size_t i = 0; i < seats_.size(); ++i) {
      if (!line.robot.empty() && line.robot != seats_[i].name) continue;
      PanelAnswer answer;
      apply(line.request, network_->robot(i), &network_->faults(i), answer);
      std::string text = to_text(answer);
      text.pop_back();
      say_(Level::kInfo, seats_[i].name + ": '" + line.words + "': " + text);
    }
  }
}

void Station::exchange(Time now) {
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    if (seats_[i].panel) seats_[i].panel->serve(network_->robot(i), &network_->faults(i));
  }
  network_->exchange(now);
  for (std::size_t i = 0; i < seats_.size(); ++i) network_->narrator(i).look(now);
}

void Station::tell_trouble() {
  if (network_->trouble() == trouble_) return;
  trouble_ = network_->trouble();
  if (!trouble_.empty()) say_(Level::kWarning, seats_.front().name + ": " + trouble_);
}

void Station::run(int stop, std::optional<Time> run_for) {
  net::Poller poller(1 + network_->slots());
  poller.watch(0, stop);
  begin_ = net::monotonic();
  const Time end = run_for ? begin_ + *run_for : Time::max();
  for (Time now = begin_; now < end; now = net::monotonic()) {
    follow_script(now);
    exchange(now);
    tell_trouble();
    network_->wait_for(poller, 1, now);
    poller.wait(std::min(network_->next_event(now), end));
    if (poller.ready(0)) break;
  }
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    say_(Level::kInfo, seats_[i].name + ": stopped; " + network_->narrator(i).summary());
  }
}

}  // namespace meca::sim
