// The wire as the bridge publishes it: MotionControl and MotionCommand at every_cycle. A sample's header.cycle is the
// cycle whose step computed the image, header.receive_time_ns the bridge's stamp of that cycle (on the built-in robot
// every image is fresh).
#pragma once

#include <cstdint>

#include "bridge/dds.hpp"
#include "idl/types.hpp"
#include "tests/bench/wire_image.hpp"

namespace meca::bench {

class WireLog {
 public:
  explicit WireLog(dds::Participant& participant);

  void pump();  // takes what has arrived
  const WireImages& images() const { return images_; }
  void forget_before(std::uint64_t cycle) { images_.erase(images_.begin(), images_.lower_bound(cycle)); }

 private:
  dds::Reader<meca500::MotionControl> control_;
  dds::Reader<meca500::MotionCommand> command_;
  WireImages images_;
};

// The lines of a configuration that make the bridge publish what a WireLog needs.
inline constexpr const char* kWireLogTopics =
    "    MotionControl: {rate: every_cycle, depth: 2000}\n"
    "    MotionCommand: {rate: every_cycle, depth: 2000}\n";

}  // namespace meca::bench
