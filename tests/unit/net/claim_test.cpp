// A name for one process.
#include "transports/net/claim.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

namespace meca::net {
namespace {

std::string name(const char* what) { return "meca500/test/" + std::to_string(::getpid()) + "/" + what; }

TEST(Claim, IsHeldByOneAndFreeAgainAfterIt) {
  auto first = claim(name("a"));
  ASSERT_TRUE(first);
  EXPECT_FALSE(claim(name("a")));
  first.reset();
  EXPECT_TRUE(claim(name("a")));
}

TEST(Claim, OfAnotherNameIsNoneOfIts) {
  const auto first = claim(name("a"));
  EXPECT_TRUE(claim(name("ab")));
  EXPECT_TRUE(claim(name("b")));
}

}  // namespace
}  // namespace meca::net
