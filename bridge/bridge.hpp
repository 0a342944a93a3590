// The bridge as an object: DDS on one side, buses on the other, threads in between. main.cpp makes one; so do tests.
#pragma once

#include <memory>

#include "bridge/config.hpp"

namespace meca::bridge {

class Bridge {
 public:
  // Opens DDS and the buses. Throws std::runtime_error (dds::Error among them) with a sentence for the user.
  explicit Bridge(const Config& config);
  ~Bridge();  // stops if still running
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;

  void start();
  // Stop image first, then the protocols' good-bye, then DDS; within 2 s.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meca::bridge
