#include "client/cli/value_syntax.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::cli {
namespace {

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;

TEST(ParseClassWeightTest, ReadsNameAndWeight) {
  const absl::StatusOr<ClassWeight> weight = ParseClassWeight("shake_hands=-0.5");
  ASSERT_THAT(weight, IsOk());
  EXPECT_EQ(weight->interaction_class, "shake_hands");
  EXPECT_EQ(weight->weight, -0.5f);
}

TEST(ParseClassWeightTest, NameWithoutWeightHasWeightOne) {
  const absl::StatusOr<ClassWeight> weight = ParseClassWeight("kick");
  ASSERT_THAT(weight, IsOk());
  EXPECT_EQ(weight->interaction_class, "kick");
  EXPECT_EQ(weight->weight, 1);
}

TEST(ParseClassWeightTest, RejectsOtherForms) {
  for (const char* text : {"", "kick=", "=1", "kick=hard", "kick=1x", "kick=1=2"}) {
    EXPECT_THAT(
        ParseClassWeight(text),
        StatusIs(kInvalid, AllOf(HasSubstr(text), HasSubstr("expected CLASS or CLASS=WEIGHT"))));
  }
}

TEST(ParseKeyframeTest, ReadsFrameAndWeights) {
  const absl::StatusOr<KeyframeArgument> keyframe = ParseKeyframe("30:kick=1,hug=0");
  ASSERT_THAT(keyframe, IsOk());
  EXPECT_EQ(keyframe->frame, 30);
  EXPECT_EQ(keyframe->beats, std::nullopt);
  ASSERT_THAT(keyframe->weights, SizeIs(2));
  EXPECT_EQ(keyframe->weights[1].interaction_class, "hug");
  EXPECT_EQ(keyframe->weights[1].weight, 0);
}

TEST(ParseKeyframeTest, ReadsAPositionInBeats) {
  const absl::StatusOr<KeyframeArgument> keyframe = ParseKeyframe("8b:kick=1,hug");
  ASSERT_THAT(keyframe, IsOk());
  EXPECT_EQ(keyframe->beats, 8);
  EXPECT_THAT(keyframe->weights, SizeIs(2));
  EXPECT_EQ(ParseKeyframe("0b:kick")->beats, 0);
  EXPECT_EQ(ParseKeyframe("8.5b:kick")->beats, 8.5);
}

TEST(ParseKeyframeTest, RejectsOtherForms) {
  for (const char* text :
       {"", "30", "30:", "kick=1", "-1:kick=1", "x:kick=1", "30:kick=", "30:kick=1,", "30:,kick=1",
        "8.5:kick", "b:kick", "-1b:kick", "8bb:kick", "8 beats:kick", "infb:kick", "8b"}) {
    EXPECT_THAT(ParseKeyframe(text), StatusIs(kInvalid, HasSubstr("expected FRAME:CLASS=WEIGHT")))
        << text;
  }
}

TEST(ParsePinTest, ReadsJointFramePositionAndSoftness) {
  const absl::StatusOr<JointConstraint> pin = ParsePin("right_hand@40=-0.2,1.3,5e-1");
  ASSERT_THAT(pin, IsOk());
  EXPECT_EQ(pin->joint, "right_hand");
  EXPECT_EQ(pin->frame, 40);
  EXPECT_EQ(pin->position, (motion::Vec3{-0.2f, 1.3f, 0.5f}));
  EXPECT_EQ(pin->softness, 0);
  EXPECT_EQ(ParsePin("head@0=0,1,2,0.25")->softness, 0.25f);
  EXPECT_EQ(ParsePin("head@0=0,1,2,1")->softness, 1);
}

TEST(ParsePinTest, RejectsOtherForms) {
  for (const char* text :
       {"", "head", "head@3", "head@3=", "head@3=0,1", "head@3=0,1,2,3", "head@3=0,1,2,-0.1",
        "head@3=0,1,2,", "head@3=0,1,2,0,0", "head@3=0,1,nan", "head@3=0,inf,2", "head@3=0,1,2,nan",
        "@3=0,1,2", "head@=0,1,2", "head@-1=0,1,2", "head@1.5=0,1,2", "head=0,1,2", "3@head=0,1,2",
        "head@3=a,b,c"}) {
    EXPECT_THAT(ParsePin(text), StatusIs(kInvalid, HasSubstr("expected JOINT@FRAME=X,Y,Z")))
        << text;
  }
}

TEST(ParseBeatTest, ReadsRateAndFirstBeat) {
  EXPECT_EQ(ParseBeat("180")->per_minute, 180);
  EXPECT_EQ(ParseBeat("180")->first_seconds, 0);
  EXPECT_EQ(ParseBeat("92.5,1.25")->per_minute, 92.5);
  EXPECT_EQ(ParseBeat("92.5,1.25")->first_seconds, 1.25);
  EXPECT_THAT(ParseBeat("20"), IsOk());
  EXPECT_THAT(ParseBeat("400"), IsOk());
  EXPECT_EQ(ParseBeat("120,-0.5")->first_seconds, -0.5);  // one beat
}

TEST(ParseBeatTest, RejectsOtherForms) {
  for (const char* text :
       {"", "fast", "180bpm", "180,", ",1", "180,soon", "180,0,1", "nan", "inf", "180,inf"}) {
    EXPECT_THAT(ParseBeat(text), StatusIs(kInvalid, HasSubstr("expected BPM or BPM,OFFSET")))
        << text;
  }
}

TEST(ParseBeatTest, RejectsRatesAndOffsetsOutOfRange) {
  for (const char* text : {"19.9", "400.1", "0", "-180"}) {
    EXPECT_THAT(ParseBeat(text), StatusIs(kInvalid, HasSubstr("expected a BPM from 20 to 400")))
        << text;
  }
  EXPECT_THAT(ParseBeat("120,-0.51"),
              StatusIs(kInvalid, HasSubstr("expected an OFFSET of at least -0.5 s (one beat), got "
                                           "\"120,-0.51\"")));
}

TEST(ParseModelChoiceTest, ReadsNameVersionAndLabel) {
  absl::StatusOr<ModelChoice> choice = ParseModelChoice("sbu");
  ASSERT_THAT(choice, IsOk());
  EXPECT_EQ(choice->name, "sbu");
  EXPECT_EQ(choice->version, std::nullopt);
  EXPECT_EQ(choice->version_label, "");

  choice = ParseModelChoice("sbu@12");
  ASSERT_THAT(choice, IsOk());
  EXPECT_EQ(choice->name, "sbu");
  EXPECT_EQ(choice->version, 12);

  choice = ParseModelChoice("sbu:canary");
  ASSERT_THAT(choice, IsOk());
  EXPECT_EQ(choice->version, std::nullopt);
  EXPECT_EQ(choice->version_label, "canary");
}

TEST(ParseModelChoiceTest, RejectsOtherForms) {
  for (const char* text : {"", "@1", ":stable", "sbu@", "sbu@0", "sbu@-1", "sbu@one", "sbu:"}) {
    EXPECT_THAT(ParseModelChoice(text), StatusIs(kInvalid, HasSubstr("expected NAME")));
  }
}

TEST(ParseJointPairTest, ReadsBothNames) {
  const auto joints = ParseJointPair("left_hand=mixamorig:LeftHand");
  ASSERT_THAT(joints, IsOk());
  EXPECT_EQ(joints->first, "left_hand");
  EXPECT_EQ(joints->second, "mixamorig:LeftHand");
}

TEST(ParseJointPairTest, RejectsOtherForms) {
  for (const char* text : {"", "left_hand", "left_hand=", "=LeftHand"}) {
    EXPECT_THAT(ParseJointPair(text), StatusIs(kInvalid, HasSubstr("expected MODEL_JOINT")));
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

TEST(ParseVarietyTest, ReadsZeroToTwoAndRejectsOtherValues) {
  EXPECT_EQ(*ParseVariety("0"), 0);
  EXPECT_EQ(*ParseVariety("0.75"), 0.75f);
  EXPECT_EQ(*ParseVariety("2"), 2);
  for (const char* text : {"", "-0.1", "2.1", "nan", "inf", "much"}) {
    EXPECT_THAT(ParseVariety(text), StatusIs(kInvalid, HasSubstr("expected a number from 0 to 2")));
  }
}

TEST(ParsePointTest, ReadsThreeNumbersAndRejectsOtherForms) {
  EXPECT_EQ(ParsePoint("0.5,1,-2"), (motion::Vec3{0.5f, 1, -2}));
  for (const char* text : {"", "1,2", "1,2,3,4", "a,b,c", "start.bvh"}) {
    EXPECT_EQ(ParsePoint(text), std::nullopt) << text;
  }
}

TEST(ParseDirectionTest, ErrorStatesTheExpectedForm) {
  EXPECT_EQ(*ParseDirection("0,0,-3"), (motion::Vec3{0, 0, -3}));
  EXPECT_THAT(ParseDirection("north").status().message(), ::testing::HasSubstr("expected X,Y,Z"));
}

TEST(ParseUnitTest, ReadsNames) {
  const absl::StatusOr<motion::LengthUnit> unit = ParseUnit("millimetres");
  ASSERT_THAT(unit, IsOk());
  EXPECT_EQ(*unit, motion::LengthUnit::kMillimetres);
  for (const char* text : {"feet", "mm"}) {
    EXPECT_THAT(ParseUnit(text),
                StatusIs(kInvalid, HasSubstr("expected metres, millimetres or sbu-")));
  }
}

TEST(ParseAxisTest, ReadsNames) {
  const absl::StatusOr<motion::UpAxis> axis = ParseAxis("y-down");
  ASSERT_THAT(axis, IsOk());
  EXPECT_EQ(*axis, motion::UpAxis::kYDown);
  EXPECT_THAT(ParseAxis("x"),
              StatusIs(kInvalid, HasSubstr("expected y-up, z-up or y-down, got \"x\"")));
}

}  // namespace
}  // namespace duet::client::cli
