#include "contrib/formats/usd/usda_export.h"

#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

// What a file says is checked here; whether a reader finds every joint where it was, in
// usd_test.py.

namespace duet::contrib::formats::usd {
namespace {

std::string Export(const std::vector<motion::Clip>& people) {
  const absl::StatusOr<std::string> text = FormatUsda(people, motion::SbuSkeleton());
  EXPECT_THAT(text.status(), IsOk());
  return text.value_or("");
}

motion::Clip Person() {
  test::PersonOptions options;
  options.frames = 12;
  return test::MakePerson(options);
}

TEST(FormatUsda, StatesUnitAxisAndTimesOfTheClip) {
  const std::string text = Export({Person(), Person()});
  EXPECT_THAT(text, HasSubstr("#usda 1.0\n(\n"));
  for (const char* line :
       {"metersPerUnit = 1", "upAxis = \"Y\"", "startTimeCode = 0", "endTimeCode = 11",
        "timeCodesPerSecond = 30", "framesPerSecond = 30", "defaultPrim = \"pair\""}) {
    EXPECT_THAT(text, HasSubstr(std::string("    ") + line + "\n"));
  }
}

TEST(FormatUsda, EachPersonHasASkeletonAnimationAndSkin) {
  const std::string text = Export({Person(), Person()});
  for (const char* person : {"leader", "follower"}) {
    const std::string path = std::string("/pair/") + person;
    EXPECT_THAT(text, HasSubstr("def SkelRoot \"" + std::string(person) + "\""));
    EXPECT_THAT(text, HasSubstr("rel skel:animationSource = <" + path + "/skeleton/animation>"));
    EXPECT_THAT(text, HasSubstr("rel skel:skeleton = <" + path + "/skeleton>"));
    EXPECT_THAT(text, HasSubstr("rel material:binding = </pair/materials/" + std::string(person)));
  }
  EXPECT_THAT(text, HasSubstr("\"torso/torso_to_neck/neck\""));
}

TEST(FormatUsda, OnePersonIsWrittenWithoutAFollower) {
  const std::string text = Export({Person()});
  EXPECT_THAT(text, HasSubstr("defaultPrim = \"person_alone\""));
  EXPECT_THAT(text, HasSubstr("def SkelRoot \"person\""));
  EXPECT_THAT(text, Not(HasSubstr("follower")));
}

TEST(FormatUsda, RejectsPeopleWhoDoNotMatchTheSkeleton) {
  const auto error = [](const std::vector<motion::Clip>& people) {
    return std::string(FormatUsda(people, motion::SbuSkeleton()).status().message());
  };
  EXPECT_THAT(error({}), HasSubstr("people: expected one or two, got 0"));
  motion::Clip other = Person();
  other.joint_names[0] = "skull";
  EXPECT_THAT(error({other}), HasSubstr("expected the skeleton's 15 joints in its order"));
  motion::Clip longer = Person();
  longer.Append(std::vector<motion::Vec3>(15));
  EXPECT_THAT(error({Person(), longer}), HasSubstr("expected the same joints, frames and rate"));
}

}  // namespace
}  // namespace duet::contrib::formats::usd
