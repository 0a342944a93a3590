#include "tests/session/chain_host.hpp"

#include <algorithm>

#include "transports/image/codec.hpp"
#include "transports/net/clock.hpp"

namespace meca::test {

using namespace ethercat;
using namespace std::chrono_literals;

namespace {

constexpr int kMostFrames = 64;  // of one round, so that a test gets its turn

std::vector<Device> devices_of(const ChainOptions& options) {
  std::vector<Device> out;
  for (const DeviceSettings& settings : options.robots) out.emplace_back(settings);
  return out;
}

std::vector<Device*> pointers_to(std::vector<Device>& devices) {
  std::vector<Device*> out;
  for (Device& device : devices) out.push_back(&device);
  return out;
}

}  // namespace

ChainHost::ChainHost(const ChainOptions& options)
    : devices_(devices_of(options)), chain_(pointers_to(devices_)), poller_(2) {
  for (const DeviceSettings& robot : options.robots) {
    layouts_.push_back(robot.layout);
    if (!options.model) continue;
    sim::RobotOptions model = *options.model;
    model.layout = robot.layout;
    models_.emplace_back(model);
  }
  ports_[0] = net::RawEthernet(options.interface, kEtherType);
  if (!options.redundant_interface.empty()) {
    ports_[1] = net::RawEthernet(options.redundant_interface, kEtherType);
    chain_.set_ring(true);
  }
  for (std::size_t port = 0; port < ports_.size(); ++port) poller_.watch(port, ports_[port].descriptor());
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

ChainHost::~ChainHost() = default;

void ChainHost::power_cycle(std::size_t robot) {
  const std::lock_guard lock(mutex_);
  devices_[robot].power_cycle(net::monotonic());
  if (!models_.empty()) models_[robot].power_cycle();
}

void ChainHost::swallow_replies(bool on) {
  const std::lock_guard lock(mutex_);
  swallow_ = on;
}

void ChainHost::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    poller_.wait(net::monotonic() + 500us);
    const std::lock_guard lock(mutex_);
    serve(net::monotonic());
  }
}

void ChainHost::serve(Time now) {
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    if (poller_.ready(port)) pass_frames(port, now);
  }
  for (Device& device : devices_) device.tick(now);
  if (models_.empty() || now - stepped_ < 500us) return;
  const Time dt = stepped_ == Time{} ? Time(1ms) : std::min<Time>(now - stepped_, 100ms);
  stepped_ = now;
  for (std::size_t i = 0; i < models_.size(); ++i) step_model(i, dt);
}

void ChainHost::pass_frames(std::size_t port, Time now) {
  for (int i = 0; i < kMostFrames; ++i) {
    const auto size = ports_[port].receive(buffer_);
    if (!size) return;
    const auto frame = std::span(buffer_).first(std::min(*size, buffer_.size()));
    const auto out = chain_.process(static_cast<Chain::Side>(port), frame, now);
    if (out && !swallow_) ports_[static_cast<std::size_t>(*out)].send(frame);
  }
}

void ChainHost::step_model(std::size_t robot, Time dt) {
  Device& device = devices_[robot];
  sim::Robot& model = models_[robot];
  const image::Format format{layouts_[robot], std::endian::little};
  if (device.operational()) {
    model.step(image::decode_outputs(device.output(), format), dt);
  } else {
    model.step_without_outputs(dt);
  }
  image::InputBytes input{};
  image::encode_inputs(model.inputs(), format, input);
  device.set_input(input);
}

}  // namespace meca::test
