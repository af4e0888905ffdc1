#include <sys/resource.h>
#include <unistd.h>

#include <cstddef>
#include <string>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/flat/flat_files.h"
#include "nlohmann/json.hpp"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::flat {
namespace {

using Json = nlohmann::json;

Json OnePerson() {
  return {{"frame_rate_hz", 20},
          {"joint_names", {"a", "b"}},
          {"leader", {{{1, 2, 3}, {4, 5, 6}}, {{7, 8, 9}, {10, 11, 12.5}}}}};
}

std::string ParseError(const std::string& text) {
  const absl::StatusOr<motion::RecordedMotion> motion = ParseJsonMotion(text, "a.json");
  EXPECT_EQ(motion.status().code(), absl::StatusCode::kInvalidArgument) << motion.status();
  return std::string(motion.status().message());
}

std::string ErrorWith(const std::string& pointer, const Json& value) {
  Json document = OnePerson();
  document[Json::json_pointer(pointer)] = value;
  return ParseError(document.dump());
}

TEST(JsonMotion, ReadsOnePerson) {
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseJsonMotion(OnePerson().dump(), "a.json");
  ASSERT_TRUE(motion.ok()) << motion.status();
  ASSERT_EQ(motion->people.size(), 1u);
  EXPECT_EQ(motion->people[0].frame_rate_hz, 20);
  EXPECT_EQ(motion->people[0].at(1, 1), (motion::Vec3{10, 11, 12.5f}));
}

TEST(JsonMotion, ReadsBackAPairExactly) {
  const motion::ClipPair pair{test::MakePerson(), test::MakePerson({60, 3, 0, {0, 1, 1.2f}, 30})};
  const std::string text = FormatJsonMotion({pair.leader, pair.follower}, motion::SbuSkeleton());
  const absl::StatusOr<motion::RecordedMotion> motion = ParseJsonMotion(text, "a.json");
  ASSERT_TRUE(motion.ok()) << motion.status();
  ASSERT_EQ(motion->people.size(), 2u);
  EXPECT_EQ(motion->people[0].joint_names, pair.leader.joint_names);
  EXPECT_EQ(motion->people[0].poses, pair.leader.poses);
  EXPECT_EQ(motion->people[1].poses, pair.follower.poses);
  const Json document = Json::parse(text);
  EXPECT_EQ(document["format"], "duet-motion");
  EXPECT_EQ(document["unit"], "metres");
  EXPECT_EQ(document["up_axis"], "y-up");
  EXPECT_EQ(document["bones"].size(), 14u);
  EXPECT_EQ(document["bones"][0], Json({1, 0}));
  EXPECT_FALSE(document.contains("rig"));
  EXPECT_FALSE(document.contains("rotations"));
}

TEST(JsonMotion, WritesTheFollowersRotationsBesideThePair) {
  const motion::ClipPair pair{test::MakePerson(), test::MakePerson()};
  motion::JointRotations rotations;
  rotations.rig = {{"torso", -1, {}, 2}, {"neck", 0, {0, 0.25f, 0}, 1}};
  rotations.rotations = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}, {0.5f, 0.5f, -0.5f, 0.5f}};
  const std::string text =
      FormatJsonMotion({pair.leader, pair.follower}, motion::SbuSkeleton(), &rotations);
  const Json document = Json::parse(text);
  EXPECT_EQ(document["rig"][1], Json::parse(R"({"name": "neck", "parent": 0, "joint": 1,
                                               "offset": [0.0, 0.25, 0.0]})"));
  EXPECT_EQ(document["rotations"],
            Json::parse("[[[1,0,0,0], [0,1,0,0]], [[0,0,0,1], [0.5,0.5,-0.5,0.5]]]"));
  const absl::StatusOr<motion::RecordedMotion> motion = ParseJsonMotion(text, "a.json");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(motion->people[1].poses, pair.follower.poses);
}

TEST(JsonMotion, IgnoresUnknownFieldsByteOrderMarkAndWhiteSpace) {
  Json document = OnePerson();
  document["tool"] = {{"name", "other"}};
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseJsonMotion("\xEF\xBB\xBF\n" + document.dump(), "a.json");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(motion->people[0].poses,
            ParseJsonMotion(OnePerson().dump(), "a.json")->people[0].poses);
}

TEST(JsonMotion, RejectsRepeatedFields) {
  EXPECT_THAT(ParseError("{\"joint_names\": [\"a\"], \"joint_names\": [\"b\"]}"),
              HasSubstr("a.json: the field \"joint_names\" is repeated"));
}

