#include "model/dataset/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/dataset/dataset.h"
#include "nlohmann/json.hpp"
#include "tests/support/matchers.h"

namespace duet::dataset {
namespace {

using Json = nlohmann::json;

// A stick figure in the own-data layout, complete.
Json Complete() {
  return Json::parse(R"({
    "name": "sticks", "frame_rate_hz": 60, "unit": "millimetres", "up_axis": "z-up",
    "skeleton": {
      "joint_names": ["hip", "left_hip", "right_hip", "left_foot", "right_foot"],
      "bones": [["hip", "left_hip"], ["hip", "right_hip"],
                ["left_hip", "left_foot"], ["right_hip", "right_foot"]],
      "parts": [{"name": "left", "joints": ["left_hip", "left_foot"]},
                {"name": "rest", "joints": ["hip", "right_hip", "right_foot"]}],
      "root": "hip", "left_hip": "left_hip", "right_hip": "right_hip",
      "left_foot": "left_foot", "right_foot": "right_foot"},
    "classes": [{"name": "kick", "effectors": ["left_foot", "right_foot"], "handed": true},
                {"name": "hug", "symmetric": true, "touches": true}]
  })");
}

std::string ErrorOf(const Json& json) {
  const absl::StatusOr<DatasetLayout> layout = ParseDatasetLayout(json.dump());
  EXPECT_EQ(layout.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(layout.status().message());
}

TEST(DatasetLayoutTest, ReadsEveryField) {
  const absl::StatusOr<DatasetLayout> layout = ParseDatasetLayout(Complete().dump());
  ASSERT_TRUE(layout.ok()) << layout.status();
  EXPECT_EQ(layout->name, "sticks");
  EXPECT_EQ(layout->frame_rate_hz, 60);
  EXPECT_EQ(layout->coordinates.unit, motion::LengthUnit::kMillimetres);
  EXPECT_EQ(layout->coordinates.up_axis, motion::UpAxis::kZUp);
  EXPECT_THAT(layout->skeleton.joint_names,
              ElementsAre("hip", "left_hip", "right_hip", "left_foot", "right_foot"));
  EXPECT_EQ(layout->skeleton.bones[3], (motion::Bone{2, 4}));
  EXPECT_EQ(layout->parts[1].name, "rest");
  EXPECT_THAT(layout->parts[1].joints, ElementsAre(0, 2, 4));
  EXPECT_EQ(layout->skeleton.hips, (motion::JointPair{1, 2}));
  EXPECT_EQ(layout->skeleton.feet, (motion::JointPair{3, 4}));
  ASSERT_EQ(layout->classes.size(), 2u);
  EXPECT_EQ(layout->classes[0].folder, "kick");
  EXPECT_THAT(layout->classes[0].effectors, ElementsAre(3, 4));
  EXPECT_FALSE(layout->classes[0].symmetric);
  EXPECT_TRUE(layout->classes[1].symmetric);
  EXPECT_TRUE(layout->classes[0].handed);
  EXPECT_FALSE(layout->classes[1].handed);
  EXPECT_FALSE(layout->classes[0].touches);
  EXPECT_TRUE(layout->classes[1].touches);
  EXPECT_TRUE(layout->notes.empty());
}

// The skeleton of 20 joints of the second data set of the paper, as its author would write it.
Json TwentyJoints() {
  Json json = Complete();
  json["skeleton"] = Json::parse(R"({
      "joint_names": ["Hips", "Spine", "Chest", "Neck", "Head",
                      "LeftCollar", "LeftArm", "LeftForeArm", "LeftHand",
                      "RightCollar", "RightArm", "RightForeArm", "RightHand",
                      "LeftUpLeg", "LeftLeg", "LeftFoot", "RightUpLeg", "RightLeg", "RightFoot",
                      "RightToe"],
      "bones": [["Hips", "Spine"], ["Spine", "Chest"], ["Chest", "Neck"], ["Neck", "Head"],
                ["Chest", "LeftCollar"], ["LeftCollar", "LeftArm"], ["LeftArm", "LeftForeArm"],
                ["LeftForeArm", "LeftHand"], ["Chest", "RightCollar"], ["RightCollar", "RightArm"],
                ["RightArm", "RightForeArm"], ["RightForeArm", "RightHand"],
                ["Hips", "LeftUpLeg"], ["LeftUpLeg", "LeftLeg"], ["LeftLeg", "LeftFoot"],
                ["Hips", "RightUpLeg"], ["RightUpLeg", "RightLeg"], ["RightLeg", "RightFoot"],
                ["RightFoot", "RightToe"]]})");
  json["classes"] = Json::parse(R"([{"name": "kick"}])");
  return json;
}

TEST(DatasetLayoutTest, FindsPartsRootHipsAndFeetThatAreLeftOut) {
  const absl::StatusOr<DatasetLayout> layout = ParseDatasetLayout(TwentyJoints().dump());
  ASSERT_TRUE(layout.ok()) << layout.status();
  EXPECT_EQ(layout->skeleton.root, 0);
  EXPECT_EQ(layout->skeleton.hips, (motion::JointPair{13, 16}));
  EXPECT_EQ(layout->skeleton.feet, (motion::JointPair{15, 18}));
  ASSERT_EQ(layout->parts.size(), 5u);
  EXPECT_EQ(layout->parts[3].name, "right_leg");
  EXPECT_THAT(layout->parts[3].joints, ElementsAre(16, 17, 18, 19));
  EXPECT_THAT(layout->parts[4].joints, ElementsAre(0, 1, 2, 3, 4, 5, 9));
  ASSERT_EQ(layout->notes.size(), 5u);
  EXPECT_EQ(layout->notes[0], "root: Hips (no bone leads to it)");
}

TEST(DatasetLayoutTest, SaysWhatOfASkeletonCannotBeFoundAndHowToSayIt) {
  Json json = TwentyJoints();
  json["skeleton"]["joint_names"][6] = "wing";
  json["skeleton"]["bones"][5][1] = json["skeleton"]["bones"][6][0] = "wing";
  EXPECT_THAT(ErrorOf(json), HasSubstr("left and right shoulder"));
  EXPECT_THAT(ErrorOf(json), HasSubstr("specify skeleton.parts, or rename the joints"));
  json = TwentyJoints();
  json["skeleton"]["bones"].erase(0);
  EXPECT_THAT(ErrorOf(json),
              HasSubstr("skeleton.root: expected the joint that the bones start from, got none"));
  json["skeleton"]["root"] = "Hips";
  EXPECT_THAT(ErrorOf(json), HasSubstr("skeleton.bones: expected 19 to connect 20 joints, got 18"));
}

TEST(DatasetLayoutTest, NamesTheFieldThatIsMissing) {
  const Json complete = Complete();
  for (const auto& item : complete.items()) {
    Json json = Complete();
    json.erase(item.key());
    EXPECT_THAT(ErrorOf(json), HasSubstr(item.key() + ": missing"));
  }
  for (const auto& item : complete["skeleton"].items()) {
    Json json = Complete();
    json["skeleton"].erase(item.key());
    // Parts may be absent if joint names let them be inferred, which these do not.
    const char* problem = item.key() == "parts" ? ": expected parts, or joints" : ": missing";
    EXPECT_THAT(ErrorOf(json), HasSubstr("skeleton." + item.key() + problem));
  }
}

TEST(DatasetLayoutTest, RejectsEveryWrongValueByName) {
  struct Case {
    const char* patch;  // JSON pointer
    const char* value;
    const char* message;
  };
  const Case cases[] = {
      {"/name", "\"\"", "name: expected a name"},
      {"/frame_rate_hz", "0", "frame_rate_hz: expected a number from 1 to 240, got 0"},
      {"/frame_rate_hz", "\"fast\"", "frame_rate_hz: expected a number"},
      {"/unit", "\"feet\"", "unit: expected metres, millimetres or sbu-normalised, got \"feet\""},
      {"/unit", "\"sbu-normalised\"", "up_axis: expected y-down"},
      {"/up_axis", "3", "up_axis: expected y-up"},
      {"/people_axis", "\"y\"", "people_axis: expected x or z, got \"y\""},
      {"/level", "\"yes\"", "level: expected true or false, got \"yes\""},
      {"/rate", "3", "unknown field \"rate\""},
      {"/skeleton/tail", "3", "unknown field \"tail\""},
      {"/skeleton/root", "\"nose\"",
       "skeleton.root: expected one of skeleton.joint_names, got \"nose\""},
      {"/skeleton/joint_names", R"(["hip","left_hip","right_hip","left_foot","right_foot","hip"])",
       "skeleton.joint_names: \"hip\" is repeated"},
      {"/skeleton/joint_names", "{}", "skeleton.joint_names: expected an array"},
      {"/skeleton/bones/1", "[\"hip\"]", "skeleton.bones[1]"},
      {"/skeleton/bones/1", "[\"hip\", \"left_hip\"]", "skeleton.bones"},
      {"/skeleton/bones/0/1", "\"tail\"",
       "skeleton.bones[0]: expected one of skeleton.joint_names, got \"tail\""},
      {"/skeleton/parts/0/joints", "[]", "skeleton.parts: expected at least one joint of \"left\""},
      {"/classes", "[]", "classes: expected at least one, got none"},
      {"/classes/1/name", "\"kick\"", "classes[1].name: expected a new name, got \"kick\" again"},
      {"/classes/1/name", "\"../kick\"", "classes[1].name"},
      {"/classes/1/symmetric", "1", "classes[1].symmetric: expected true or false, got 1"},
      {"/classes/0/handed", "\"yes\"", "classes[0].handed: expected true or false, got \"yes\""},
      {"/classes/1/touches", "1", "classes[1].touches: expected true or false, got 1"},
      {"/classes/0/effectors/0", "\"tail\"",
       "classes[0].effectors[0]: expected one of skeleton.joint_names, got \"tail\""},
  };
  for (const Case& one : cases) {
    Json json = Complete();
    json[Json::json_pointer(one.patch)] = Json::parse(one.value);
    EXPECT_THAT(ErrorOf(json), HasSubstr(one.message)) << one.patch << " " << one.value;
  }
}

TEST(DatasetLayoutTest, RejectsWhatIsNoJsonOrRepeatsAField) {
  EXPECT_THAT(std::string(ParseDatasetLayout("{").status().message()),
              HasSubstr("dataset.json: not JSON at byte"));
  EXPECT_THAT(std::string(ParseDatasetLayout("[]").status().message()),
              HasSubstr("not a JSON object"));
  EXPECT_THAT(std::string(ParseDatasetLayout(R"({"name": "a", "name": "b"})").status().message()),
              HasSubstr("\"name\" is repeated"));
}

TEST(DatasetLayoutTest, KnowsThePapersClassesInOrder) {
  std::vector<std::string> names;
  for (const ClassLayout& one : SbuLayout().classes) names.push_back(one.name);
  EXPECT_THAT(names, ElementsAre("kick", "push", "shake_hands", "hug", "exchange_object", "punch"));
  EXPECT_THAT(SbuLayout().classes[0].effectors, ElementsAre(11, 14));
  EXPECT_THAT(SbuLayout().classes[1].effectors, ElementsAre(5, 8));
  EXPECT_EQ(K3hiLayout().classes.size(), 8u);
}

}  // namespace
}  // namespace duet::dataset
