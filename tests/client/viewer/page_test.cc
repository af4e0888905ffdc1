#include "client/viewer/page.h"

#include <cstring>
#include <limits>
#include <string>

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

TEST(PageDataTest, AcceptsOneFramePerSecondAndNonAsciiNames) {
  PageContent content = SmallContent();
  content.pair.leader.frame_rate_hz = content.pair.follower.frame_rate_hz = 1;
  content.title = "\u00dcbergabe";
  EXPECT_TRUE(RenderPage(content).ok());
  EXPECT_NE(PageDataJson(content).find("\u00dcbergabe"), std::string::npos);
}

TEST(PageDataTest, ContainsTheMotion) {
  const nlohmann::json data = Data(SmallContent());
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
}

TEST(PageDataTest, ContainsTheGradeIfThereIsOne) {
  PageContent content = SmallContent();
  EXPECT_FALSE(Data(content).contains("grade"));
  content.grade = MotionGrade{0.5, 0.25, 0.125, 1, {{0, 1}, {1, 1}}};
  EXPECT_EQ(Data(content)["grade"], nlohmann::json::parse(R"({
    "twisted": 0.5, "skating": 0.25, "leaderSkating": 0.125, "overlapping": 1,
    "badRuns": [[0, 1], [1, 1]]})"));
}

TEST(PageDataTest, ContainsTheGlbIfThereIsOne) {
  PageContent content = SmallContent();
  EXPECT_FALSE(Data(content).contains("glb"));
  content.glb = std::string("glTF\0\x01", 6);
  std::string bytes;
  ASSERT_TRUE(absl::Base64Unescape(Data(content)["glb"].get<std::string>(), &bytes));
  EXPECT_EQ(bytes, content.glb);
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
}

TEST(PageDataTest, InvalidUtf8InNamesIsReplaced) {
  PageContent content = SmallContent();
  content.title = "\xff";
  EXPECT_EQ(Data(content)["title"], "\xEF\xBF\xBD");  // the replacement character
}

TEST(RenderPageTest, IsOneSelfContainedFile) {
  const absl::StatusOr<std::string> page = RenderPage(SmallContent());
  ASSERT_THAT(page, IsOk());
  EXPECT_THAT(*page, StartsWith("<!doctype html>"));
  EXPECT_THAT(*page, HasSubstr("<title>kick</title>"));
  EXPECT_THAT(*page, HasSubstr("OrbitControls"));
  EXPECT_THAT(*page, HasSubstr("default-src 'none'"));
  for (const char* never : {"{{", "src=\"", "href=\"", "@import", "url("}) {
    EXPECT_THAT(*page, Not(HasSubstr(never)));
  }
}

TEST(RenderPageTest, TitlesAreEscaped) {
  PageContent content = SmallContent();
  content.title = "<b>&{{SCRIPT}}";
  const absl::StatusOr<std::string> page = RenderPage(content);
  ASSERT_THAT(page, IsOk());
  EXPECT_THAT(*page, HasSubstr("<title>&lt;b&gt;&amp;{{SCRIPT}}</title>"));
}

TEST(RenderPageTest, InvalidContentIsRejected) {
  const auto refused = [](void (*spoil)(PageContent*)) {
    PageContent content = SmallContent();
    spoil(&content);
    return RenderPage(content).status();
  };
  EXPECT_THAT(refused([](PageContent* c) { c->pair.leader.poses = {}; }),
              StatusIs(kInvalid, HasSubstr("got 0 frames")));
  EXPECT_THAT(refused([](PageContent* c) {
                c->pair.leader.frame_rate_hz = c->pair.follower.frame_rate_hz = 0;
              }),
              StatusIs(kInvalid, HasSubstr("at 0 Hz")));
  EXPECT_THAT(refused([](PageContent* c) { c->pair.follower.poses.Resize(1); }),
              StatusIs(kInvalid, HasSubstr("expected equal frames")));
  EXPECT_THAT(refused([](PageContent* c) { c->pair.follower.joint_names[0] = "other"; }),
              StatusIs(kInvalid, HasSubstr("expected the joints")));
  EXPECT_THAT(refused([](PageContent* c) {
                c->pair.follower.poses.all()[1].y = std::numeric_limits<float>::quiet_NaN();
              }),
              StatusIs(kInvalid, HasSubstr("expected finite positions")));
  EXPECT_THAT(refused([](PageContent* c) {
                c->bones = {{0, 2}};
              }),
              StatusIs(kInvalid, HasSubstr("expected joints 0 to 1, got 2")));
}

}  // namespace
}  // namespace duet::client::viewer
