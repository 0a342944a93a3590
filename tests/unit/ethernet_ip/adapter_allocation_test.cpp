// The adapter shares the thread of the simulated robot: after construction it must not allocate.
#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/unit/ethernet_ip/adapter_rig.hpp"

namespace {
std::atomic<std::uint64_t> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size != 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
}  // namespace

// Replaces the global ones for this test program; the array forms end here too. The nothrow form would as well, but
// AddressSanitizer brings one of its own, and googletest 1.16 uses it: freeing that here would be a mismatch.
void* operator new(std::size_t size) { return counted(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size != 0 ? size : 1);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace meca::ethernet_ip::adapter_test {
namespace {

TEST(AdapterAllocation, IsCountedByThisProgram) {
  const auto before = allocations.load();
  delete new int(1);
  EXPECT_GT(allocations.load(), before);
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

  const auto before = allocations.load();
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
  EXPECT_EQ(allocations.load(), before);
  EXPECT_EQ(rig.adapter.counters().produced, 1000u);
  EXPECT_TRUE(rig.adapter.connected());
}

}  // namespace
}  // namespace meca::ethernet_ip::adapter_test
