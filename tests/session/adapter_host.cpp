#include "tests/session/adapter_host.hpp"

#include <algorithm>

#include "transports/image/codec.hpp"
#include "transports/net/clock.hpp"

namespace meca::test {

using namespace ethernet_ip;
using namespace std::chrono_literals;

namespace {
constexpr std::size_t kListener = 0, kIo = 1, kTcp = 2;  // slots of the poller
}

AdapterSettings meca500_at(const std::string& address) {
  AdapterSettings out;
  out.identity = {.vendor_id = kMecademicVendor,
                  .device_type = kRobotDeviceType,
                  .product_code = kMeca500ProductCode,
                  .major = 11,
                  .minor = 3,
                  .serial_number = 4711};
  out.identity.set_name("Meca500");
  out.address = net::parse_ipv4(address).value();
  return out;
}

AdapterHost::Sockets::Sockets(std::uint32_t address, std::uint16_t io_port)
    : listener({address, kTcpPort}), io({address, io_port}, {.multicast_interface = address}) {}

AdapterHost::AdapterHost(const AdapterSettings& settings, std::optional<sim::RobotOptions> model)
    : address_(settings.address),
      io_port_(settings.io_port),
      adapter_(settings),
      poller_(kTcp + Adapter::kMostConnections) {
  if (model) {
    layout_ = model->layout;
    model_.emplace(*model);
  }
  plug_in();
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

AdapterHost::~AdapterHost() = default;

void AdapterHost::plug_in() {
  const std::lock_guard lock(mutex_);
  sockets_ = std::make_unique<Sockets>(address_, io_port_);
}

void AdapterHost::unplug() {
  const std::lock_guard lock(mutex_);
  sockets_.reset();
  for (std::size_t id = 0; id < Adapter::kMostConnections; ++id) adapter_.tcp_closed(id, net::monotonic());
}

void AdapterHost::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      const std::lock_guard lock(mutex_);
      watch();
    }
    poller_.wait(net::monotonic() + 1ms);
    const std::lock_guard lock(mutex_);
    serve(net::monotonic());
  }
}

void AdapterHost::watch() {
  poller_.watch(kListener, sockets_ ? sockets_->listener.descriptor() : -1);
  poller_.watch(kIo, sockets_ ? sockets_->io.descriptor() : -1);
  for (std::size_t id = 0; id < Adapter::kMostConnections; ++id) {
    poller_.watch(kTcp + id, sockets_ ? sockets_->tcp[id].descriptor() : -1);
  }
}

void AdapterHost::serve(Time now) {
  if (model_) step_model(now);
  adapter_.tick(now);
  if (sockets_) {
    serve_tcp(now);
    serve_io(now);
  } else {
    while (adapter_.produce(now)) {  // into a cable that is not there
    }
  }
}

void AdapterHost::serve_tcp(Time now) {
  auto& tcp = sockets_->tcp;
  const auto free = std::ranges::find_if(tcp, [](const auto& stream) { return !stream; });
  if (free != tcp.end()) {
    if (auto stream = sockets_->listener.accept()) {
      *free = std::move(*stream);
      adapter_.tcp_accepted(static_cast<std::size_t>(free - tcp.begin()), free->peer().ipv4, now);
    }
  }
  std::array<std::byte, 512> buffer;
  for (std::size_t id = 0; id < tcp.size(); ++id) {
    if (!tcp[id]) continue;
    auto got = tcp[id].receive(buffer);
    adapter_.tcp_received(id, Bytes(buffer).first(got.bytes), now);
    if (!got.closed) {
      const auto sent = tcp[id].send(adapter_.tcp_output(id));
      adapter_.tcp_sent(id, sent.bytes);
      got.closed = sent.closed || (adapter_.wants_closed(id) && adapter_.tcp_output(id).empty());
    }
    if (!got.closed) continue;
    adapter_.tcp_closed(id, now);
    tcp[id].close();
  }
}

void AdapterHost::serve_io(Time now) {
  std::array<std::byte, 1500> buffer;
  while (const auto got = sockets_->io.receive(buffer)) {
    adapter_.io_received({got->from.ipv4, got->from.port}, Bytes(buffer).first(std::min(got->size, buffer.size())),
                         now);
  }
  while (const auto out = adapter_.produce(now)) sockets_->io.send({out->to.ipv4, out->to.port}, out->bytes);
}

void AdapterHost::step_model(Time now) {
  const Time dt = stepped_ == Time{} ? 1ms : std::clamp<Time>(now - stepped_, 1us, 100ms);
  stepped_ = now;
  const image::Format format{layout_, std::endian::little};
  if (adapter_.connected() && adapter_.run()) {
    model_->step(image::decode_outputs(adapter_.output(), format), dt);
  } else {
    model_->step_without_outputs(dt);
  }
  image::InputBytes input{};
  image::encode_inputs(model_->inputs(), format, input);
  adapter_.set_input(input);
}

}  // namespace meca::test
