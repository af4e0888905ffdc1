// What the clean-up does to captured followers, which need none: little, and nothing for the worse.
#include <cstddef>

#include "gtest/gtest.h"
#include "model/body/motion_quality.h"
#include "model/body/penetration.h"
#include "model/cleanup/clean_up.h"
#include "model/dataset/dataset.h"
#include "model/motion/limb_lengths.h"
#include "tests/cleanup/bodies.h"
#include "tests/support/data_folder.h"
#include "tests/support/status_matchers.h"

namespace duet::cleanup {
namespace {

// Means over sequences.
struct Figures {
  double slide = 0;          // centimetres a frame
  double overlap = 0;        // metres, the deepest
  double length_change = 0;  // metres, the largest
};

class CapturesTest : public ::testing::Test {
 protected:
  void Add(const dataset::Sequence& sequence, const dataset::Dataset& data) {
    const motion::Poses& leader = sequence.pair.leader.poses;
    motion::Poses follower = sequence.pair.follower.poses;
    SetBoneLengths(data.skeleton, MedianBoneLengths(data.skeleton, follower), &follower);
    motion::Poses cleaned = follower;
    const bool touches = data.touches[static_cast<std::size_t>(sequence.interaction_class)];
    const Touch touch(static_cast<std::size_t>(leader.frame_count()), touches ? 1.0f : 0.0f);
    CleanUp(data.skeleton)
        .Apply(leader, touch, Meetings(touch.size()), {data.frame_rate_hz, 0}, &cleaned);
    Measure(leader, follower, data, &before_);
    Measure(leader, cleaned, data, &after_);
    after_.length_change =
        std::max<double>(after_.length_change, LargestLengthChange(follower, cleaned));
    ++count_;
  }

  static void Measure(const motion::Poses& leader, const motion::Poses& follower,
                      const dataset::Dataset& data, Figures* figures) {
    using body::MeasureFootSlide;
    using body::MeasurePenetration;
    figures->slide +=
        MeasureFootSlide(follower, data.skeleton, data.frame_rate_hz).centimetres_a_frame;
    figures->overlap +=
        MeasurePenetration(leader, follower, data.skeleton, data.parts).max_depth_metres;
  }

  Figures before_, after_;
  int count_ = 0;
};

// The mean way that one stage moves the joints of a captured follower, metres.
double MeanShift(const motion::Poses& follower, const motion::Skeleton& skeleton, double rate_hz) {
  motion::Poses limited = follower;
  KeepJointRanges(skeleton, body::FindBody(skeleton), std::nullopt, {}, {rate_hz, 0}, &limited);
  double sum = 0;
  for (std::size_t i = 0; i < follower.all().size(); ++i) {
    sum += Distance(follower.all()[i], limited.all()[i]);
  }
  return sum / static_cast<double>(follower.all().size());
}

TEST_F(CapturesTest, SlideLessAndOverlapLess) {
  const auto folder = test::FindData("sbu");
  if (!folder) GTEST_SKIP() << test::kNoData;
  const absl::StatusOr<dataset::Dataset> data = dataset::ReadDataset(*folder);
  ASSERT_THAT(data, test::IsOk());
  for (const dataset::Sequence& sequence : data->sequences) Add(sequence, *data);
  ASSERT_GT(count_, 0);
  EXPECT_LT(after_.slide, before_.slide);
  EXPECT_LT(after_.overlap, before_.overlap);
  EXPECT_LT(after_.length_change, 1e-5);
}

TEST_F(CapturesTest, AreMostlyWithinTheRangesOfJoints) {
  const auto folder = test::FindData("sbu");
  if (!folder) GTEST_SKIP() << test::kNoData;
  const absl::StatusOr<dataset::Dataset> data = dataset::ReadDataset(*folder);
  ASSERT_THAT(data, test::IsOk());
  double sum = 0;
  for (const dataset::Sequence& sequence : data->sequences) {
    sum += MeanShift(sequence.pair.follower.poses, data->skeleton, data->frame_rate_hz);
  }
  EXPECT_LT(sum / static_cast<double>(data->sequences.size()), 0.002);
}

}  // namespace
}  // namespace duet::cleanup
