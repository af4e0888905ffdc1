#include "client/cli/reaction.h"

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::cli {
namespace {

using ::testing::_;

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;

TEST(ParseClassWeightTest, ReadsANameAndAWeight) {
  const absl::StatusOr<ClassWeight> weight = ParseClassWeight("shake_hands=-0.5");
  ASSERT_THAT(weight, IsOk());
  EXPECT_EQ(weight->interaction_class, "shake_hands");
  EXPECT_EQ(weight->weight, -0.5f);
  EXPECT_EQ(ParseClassWeight("kick")->weight, 1);
  for (const char* text : {"", "kick=", "=1", "kick=hard", "kick=1x", "kick=1=2"}) {
    EXPECT_THAT(
        ParseClassWeight(text),
        StatusIs(kInvalid, AllOf(HasSubstr(text), HasSubstr("expected CLASS or CLASS=WEIGHT"))));
  }
}

TEST(ParseKeyframeTest, ReadsAFrameAndWeights) {
  const absl::StatusOr<WeightKeyframe> keyframe = ParseKeyframe("30:kick=1,hug=0");
  ASSERT_THAT(keyframe, IsOk());
  EXPECT_EQ(keyframe->frame, 30);
  ASSERT_THAT(keyframe->weights, SizeIs(2));
  EXPECT_EQ(keyframe->weights[1].interaction_class, "hug");
  EXPECT_EQ(keyframe->weights[1].weight, 0);
  for (const char* text : {"", "30", "30:", "kick=1", "-1:kick=1", "x:kick=1",
                           "30:kick=", "30:kick=1,", "30:,kick=1", "8.5:kick", "8b:kick"}) {
    EXPECT_THAT(ParseKeyframe(text), StatusIs(kInvalid, HasSubstr("expected FRAME:CLASS=WEIGHT")))
        << text;
  }
}

TEST(ParseModelChoiceTest, ReadsNameVersionAndLabel) {
  EXPECT_EQ(ParseModelChoice("sbu")->name, "sbu");
  EXPECT_EQ(ParseModelChoice("sbu")->version, std::nullopt);
  EXPECT_EQ(ParseModelChoice("sbu@12")->version, 12);
  EXPECT_EQ(ParseModelChoice("sbu:canary")->version_label, "canary");
  for (const char* text : {"", "@1", ":stable", "sbu@", "sbu@0", "sbu@-1", "sbu@one", "sbu:"}) {
    EXPECT_THAT(ParseModelChoice(text), StatusIs(kInvalid, HasSubstr("expected NAME")));
  }
}

TEST(ParseSeedTest, ReadsEverySeedAndRejectsOtherForms) {
  EXPECT_EQ(*ParseSeed("0"), 0u);
  EXPECT_EQ(*ParseSeed("18446744073709551615"), 18446744073709551615u);
  for (const char* text : {"", "-1", "1.5", "18446744073709551616", "random"}) {
    EXPECT_THAT(ParseSeed(text),
                StatusIs(kInvalid, HasSubstr("expected a whole number from 0 to")));
  }
}

// A text in a file.
class RequestFileTest : public ::testing::Test {
 protected:
  absl::StatusOr<SynthesisRequest> Read(const std::string& text) {
    test::WriteTestFile(file_, text);
    return ReadRequestFile(file_);
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "request.textproto";
};

TEST_F(RequestFileTest, HasEveryFieldOfARequestButTheLeader) {
  const absl::StatusOr<SynthesisRequest> request = Read(R"(
      model { name: "sbu" version: 2 }
      label_keyframes { frame: 0 label_vector { weights { interaction_class: "hug" weight: 1 } } }
      label_keyframes { frame: 9 label_vector { weights { interaction_class: "kick" weight: -1 } } }
      follower_start { root_position { x: 1 y: 1.1 z: -2 } }
      chunk_frames: 8  priority: PRIORITY_BULK  partner_direction { x: 1 z: -1 }
      seed: 7  variety: 0.25  reaction: 1.5  clean_up: CLEAN_UP_OFF  candidates: 4  reply_rotations: true
      up { x: 0.1 y: 1 }
      constraints { joint_name: "head" frame: 3 position { y: 1.5 } softness: 0.5 })");
  ASSERT_THAT(request, IsOk());
  EXPECT_EQ(request->model.name, "sbu");
  EXPECT_EQ(request->model.version, 2);
  EXPECT_TRUE(request->weights.empty());
  ASSERT_THAT(request->keyframes, SizeIs(2));
  EXPECT_EQ(request->keyframes[1].frame, 9);
  EXPECT_EQ(request->keyframes[1].weights[0].weight, -1);
  EXPECT_EQ(std::get<motion::Vec3>(*request->follower_start), (motion::Vec3{1, 1.1f, -2}));
  EXPECT_EQ(request->chunk_frames, 8);
  EXPECT_EQ(request->priority, Priority::kBulk);
  EXPECT_EQ(request->partner_direction, (motion::Vec3{1, 0, -1}));
  EXPECT_EQ(request->seed, 7u);
  EXPECT_EQ(request->variety, 0.25f);
  EXPECT_EQ(request->reaction, 1.5f);
  EXPECT_EQ(request->clean_up, false);
  EXPECT_EQ(request->candidates, 4);
  EXPECT_TRUE(request->rotations);
  EXPECT_EQ(request->up, (motion::Vec3{0.1f, 1, 0}));
  const auto pose = Read("follower_start { pose { positions: [1, 2, 3, 4, 5, 6] } }");
  ASSERT_THAT(pose, IsOk());
  EXPECT_THAT(std::get<1>(*pose->follower_start),
              ElementsAre(motion::Vec3{1, 2, 3}, motion::Vec3{4, 5, 6}));
  EXPECT_EQ(pose->clean_up, std::nullopt);
  ASSERT_THAT(request->constraints, SizeIs(1));
  EXPECT_EQ(request->constraints[0].position, (motion::Vec3{0, 1.5f, 0}));
  EXPECT_EQ(request->constraints[0].softness, 0.5f);
}

TEST_F(RequestFileTest, ErrorsNameTheFileAndThePlaceOrTheField) {
  const std::pair<const char*, const char*> cases[] = {
      {"seed: 1\nvarity: 0.5\n", "request.textproto: line 2:7: "},
      {"seed: 'x'", "request.textproto: line 1:7: "},
      {"reply_joint_names: 'head'", "reply_joint_names: expected none"},
      {"priority: PRIORITY_UNSPECIFIED", "priority: expected PRIORITY_INTERACTIVE or"},
      {"leader { frame_count: 1 }", "leader: expected none: a flag names its file"}};
  for (const auto& [text, message] : cases) {
    EXPECT_THAT(Read(text), StatusIs(kInvalid, HasSubstr(message))) << text;
  }
  EXPECT_THAT(ReadRequestFile(folder_ / "no"), StatusIs(absl::StatusCode::kNotFound, _));
}

}  // namespace
}  // namespace duet::client::cli
