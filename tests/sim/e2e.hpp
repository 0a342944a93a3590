// What the end-to-end tests share: participants on loopback, and waiting for a condition with a generous end.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "bridge/dds.hpp"

namespace meca::test {

using namespace std::chrono_literals;

// Every test file has DDS domains of its own, from 50 on.
inline constexpr int kDdsDomain = 50;
inline constexpr int kBridgeDomain = 51;

inline constexpr auto kPoll = 20ms;
inline constexpr auto kPatience = 30s;  // the end of hope, not an expectation: sanitizers on a busy machine are slow

inline dds::ParticipantOptions local(int domain, const std::string& name) {
  return {.domain = domain, .name = name, .interfaces = {"127.0.0.1"}};
}

// True as soon as the condition holds.
inline bool eventually(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

}  // namespace meca::test
