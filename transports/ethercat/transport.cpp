#include "transports/ethercat/transport.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <stdexcept>
#include <utility>

#include "transports/ethercat/bus_counters.hpp"
#include "transports/net/claim.hpp"
#include "transports/net/clock.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/raw_ethernet.hpp"

namespace meca::ethercat {
namespace {

using namespace std::chrono_literals;
using Port = Master::Port;
using Link = net::RawEthernet::Link;

constexpr std::size_t kPorts = 2;  // in the order of Master::Port
constexpr int kMostFrames = 64;    // taken from a port in one go: a flood must not keep us from what is due
constexpr Time kLinkPeriod = 100ms;
// The bridge has promised to be gone within 2 s, of which the stop image may take 1.5 s.
constexpr Time kCloseTime = 400ms;
// What is due by itself is looked at no more often, whatever the master says.
constexpr Time kShortestRest = 20us;

std::uint64_t since_2000(Time now) {
  constexpr std::chrono::sys_days kEpoch = std::chrono::year{2000} / 1 / 1;
  const Time wall = std::chrono::system_clock::now() - std::chrono::sys_time<Time>(kEpoch);
  return static_cast<std::uint64_t>((wall - now).count());
}

transports::LinkDetail why_not(Link link, const std::string& interface) noexcept {
  const char* const name = interface.c_str();
  switch (link) {
    case Link::kUp:
      return {};
    case Link::kNoCarrier:
      return transports::LinkDetail::format(
          "no carrier on '%s'; check its cable and the power of the robot at the other end", name);
    case Link::kDown:
      return transports::LinkDetail::format("'%s' is switched off on this machine; ip link set %s up", name, name);
    case Link::kGone:
      return transports::LinkDetail::format("'%s' was taken away from this machine; it is used again when it is back",
                                            name);
  }
  return {};
}

transports::LinkState link_of(Station::Phase phase) noexcept {
  using Phase = Station::Phase;
  switch (phase) {
    case Phase::kOperational:
      return transports::LinkState::kUp;
    case Phase::kInit:
    case Phase::kPreop:
    case Phase::kConfiguring:
    case Phase::kSafeop:
    case Phase::kStarting:
    case Phase::kRecovering:
      return transports::LinkState::kConnecting;
    case Phase::kAbsent:
    case Phase::kPausing:
    case Phase::kClosing:
    case Phase::kClosed:
      return transports::LinkState::kDown;
  }
  return transports::LinkState::kDown;
}

class Bus final : public transports::Transport {
 public:
  Bus(std::vector<RobotPlace> robots, BusOptions options)
      : options_(std::move(options)), places_(std::move(robots)), robots_(places_.size()), poller_(kPorts) {}

  std::endian byte_order() const noexcept override { return std::endian::little; }
  std::span<const transports::CounterInfo> counters() const noexcept override { return bus_counters(); }
  void open(Time now) override;
  void exchange(Time now, std::span<transports::Exchange> exchanges) noexcept override;
  Woke wait(Time deadline) noexcept override;
  Time deadline_shift() const noexcept override { return shift_; }
  void close() noexcept override;

 private:
  struct Interface {
    net::RawEthernet socket;
    net::File claim;           // that no other bridge is master on it
    std::optional<Link> link;  // as it was looked at last
  };
  struct Robot {
    bool fresh = false;  // inputs that no exchange() has handed over yet
    Time stepped_for{};  // the deadline before which an arrival was last announced: one step a cycle
  };

  static Interface open_interface(const std::string& name);
  void begin_cycle(Time now) noexcept;
  void send(Time now) noexcept;
  void serve(Time until) noexcept;
  void receive(std::size_t port) noexcept;
  void look_at_links(Time now) noexcept;
  bool arrived(const Robot& robot) const noexcept { return robot.fresh && robot.stepped_for != deadline_; }
  void fill(std::size_t robot, transports::Exchange& exchange, bool fresh) noexcept;

