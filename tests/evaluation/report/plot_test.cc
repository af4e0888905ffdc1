#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/evaluation/report/result_section.h"
#include "tests/support/sample_motion.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::json;

// As a reader of the file gets it.
json Written(const Plot& plot) { return json::parse(ToJson(plot).dump()); }

TEST(PlotTest, LatentSpaceHasAVectorAndAClassForEachSample) {
  const json written =
      Written(LatentPlot{"ours", {"kick", "hug"}, {1, 0}, {{1, 2}, {3, 4}}, 12, 7});
  EXPECT_EQ(written["kind"], "latent");
  EXPECT_EQ(written["class_names"], json::parse(R"(["kick", "hug"])"));
  EXPECT_EQ(written["classes"], json::parse("[1, 0]"));
  EXPECT_EQ(written["features"], json::parse("[[1, 2], [3, 4]]"));
  EXPECT_EQ(written["perplexity"], 12);
  EXPECT_EQ(written["seed"], 7);
}

TEST(PlotTest, PosesHaveEveryFrameAndTheSideOfEachBone) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const motion::Poses poses = test::SwayingMotion(31, 15);
  const json written = Written(PosePlot{"kick", skeleton, {{"captured", poses, poses}}, 15});
  EXPECT_EQ(written["kind"], "poses");
  EXPECT_EQ(written["frame_rate_hz"], 15);
  EXPECT_EQ(written["root"], skeleton.root);
  EXPECT_EQ(written["head"], skeleton.Find("head"));
  ASSERT_EQ(written["bones"].size(), skeleton.bones.size());
  for (const json& bone : written["bones"]) {
    const std::string& child = skeleton.joint_names[bone["child"].get<size_t>()];
    EXPECT_EQ(bone["side"] == "left", child.find("left") == 0) << child;
    EXPECT_EQ(bone["side"] == "right", child.find("right") == 0) << child;
  }
  const json& pair = written["pairs"][0];
  EXPECT_EQ(pair["name"], "captured");
  ASSERT_EQ(pair["leader"].size(), 31u);
  ASSERT_EQ(pair["follower"][30].size(), 15u);
  EXPECT_NEAR(pair["follower"][30][4][1].get<double>(), poses.at(30, 4).y, 1e-4);
}

}  // namespace
}  // namespace duet::evaluation::report
