#include "model/dataset/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nlohmann/json.hpp"

namespace duet::dataset {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
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
    "classes": [{"name": "kick", "effectors": ["left_foot", "right_foot"]},
                {"name": "hug", "symmetric": true}]
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
}

TEST(DatasetLayoutTest, OwnDataIsLevelUnlessItSaysOtherwise) {
  Json json = Complete();
  EXPECT_FALSE(ParseDatasetLayout(json.dump())->level);
  json["level"] = true;
  const absl::StatusOr<DatasetLayout> layout = ParseDatasetLayout(json.dump());
  ASSERT_TRUE(layout.ok()) << layout.status();
  EXPECT_TRUE(layout->level);
}

TEST(DatasetLayoutTest, LevellingNeedsFeet) {
  Json json = Complete();
  json["skeleton"].erase("left_foot");
  json["skeleton"].erase("right_foot");
  json["level"] = true;
  EXPECT_THAT(ErrorOf(json), HasSubstr("level: true without feet, wanted skeleton.left_foot"));
  json["level"] = false;
  EXPECT_TRUE(ParseDatasetLayout(json.dump()).ok());
}

TEST(DatasetLayoutTest, ReadsEarlierSpellingsOfUnitAndAxis) {
  Json json = Complete();
  json["unit"] = "sbu_normalised";
  json["up_axis"] = "y_down";
  const absl::StatusOr<DatasetLayout> layout = ParseDatasetLayout(json.dump());
  ASSERT_TRUE(layout.ok()) << layout.status();
  EXPECT_EQ(layout->coordinates.unit, motion::LengthUnit::kSbuNormalised);
  EXPECT_EQ(layout->coordinates.up_axis, motion::UpAxis::kYDown);
  for (const char* up_axis : {"y_up", "z_up"}) {
    json["unit"] = "metres";
    json["up_axis"] = up_axis;
    EXPECT_TRUE(ParseDatasetLayout(json.dump()).ok()) << up_axis;
  }
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
    EXPECT_THAT(ErrorOf(json), HasSubstr("skeleton." + item.key() + ": missing"));
  }
}

TEST(DatasetLayoutTest, RefusesEveryWrongValueByName) {
  struct Case {
    const char* patch;  // JSON pointer
    const char* value;
    const char* message;
  };
  const Case cases[] = {
      {"/name", "\"\"", "name: \"\""},
      {"/frame_rate_hz", "0", "frame_rate_hz: 0, wanted a number from 1 to 240"},
      {"/frame_rate_hz", "\"fast\"", "frame_rate_hz: \"fast\""},
      {"/unit", "\"feet\"", "unit: \"feet\", wanted metres, millimetres or sbu-normalised"},
      {"/unit", "\"sbu-normalised\"", "up_axis: z-up, wanted y-down"},
      {"/up_axis", "3", "up_axis: 3"},
      {"/level", "\"yes\"", "level: \"yes\", wanted true or false"},
      {"/rate", "3", "unknown field \"rate\""},
      {"/skeleton/tail", "3", "unknown field \"tail\""},
      {"/skeleton/root", "\"nose\"",
       "skeleton.root: unknown joint \"nose\", wanted one of skeleton.joint_names"},
      {"/skeleton/joint_names", R"(["hip","left_hip","right_hip","left_foot","right_foot","hip"])",
       "skeleton.joint_names: \"hip\" is repeated"},
      {"/skeleton/joint_names", "{}", "skeleton.joint_names: {}, wanted an array"},
      {"/skeleton/bones/1", "[\"hip\"]", "skeleton.bones[1]"},
      {"/skeleton/bones/1", "[\"hip\", \"left_hip\"]", "skeleton.bones"},
      {"/skeleton/bones/0/1", "\"tail\"", "skeleton.bones[0]: unknown joint \"tail\""},
      {"/skeleton/parts/0/joints", "[]", "skeleton.parts: \"left\" has no joints"},
      {"/classes", "[]", "classes: empty"},
      {"/classes/1/name", "\"kick\"", "classes[1].name: \"kick\" again"},
      {"/classes/1/name", "\"../kick\"", "classes[1].name"},
      {"/classes/1/symmetric", "1", "classes[1].symmetric: 1, wanted true or false"},
      {"/classes/0/effectors/0", "\"tail\"", "classes[0].effectors[0]: \"tail\""},
  };
  for (const Case& one : cases) {
    Json json = Complete();
    json[Json::json_pointer(one.patch)] = Json::parse(one.value);
    EXPECT_THAT(ErrorOf(json), HasSubstr(one.message)) << one.patch << " " << one.value;
  }
}

TEST(DatasetLayoutTest, RefusesWhatIsNoJsonOrRepeatsAField) {
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