TEST(JsonMotion, NamesTheFieldThatIsWrong) {
  EXPECT_THAT(ErrorWith("/frame_rate_hz", -1),
              HasSubstr("a.json: frame_rate_hz: expected a number from 0 to 1000, got -1"));
  EXPECT_THAT(ErrorWith("/frame_rate_hz", 0), HasSubstr("frame_rate_hz: "));
  EXPECT_THAT(ErrorWith("/frame_rate_hz", "x"), HasSubstr("frame_rate_hz: expected a number"));
  EXPECT_THAT(ErrorWith("/unit", "feet"), HasSubstr("unit: expected metres, "));
  EXPECT_THAT(ErrorWith("/up_axis", 3), HasSubstr("up_axis: expected y-up, z-up or y-down, got 3"));
  EXPECT_THAT(ErrorWith("/format", "glTF"),
              HasSubstr("format: expected \"duet-motion\", got \"glTF\""));
  EXPECT_THAT(ErrorWith("/version", 2),
              HasSubstr("version: expected a whole number from 1 to 1, got 2"));
  EXPECT_THAT(ErrorWith("/joint_names", Json::array()),
              HasSubstr("joint_names: expected at least one name, got none"));
  EXPECT_THAT(ErrorWith("/joint_names/1", 7),
              HasSubstr("joint_names: expected non-empty strings, got 7"));
  EXPECT_THAT(ErrorWith("/leader", Json::array()),
              HasSubstr("leader: expected at least 1 frame, got none"));
  EXPECT_THAT(ErrorWith("/leader", 1), HasSubstr("leader: expected an array"));
  EXPECT_THAT(ErrorWith("/leader/1", {{1, 2, 3}}),
              HasSubstr("leader[1]: expected a list of 2 positions, got 1"));
  EXPECT_THAT(ErrorWith("/leader/1/0", {1, 2}),
              HasSubstr("leader[1][0]: expected finite numbers [x, y, z], got 2"));
  EXPECT_THAT(ErrorWith("/leader/1/0/2", 1e30), HasSubstr("leader[1][0]: "));
  EXPECT_THAT(ErrorWith("/leader/1/0/2", nullptr), HasSubstr("leader[1][0]: "));
  EXPECT_THAT(ErrorWith("/follower", "none"), HasSubstr("follower: expected an array"));
}

TEST(JsonMotion, RejectsTextThatIsNotAJsonObject) {
  EXPECT_THAT(ParseError(""), HasSubstr("a.json: not a JSON object"));
  EXPECT_THAT(ParseError("{\"leader\": [[[1e999"), HasSubstr("a.json: not JSON at byte"));
  EXPECT_THAT(ParseError("[1, 2]"), HasSubstr("expected '{'"));
  EXPECT_THAT(ParseError("{}"), HasSubstr("joint_names: missing"));
  EXPECT_THAT(ParseError("{\"joint_names\": [\"a\"]}"), HasSubstr("leader: missing"));
  EXPECT_THAT(ParseError("{\"unit\": \"\xff\xfe\"}"), HasSubstr("a.json"));
}

// A list of `count` values where frames belong.
std::string WithFrames(std::size_t count, const char* frame) {
  std::string text = "{\"joint_names\": [\"a\"], \"frame_rate_hz\": 30, \"leader\": [";
  for (std::size_t i = 0; i < count; ++i) absl::StrAppend(&text, i == 0 ? "" : ",", frame);
  return text + "]}";
}

#if !defined(__SANITIZE_ADDRESS__)
// Ends the process: 0 where the text was refused within 400 MB of address space.
[[noreturn]] void ParseInLittleMemory(const std::string& text) {
  const rlimit limit = {rlim_t{400} << 20, rlim_t{400} << 20};
  setrlimit(RLIMIT_AS, &limit);
  _exit(ParseJsonMotion(text, "a.json").ok() ? 1 : 0);
}

// Parsed as a whole, 24 MB of "[]," take more than 500 MB.
TEST(JsonMotion, RejectsFramesWithoutPositionsInLittleMemory) {
  const std::string text = WithFrames(8'000'000, "[]");
  EXPECT_EXIT(ParseInLittleMemory(text), ::testing::ExitedWithCode(0), "");
}
#endif

TEST(JsonMotion, LimitsFramesJointsAndCoordinates) {
  EXPECT_THAT(ParseJsonMotion(WithFrames(200'001, "[[0,0,0]]"), "a.json").status().message(),
              HasSubstr("leader: expected at most 200000 frames, got more"));
  for (const char* frame : {"[[0,0,0],[0,0,0]]", "[[0,0,0,0]]", "[[0,0,0,0,0,0]]", "[[0,0,[0]]]",
                            "[[0,0,{\"x\":0}]]", "{\"a\":[0,0,0]}", "[]", "[[]]", "0", "[0]"}) {
    EXPECT_THAT(ParseJsonMotion(WithFrames(2, frame), "a.json").status().message(),
                HasSubstr("leader[0]"))
        << frame;
  }
}

TEST(JsonMotion, RejectsDeepNestingBeforeItCostsMemory) {
  EXPECT_THAT(ParseError("{\"a\": " + std::string(2'000'000, '[')),
              HasSubstr("nested deeper than 8"));
  Json document = OnePerson();
  document["joint_names"][0] = "[[[[[[[[[[[[";
  EXPECT_TRUE(ParseJsonMotion(document.dump(), "a.json").ok());
}

}  // namespace
}  // namespace duet::formats::flat
