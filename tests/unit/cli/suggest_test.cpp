#include "cli/suggest.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "transports/image/nearest.hpp"

namespace meca::cli {
namespace {

using image::edit_distance;

const std::vector<std::string> kWords{"activate", "deactivate", "home", "move-joints", "move-lin"};

TEST(Suggest, CountsEditsAndTakesSwappedNeighboursForOne) {
  EXPECT_EQ(edit_distance("home", "home"), 0u);
  EXPECT_EQ(edit_distance("", "home"), 4u);
  EXPECT_EQ(edit_distance("hoem", "home"), 1u);
  EXPECT_EQ(edit_distance("hme", "home"), 1u);
  EXPECT_EQ(edit_distance("hoome", "home"), 1u);
  EXPECT_EQ(edit_distance("hose", "home"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(Suggest, DoesNotMindCapitals) { EXPECT_EQ(edit_distance("HOME", "home"), 0u); }

TEST(Suggest, FindsTheNearestWord) {
  EXPECT_EQ(nearest("actvate", kWords), "activate");
  EXPECT_EQ(nearest("deactivaet", kWords), "deactivate");
  EXPECT_EQ(nearest("mvoe-joint", kWords), "move-joints");
}

TEST(Suggest, SaysNothingWhenNothingIsNear) {
  EXPECT_EQ(nearest("reboot", kWords), std::nullopt);
  EXPECT_EQ(did_you_mean("xyz", kWords), "");
  EXPECT_EQ(did_you_mean("homme", kWords), ", did you mean 'home'?");
}

}  // namespace
}  // namespace meca::cli
