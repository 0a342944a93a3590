// `meca-ctl errors`, and docs/errors.md, which is printed from it: MECA_UPDATE=1 writes the page anew.
#include "cli/errors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cli/plan.hpp"

namespace meca::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string refusal_of(std::string_view word) {
  try {
    find_trouble(word);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "(found)";
}

TEST(Errors, OneCodeIsExplainedWithCauseAndRemedyInTheOrderOfDoing) {
  EXPECT_EQ(explain(find_trouble("1007")),
            "1007  JOINT_OVER_LIMIT\n"
            "  What     the target lies outside a joint limit\n"
            "  Cause    likely: the requested joint set or pose needs a joint beyond its model or user limit\n"
            "  Remedy   'meca-ctl reset-error' and, with the motors on, 'meca-ctl resume', then choose another target "
            "or posture, or widen the "
            "user joint limits\n"
            "  Reset    ResetError clears it; the robot stays paused until it is resumed\n");
  EXPECT_THAT(explain(find_trouble("3006")), HasSubstr("ResetError does not clear it\n"));
}

TEST(Errors, AStopIsExplainedByItsCodeInTheRobotsLog) {
  EXPECT_EQ(explain(find_trouble("3032")),
            "3032  P-Stop 2\n"
            "  What     the protective stop that halts the arm and leaves its motors on\n"
            "  Cause    likely: a door, light curtain or switch on this input is open\n"
            "  Remedy   release it, then 'meca-ctl resume'\n"
            "  Reset    ResumeMotion, once the cause is gone\n"
            "  Where    SafetyStatus.PStop2, byte 128:2\n");
  EXPECT_THAT(explain(find_trouble("3070")),
              HasSubstr("release it, then press Reset on the power supply, then 'meca-ctl activate'"));
  EXPECT_THAT(explain(find_trouble("3081")), HasSubstr("other robots: a Meca500 leaves it 0"));
}

TEST(Errors, AreFoundByNameInAnyCase) {
  EXPECT_EQ(find_trouble("joint_over_limit"), find_trouble("1007"));
  EXPECT_EQ(find_trouble("EStop"), find_trouble("3070"));
  EXPECT_EQ(find_trouble("e-stop"), find_trouble("3070"));
}

TEST(Errors, AnUnknownCodeIsSaidAndAMistypedNameGuessed) {
  EXPECT_EQ(refusal_of("4711"),
            "no document names an error or stop '4711'; 'meca-ctl errors' lists those that are known");
  EXPECT_EQ(refusal_of("99999999999999999999"),
            "no document names an error or stop '99999999999999999999'; 'meca-ctl errors' lists those that are known");
  EXPECT_EQ(refusal_of("JOINT_OVER_LIMITS"),
            "no document names an error or stop 'JOINT_OVER_LIMITS', did you mean 'JOINT_OVER_LIMIT'?");
  EXPECT_EQ(refusal_of("0"), "error code 0 means that there is no error");
}

TEST(Errors, TheListHasALineForEach) {
  const std::string list = troubles_list();
  EXPECT_THAT(list, StartsWith("Code  Reset         Name"));
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(list, '\n')), 1 + all_troubles().size() + 2);
  EXPECT_EQ(all_troubles().size(), 86U) << "75 errors, 11 stops";
}

TEST(Errors, JsonSaysWhichKindAndWhatResetsIt) {
  EXPECT_EQ(to_json(find_trouble("3005"))["kind"], "error");
  EXPECT_EQ(to_json(find_trouble("3005"))["code"], 3005);
  EXPECT_EQ(to_json(find_trouble("3005"))["resettable"], true);
  const Json stop = to_json(find_trouble("3086"));
  EXPECT_EQ(stop["kind"], "stop");
  EXPECT_EQ(stop["name"], "ConnectionDropped");
  EXPECT_EQ(stop["reset_by"], "ResumeMotion");
  EXPECT_EQ(stop["on_meca500"], true);
}

TEST(Errors, NoTextBreaksTheTablesOfThePage) {
  for (const Trouble& trouble : all_troubles()) {
    EXPECT_EQ(explain(trouble).find('|'), std::string::npos) << explain(trouble);
  }
}

TEST(ErrorsPage, IsWhatTheTablesPrint) {
  const std::string path = std::string(MECA_SOURCE_DIR) + "/docs/errors.md";
  if (std::getenv("MECA_UPDATE") != nullptr) std::ofstream(path) << troubles_page();
  std::ifstream in(path);
  ASSERT_TRUE(in) << path;
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(text, troubles_page()) << "MECA_UPDATE=1 writes it anew";
}

}  // namespace
}  // namespace meca::cli
