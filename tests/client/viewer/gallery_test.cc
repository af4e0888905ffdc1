#include "client/viewer/gallery.h"

#include <limits>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "nlohmann/json.hpp"
#include "tests/support/matchers.h"

namespace duet::client::viewer {
namespace {

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;

motion::Clip SmallClip(double frame_rate_hz, int frames) {
  motion::Clip clip;
  clip.joint_names = {"root", "tip"};
  clip.frame_rate_hz = frame_rate_hz;
  for (int frame = 0; frame < frames; ++frame) {
    clip.Append(std::vector<motion::Vec3>{{0, 1, 0}, {0, 2, 0}});
  }
  return clip;
}

GalleryContent SmallContent() {
  GalleryContent content;
  content.motions = {{"captured", SmallClip(15, 3), SmallClip(15, 3)},
                     {"alone", SmallClip(30, 5), std::nullopt}};
  content.bones = {{0, 1}};
  content.title = "<two>";
  return content;
}

nlohmann::json Data(const GalleryContent& content) {
  const absl::StatusOr<std::string> page = RenderGallery(content);
  EXPECT_THAT(page, IsOk());
  if (!page.ok()) return {};
  const std::string start = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page->find(start) + start.size();
  return nlohmann::json::parse(page->substr(from, page->find("</script>", from) - from));
}

TEST(RenderGalleryTest, IsOneSelfContainedFile) {
  const absl::StatusOr<std::string> page = RenderGallery(SmallContent());
  ASSERT_THAT(page, IsOk());
  EXPECT_THAT(*page, AllOf(StartsWith("<!doctype html>"), HasSubstr("<title>&lt;two&gt;</title>"),
                           HasSubstr("default-src 'none'"), HasSubstr("class Gallery"),
                           HasSubstr("three.js authors")));
  for (const char* never : {"{{", "src=\"", "href=\"", "@import", "url("}) {
    EXPECT_THAT(*page, Not(HasSubstr(never)));
  }
}

TEST(RenderGalleryTest, ContainsMotions) {
  const nlohmann::json data = Data(SmallContent());
  EXPECT_EQ(data["title"], "<two>");
  ASSERT_EQ(data["motions"].size(), 2u);
  EXPECT_EQ(data["motions"][0]["name"], "captured");
  EXPECT_EQ(data["motions"][0]["frames"], 3);
  EXPECT_TRUE(data["motions"][0].contains("follower"));
  EXPECT_FALSE(data["motions"][1].contains("follower"));
  EXPECT_EQ(data["motions"][1]["frameRate"], 30);
}

TEST(RenderGalleryTest, InvalidContentIsRejected) {
  const auto refused = [](void (*spoil)(GalleryContent*)) {
    GalleryContent content = SmallContent();
    spoil(&content);
    return RenderGallery(content).status();
  };
  EXPECT_THAT(refused([](GalleryContent* c) { c->motions.clear(); }),
              StatusIs(kInvalid, HasSubstr("expected 1 to 12, got 0")));
  EXPECT_THAT(refused([](GalleryContent* c) { c->motions.resize(13, c->motions[0]); }),
              StatusIs(kInvalid, HasSubstr("got 13")));
  EXPECT_THAT(refused([](GalleryContent* c) { c->motions[1].leader.poses = {}; }),
              StatusIs(kInvalid, HasSubstr("alone: expected at least one frame")));
  EXPECT_THAT(refused([](GalleryContent* c) { c->motions[1].leader.frame_rate_hz = 0; }),
              StatusIs(kInvalid, HasSubstr("at 0 Hz")));
  EXPECT_THAT(refused([](GalleryContent* c) { c->motions[1].leader.joint_names[0] = "x"; }),
              StatusIs(kInvalid, HasSubstr("alone: expected the joints")));
  EXPECT_THAT(refused([](GalleryContent* c) { c->motions[0].follower = SmallClip(15, 2); }),
              StatusIs(kInvalid, HasSubstr("captured: expected equal frames")));
  EXPECT_THAT(refused([](GalleryContent* c) {
                c->motions[0].follower->at(1, 1).x = std::numeric_limits<float>::quiet_NaN();
              }),
              StatusIs(kInvalid, HasSubstr("expected finite positions")));
  EXPECT_THAT(refused([](GalleryContent* c) {
                c->bones = {{0, 2}};
              }),
              StatusIs(kInvalid, HasSubstr("expected joints 0 to 1, got 2")));
}

}  // namespace
}  // namespace duet::client::viewer
