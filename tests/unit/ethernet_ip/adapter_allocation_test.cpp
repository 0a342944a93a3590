// The adapter shares the thread of the simulated robot: after construction it must not allocate.

#include "tests/counted_new.hpp"
#include "tests/unit/ethernet_ip/adapter_rig.hpp"

namespace meca::ethernet_ip::adapter_test {
namespace {

TEST(AdapterAllocation, IsCountedByThisProgram) {
  const auto before = test::allocations;
  static int* volatile sink = nullptr;  // what nobody sees the compiler may leave out
  sink = new int(1);
  delete sink;
  EXPECT_GT(test::allocations, before);
}

TEST(AdapterAllocation, NeverHappensAfterConstruction) {
  AdapterRig rig;
  rig.enter();
  ASSERT_EQ(rig.open(usual_open()), "ok");
  const auto request = rig.rr(bytes("01 02 20 F5 24 01"));
  const auto list = bytes("63000000 00000000 00000000 0000000000000000 00000000");
  std::vector<std::byte> packet = written([&](wire::Writer& out) {
    write_io_packet(out, rig.opened.o_to_t_id, 0, 66);
    out.zeros(66);
  });
  image::InputBytes input{};

  const auto before = test::allocations;
  for (std::uint32_t i = 1; i <= 1000; ++i, rig.now += 10ms) {
    rig.adapter.tcp_accepted(1, kStranger, rig.now);
    rig.adapter.tcp_received(0, request, rig.now);
    rig.adapter.tcp_sent(0, rig.adapter.tcp_output(0).size());
    rig.adapter.udp_received(list, true);
    wire::Writer(std::span(packet).subspan(10, 4)).u32(i);
    rig.adapter.io_received({kOriginator, 2222}, packet, rig.now);
    rig.adapter.set_input(input);
    rig.adapter.tick(rig.now);
    while (rig.adapter.produce(rig.now)) {
    }
    rig.adapter.tcp_closed(1, rig.now);
  }
  EXPECT_EQ(test::allocations, before);
  EXPECT_EQ(rig.adapter.counters().produced, 1000u);
  EXPECT_TRUE(rig.adapter.connected());
}

}  // namespace
}  // namespace meca::ethernet_ip::adapter_test