  BusOptions options_;
  std::vector<RobotPlace> places_;
  std::vector<Robot> robots_;
  std::array<Interface, kPorts> ports_;
  net::Poller poller_;
  std::optional<Master> master_;
  transports::LinkDetail no_link_;  // empty while one of the ports is up
  Time deadline_{}, next_look_{}, shift_{};
  bool woke_for_arrival_ = false;
  BusFacts facts_;
  std::array<std::byte, kLongestFrame> buffer_{};
};

// Two masters would take each other's replies for their own and bring the robots down by turns.
Bus::Interface Bus::open_interface(const std::string& name) {
  Interface out;
  out.socket = net::RawEthernet(name, kEtherType);
  auto claim = net::claim("meca500/ethercat-master/" + name);
  if (!claim) {
    throw std::runtime_error("'" + name +
                             "' has an EtherCAT master already: another meca-bridge runs on it; stop that one first");
  }
  out.claim = std::move(*claim);
  return out;
}

void Bus::open(Time now) {
  const bool redundant = !options_.redundant_interface.empty();
  ports_[0] = open_interface(options_.interface);
  if (redundant) ports_[1] = open_interface(options_.redundant_interface);
  for (std::size_t port = 0; port < kPorts; ++port) poller_.watch(port, ports_[port].socket.descriptor());
  MasterSettings settings;
  settings.robots = places_;
  settings.cycle = options_.cycle;
  settings.separate = options_.separate;
  settings.dc = options_.dc;
  settings.dc_shift = options_.dc_shift;
  settings.watchdog = options_.watchdog;
  settings.redundant = redundant;
  settings.dc_epoch = since_2000(now);
  master_.emplace(settings);
  look_at_links(now);
}

void Bus::exchange(Time now, std::span<transports::Exchange> exchanges) noexcept {
  exchanges = exchanges.first(std::min(exchanges.size(), robots_.size()));
  const bool arrival = std::exchange(woke_for_arrival_, false);
  if (!arrival) {
    for (std::size_t i = 0; i < exchanges.size(); ++i) {
      // Also what is not to command: the outputs from before a loss must not be the first that a robot gets after it.
      master_->set_output(i, exchanges[i].output);
    }
    begin_cycle(now);
  }
  for (std::size_t i = 0; i < exchanges.size(); ++i) {
    Robot& robot = robots_[i];
    const bool fresh = arrival ? arrived(robot) : robot.fresh;
    if (fresh) robot = {.fresh = false, .stepped_for = arrival ? deadline_ : robot.stepped_for};
    fill(i, exchanges[i], fresh);
  }
}

void Bus::begin_cycle(Time now) noexcept {
  if (deadline_ != Time{}) facts_.wake_up.add(now - deadline_, now);
  master_->begin_cycle(now);
  send(now);
  shift_ = master_->dc_phase_correction();
  if (now >= next_look_) look_at_links(now);
}

void Bus::send(Time now) noexcept {
  for (Bytes frame = master_->next_frame(now); !frame.empty(); frame = master_->next_frame(now)) {
    const std::size_t ports = master_->on_both_ports() ? kPorts : 1;
    for (Interface& port : std::span(ports_).first(ports)) {
      if (port.link == Link::kUp && !port.socket.send(frame)) ++facts_.failed_sends;
    }
  }
}

transports::Transport::Woke Bus::wait(Time deadline) noexcept {
  deadline_ = deadline;
  for (Time now = net::monotonic(); now < deadline; now = net::monotonic()) {
    serve(std::min(deadline, std::max(master_->next_event(), now + kShortestRest)));
    now = net::monotonic();
    // What is here at the deadline is handed over by the exchange() that is due, after it has sent.
    if (now >= deadline) break;
    woke_for_arrival_ = std::ranges::any_of(robots_, [this](const Robot& robot) { return arrived(robot); });
    if (woke_for_arrival_) return Woke::kArrival;
    if (master_->next_event() <= now) send(now);
  }
  return Woke::kDeadline;
}

// Waits until something arrives or the time is over, and takes what is there.
void Bus::serve(Time until) noexcept {
  if (!poller_.wait(until)) return;
  for (std::size_t port = 0; port < kPorts; ++port) {
    if (poller_.ready(port)) receive(port);
  }
}

void Bus::receive(std::size_t port) noexcept {
  for (int i = 0; i < kMostFrames; ++i) {
    const auto size = ports_[port].socket.receive(buffer_);
    if (!size) break;
    const Bytes frame = Bytes(buffer_).first(std::min(*size, buffer_.size()));
    master_->received(static_cast<Port>(port), frame, net::monotonic());
  }
  for (std::size_t i = 0; i < robots_.size(); ++i) robots_[i].fresh |= master_->take_fresh(i);
}

void Bus::look_at_links(Time now) noexcept {
  next_look_ = now + kLinkPeriod;
  bool up = false;
  for (std::size_t i = 0; i < kPorts; ++i) {
    Interface& port = ports_[i];
    if (!port.socket) continue;
    const Link link = port.socket.link();
    const bool news = !port.link || (link == Link::kUp) != (port.link == Link::kUp);
    if (news) master_->link_changed(static_cast<Port>(i), link == Link::kUp, now);
    port.link = link;
    up |= link == Link::kUp;
  }
  no_link_ = up ? transports::LinkDetail{} : why_not(*ports_[0].link, options_.interface);
}

void Bus::fill(std::size_t robot, transports::Exchange& exchange, bool fresh) noexcept {
  const Station& station = master_->station(robot);
  exchange.fresh = fresh;
  if (fresh) exchange.input = master_->input(robot);
  exchange.link = link_of(station.phase());
  exchange.identity = station.firmware();
  exchange.link_detail = no_link_.empty() ? transports::LinkDetail(master_->trouble(robot)) : no_link_;
  count(*master_, robot, facts_, exchange.counters);
}

// All robots to INIT; the frames with the last outputs go on until they are there.
void Bus::close() noexcept {
  if (!master_) return;
  Time now = net::monotonic();
  const Time end = now + kCloseTime;
  master_->close(now);
  while (now < end && !master_->closed()) {
    deadline_ = Time{};
    begin_cycle(now);
    const Time next = std::min(end, now + options_.cycle);
    while (wait(next) == Woke::kArrival) {
      for (Robot& robot : robots_) robot.fresh = false;
    }
    now = net::monotonic();
  }
  woke_for_arrival_ = false;
  for (std::size_t i = 0; i < kPorts; ++i) {
    poller_.watch(i, -1);
    ports_[i] = {};
  }
}

}  // namespace

std::unique_ptr<transports::Transport> make_transport(std::vector<RobotPlace> robots, BusOptions options) {
  return std::make_unique<Bus>(std::move(robots), std::move(options));
}

}  // namespace meca::ethercat
