#include "client/viewer/page.h"

#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/escaping.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "nlohmann/json.hpp"
#include "tests/support/matchers.h"

namespace duet::client::viewer {
namespace {

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;

PageContent SmallContent() {
  PageContent content;
  content.pair.leader.joint_names = {"root", "tip"};
  content.pair.leader.frame_rate_hz = 15;
  content.pair.leader.Append({{0, 1, 0}, {0, 2, 0}, {0.5f, 1, 0}, {0.5f, 2, 0}});
  content.pair.follower = content.pair.leader;
  content.pair.follower.poses.all()[3] = {-1, -2, 0.25f};
  content.bones = {{0, 1}};
  content.title = "kick";
  content.subtitle = "sbu@1";
  content.weights = {{0, {{"kick", 1}, {"hug", 0.5f}}}, {1, {{"push", -1}}}};
  return content;
}

nlohmann::json Data(const PageContent& content) {
  return nlohmann::json::parse(PageDataJson(content));
}

float LittleEndian(const std::string& bytes, size_t index) {
  uint32_t bits = 0;
  for (size_t i = 0; i < 4; ++i) {
    bits |= uint32_t{static_cast<unsigned char>(bytes[4 * index + i])} << (8 * i);
  }
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

TEST(PageDataTest, ContainsTheMotion) {
  PageContent content = SmallContent();
  content.glb = std::string("glTF\0\x01", 6);
  const nlohmann::json data = Data(content);
  EXPECT_EQ(data["title"], "kick");
  EXPECT_EQ(data["subtitle"], "sbu@1");
  EXPECT_EQ(data["frames"], 2);
  EXPECT_EQ(data["frameRate"], 15);
  EXPECT_EQ(data["joints"], nlohmann::json({"root", "tip"}));
  EXPECT_EQ(data["bones"], nlohmann::json::parse("[[0, 1]]"));
  std::string bytes;
  ASSERT_TRUE(absl::Base64Unescape(data["follower"].get<std::string>(), &bytes));
  ASSERT_EQ(bytes.size(), 2u * 2 * 3 * 4);
  EXPECT_EQ(LittleEndian(bytes, 9), -1);
  EXPECT_EQ(LittleEndian(bytes, 10), -2);
  EXPECT_EQ(LittleEndian(bytes, 11), 0.25f);
  ASSERT_TRUE(absl::Base64Unescape(data["glb"].get<std::string>(), &bytes));
  EXPECT_EQ(bytes, content.glb);
}

TEST(PageDataTest, ContainsTheGradeIfThereIsOne) {
  PageContent content = SmallContent();
  EXPECT_FALSE(Data(content).contains("grade"));
  content.grade = MotionGrade{0.5, 0.25, 0.125, 1, {{0, 1}, {1, 1}}};
  EXPECT_EQ(Data(content)["grade"], nlohmann::json::parse(R"({
    "twisted": 0.5, "skating": 0.25, "leaderSkating": 0.125, "overlapping": 1,
    "badRuns": [[0, 1], [1, 1]]})"));
}

TEST(PageDataTest, EveryKeyframeHasAWeightForEveryClass) {
  const nlohmann::json data = Data(SmallContent());
  EXPECT_EQ(data["classes"], nlohmann::json({"kick", "hug", "push"}));
  EXPECT_EQ(data["keyframes"], nlohmann::json::parse(R"([{"frame": 0, "weights": [1, 0.5, 0]},
                                      {"frame": 1, "weights": [0, 0, -1]}])"));
}

TEST(PageDataTest, NamesCannotEndTheScript) {
  PageContent content = SmallContent();
  content.title = "</script><script>alert(1)</script>";
  EXPECT_THAT(PageDataJson(content), Not(HasSubstr("<")));
  EXPECT_EQ(Data(content)["title"], content.title);
  content.title = "\xff";
  EXPECT_EQ(Data(content)["title"], "\xEF\xBF\xBD") << "the replacement character";
}

TEST(RenderPageTest, InvalidContentIsRejected) {
  PageContent content = SmallContent();
  content.bones = {{0, 2}};
  EXPECT_THAT(RenderPage(content), StatusIs(kInvalid, HasSubstr("joints 0 to 1, got 2")));
  content.pair.follower.poses.Resize(1);
  EXPECT_THAT(RenderPage(content), StatusIs(kInvalid, HasSubstr("expected equal frames")));
}

motion::Clip SmallClip(double frame_rate_hz, int frames) {
  motion::Clip clip;
  clip.joint_names = {"root", "tip"};
  clip.frame_rate_hz = frame_rate_hz;
  for (int frame = 0; frame < frames; ++frame) {
    clip.Append(std::vector<motion::Vec3>{{0, 1, 0}, {0, 2, 0}});
  }
  return clip;
}

GalleryContent SmallGallery() {
  GalleryContent content;
  content.motions = {{"captured", SmallClip(15, 3), SmallClip(15, 3)},
                     {"alone", SmallClip(30, 5), std::nullopt}};
  content.bones = {{0, 1}};
  content.title = "<two>";
  return content;
}

nlohmann::json GalleryData(const GalleryContent& content) {
  const absl::StatusOr<std::string> page = RenderGallery(content);
  EXPECT_THAT(page, IsOk());
  if (!page.ok()) return {};
  const std::string start = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page->find(start) + start.size();
  return nlohmann::json::parse(page->substr(from, page->find("</script>", from) - from));
}

TEST(RenderGalleryTest, IsOneSelfContainedFile) {
  const absl::StatusOr<std::string> page = RenderGallery(SmallGallery());
  ASSERT_THAT(page, IsOk());
  EXPECT_THAT(*page, AllOf(StartsWith("<!doctype html>"), HasSubstr("<title>&lt;two&gt;</title>"),
                           HasSubstr("default-src 'none'"), HasSubstr("class Gallery"),
                           HasSubstr("three.js authors")));
  for (const char* never : {"{{", "src=\"", "href=\"", "@import", "url("}) {
    EXPECT_THAT(*page, Not(HasSubstr(never)));
  }
}

TEST(RenderGalleryTest, ContainsMotions) {
  const nlohmann::json data = GalleryData(SmallGallery());
  EXPECT_EQ(data["title"], "<two>");
  ASSERT_EQ(data["motions"].size(), 2u);
  EXPECT_EQ(data["motions"][0]["name"], "captured");
  EXPECT_EQ(data["motions"][0]["frames"], 3);
  EXPECT_TRUE(data["motions"][0].contains("follower"));
  EXPECT_FALSE(data["motions"][1].contains("follower"));
  EXPECT_EQ(data["motions"][1]["frameRate"], 30);
}

TEST(RenderGalleryTest, InvalidContentIsRejected) {
  const struct {
    const char* message;
    void (*spoil)(GalleryContent*);
  } cases[] = {
      {"expected 1 to 12, got 0", [](GalleryContent* c) { c->motions.clear(); }},
      {"got 13", [](GalleryContent* c) { c->motions.resize(13, c->motions[0]); }},
      {"alone: expected at least 1 frame",
       [](GalleryContent* c) { c->motions[1].leader.poses = {}; }},
      {"alone: frame rate", [](GalleryContent* c) { c->motions[1].leader.frame_rate_hz = 0; }},
      {"alone: expected the joints",
       [](GalleryContent* c) { c->motions[1].leader.joint_names[0] = "x"; }},
      {"captured: expected equal frames",
       [](GalleryContent* c) { c->motions[0].follower = SmallClip(15, 2); }},
      {"frame 1 tip: expected a finite position", [](GalleryContent* c) {
         c->motions[0].follower->at(1, 1).x = std::numeric_limits<float>::quiet_NaN();
       }}};
  for (const auto& [message, spoil] : cases) {
    GalleryContent content = SmallGallery();
    spoil(&content);
    EXPECT_THAT(RenderGallery(content), StatusIs(kInvalid, HasSubstr(message)));
  }
}

}  // namespace
}  // namespace duet::client::viewer
