#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/bvh/bvh_motion.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::bvh {
namespace {

using test::LargestDistance;
using test::MakePerson;
using test::PersonOptions;

constexpr float kOneMillimetre = 0.001f;

BvhDocument Export(const motion::Clip& clip) { return ToBvh(clip, motion::SbuSkeleton()); }

// Reads a document; notes what was decided.
motion::Clip Read(const BvhDocument& document, std::vector<std::string>* notes = nullptr,
                  BvhImportOptions options = {}) {
  retargeting::ReadingReport report;
  options.report = &report;
  const absl::StatusOr<motion::Clip> read = FromBvh(document, "a.bvh", options);
  EXPECT_THAT(read, IsOk());
  if (notes != nullptr) *notes = report.Notes();
  return read.value_or(motion::Clip());
}

// The document in another unit.
BvhDocument Scaled(BvhDocument document, double factor) {
  for (BvhJoint& joint : document.joints) joint.offset = joint.offset * factor;
  const std::size_t channels = static_cast<std::size_t>(document.ChannelCount());
  for (std::size_t i = 0; i < document.values.size(); ++i) {
    if (i % channels < 3) document.values[i] *= static_cast<float>(factor);
  }
  return document;
}

TEST(BvhImport, ReadsWhatWeWrite) {
  const motion::Clip clip = MakePerson();
  const absl::StatusOr<motion::Clip> read = FromBvh(Export(clip), "a.bvh");
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->joint_names, clip.joint_names);
  EXPECT_EQ(read->frame_rate_hz, 30);
  EXPECT_LT(LargestDistance(*read, clip), kOneMillimetre);
}

TEST(BvhImport, ASkeletonWithoutFeetRequiresAUnit) {
  const motion::Clip clip = MakePerson();
  BvhImportOptions options;
  options.skeleton.feet.reset();
  EXPECT_THAT(std::string(FromBvh(Export(clip), "a.bvh", options).status().message()),
              HasSubstr("a.bvh: size: expected a skeleton with feet to infer the unit"));
  options.metres_per_unit = 0.01;
  EXPECT_LT(LargestDistance(Read(Export(clip), nullptr, options), clip), kOneMillimetre);
}

TEST(BvhImport, InfersTheUnitFromThePersonsSize) {
  const motion::Clip clip = MakePerson();
  const std::pair<double, const char*> units[] = {
      {1, "unit: centimetres"},          {0.01, "unit: metres"},
      {10, "unit: millimetres"},         {1 / 2.54, "unit: inches"},
      {0.45 / 2.54, "unit: CMU's unit"}, {0.1, "unit: decimetres"}};
  for (const auto& [factor, note] : units) {
    std::vector<std::string> notes;
    EXPECT_LT(LargestDistance(Read(Scaled(Export(clip), factor), &notes), clip), kOneMillimetre)
        << note;
    EXPECT_THAT(notes, Contains(HasSubstr(note)));
  }
}

TEST(BvhImport, WarnsIfNoUnitGivesAPersonsSize) {
  const motion::Clip clip = MakePerson();
  const double leg = 0.41 + 0.43 + 0.237;
  const BvhDocument odd = Scaled(Export(clip), 2.24 / leg);  // 224 units from foot to root
  std::vector<std::string> notes;
  motion::Clip smaller = clip;
  for (motion::Vec3& p : smaller.poses.all()) p = p * static_cast<float>(1 / leg);
  EXPECT_LT(LargestDistance(Read(odd, &notes), smaller), kOneMillimetre);
  EXPECT_THAT(notes, Contains(HasSubstr("warning: unit: a guess: legs of 224 units are no "
                                        "person's in any usual unit, and were read as 1 m")));
  BvhImportOptions options;
  options.metres_per_unit = 0.01 * leg / 2.24;
  EXPECT_LT(LargestDistance(Read(odd, &notes, options), clip), kOneMillimetre);
  EXPECT_THAT(notes, Not(Contains(HasSubstr("unit:"))));
}

// Some programs write positions that add to OFFSET.
TEST(BvhImport, RejectsPositionChannelsThatLeaveJointsInOnePlace) {
  BvhDocument document = Export(MakePerson({1}));
  std::vector<float> values(document.values.begin(), document.values.begin() + 6);
  for (std::size_t j = 1; j < document.joints.size(); ++j) {
    if (document.joints[j].end_site) continue;
    document.joints[j].channels = document.joints[0].channels;
    values.insert(values.end(), 6, 0);
  }
  document.values = values;
  EXPECT_THAT(std::string(FromBvh(document, "a.bvh").status().message()),
              HasSubstr("expected left_hip and right_hip in two places"));
}

TEST(BvhImport, RejectsACharacterWithoutSizeAndInvalidUnits) {
  const motion::Clip clip = MakePerson({2});
  const BvhDocument point = Scaled(Export(clip), 0);
  const absl::StatusOr<motion::Clip> refused = FromBvh(point, "a.bvh");
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(refused.status().message()),
              HasSubstr("a.bvh: size: expected a distance from foot to torso, got 0 units"));
  BvhImportOptions options;
  for (double unit : {0.0, -1.0, 1e30, std::nan("")}) {
    options.metres_per_unit = unit;
    EXPECT_THAT(std::string(FromBvh(Export(clip), "a.bvh", options).status().message()),
                HasSubstr("metres per unit: expected more than 0"));
  }
}

TEST(BvhImport, FindsTheUpAxis) {
  const motion::Clip clip = MakePerson();
  motion::Clip z_up = clip, y_down = clip;
  for (motion::Vec3& p : z_up.poses.all()) p = {p.x, -p.z, p.y};
  for (motion::Vec3& p : y_down.poses.all()) p = {p.x, -p.y, -p.z};
  for (const motion::Clip* turned : {&z_up, &y_down}) {
    std::vector<std::string> notes;
    EXPECT_LT(LargestDistance(Read(Export(*turned), &notes), clip), kOneMillimetre);
    EXPECT_THAT(notes, Contains(HasSubstr("up axis:")));
  }
  BvhImportOptions as_it_is;
  as_it_is.up_axis = motion::UpAxis::kYUp;
  EXPECT_LT(LargestDistance(Read(Export(z_up), nullptr, as_it_is), z_up), kOneMillimetre);
}

TEST(BvhImport, WarnsAndAssumesYIfThePersonStandsAlongX) {
  motion::Clip x_up = MakePerson();
  for (motion::Vec3& p : x_up.poses.all()) p = {p.y, -p.x, p.z};
  retargeting::ReadingReport report;
  BvhImportOptions options;
  options.report = &report;
  const absl::StatusOr<motion::Clip> read = FromBvh(Export(x_up), "a.bvh", options);
  ASSERT_THAT(read, IsOk());
  EXPECT_LT(LargestDistance(*read, x_up), kOneMillimetre);
  EXPECT_THAT(report.Notes(),
              Contains(HasSubstr("warning: up axis: expected a person who stands along")));
  EXPECT_EQ(report.up_axis->value, "y-up");
  EXPECT_EQ(report.up_axis->origin, retargeting::Origin::kDefault);
}

// A person who lies down, bends or falls in some frames does not change the up axis.
TEST(BvhImport, FindsTheUpAxisFromTheWholeMotion) {
  motion::Clip clip = MakePerson();
  for (int joint = 0; joint < clip.joint_count(); ++joint) {
    motion::Vec3& p = clip.at(0, joint);
    p = {p.x, -p.z, p.y};
  }
  std::vector<std::string> notes;
  EXPECT_LT(LargestDistance(Read(Export(clip), &notes), clip), kOneMillimetre);
  EXPECT_THAT(notes, Not(Contains(HasSubstr("up axis:"))));
}

TEST(BvhImport, RoundsFrameTimesToTheIntendedRate) {
  BvhDocument document = Export(MakePerson({2}));
  const std::pair<double, double> rates[] = {
      {0.0333333, 30},    {0.033333, 30},       {0.0083333, 120},  {0.041667, 24},
      {0.0166667, 60},    {0.04, 25},           {0.008333, 120},   {0.0041666, 240},
      {1 / 29.97, 29.97}, {1 / 119.88, 119.88}, {1 / 1.001, 1.001}};
  for (const auto& [frame_time, rate] : rates) {
    document.frame_time_s = frame_time;
    EXPECT_NEAR(Read(document).frame_rate_hz, rate, rate == std::floor(rate) ? 0 : 1e-6)
        << frame_time;
  }
}

// Exporters round frame times to few decimals, or cut the others off.
TEST(BvhImport, FindsTheRateOfAFrameTimeWithFewDecimals) {
  const std::pair<const char*, double> rates[] = {
      {".0333", 30},  {"0.0333", 30}, {".033", 30},     {".0167", 60},  {"0.0166", 60},
      {".017", 60},   {".0083", 120}, {"0.00833", 120}, {".0084", 119}, {".0417", 24},
      {"0.0416", 24}, {".042", 24},   {".0111", 90},    {".0139", 72},  {".0069", 144},
      {".0042", 240}, {".0667", 15},  {".016", 62.5},   {".008", 125},  {"3.33e-2", 1 / 0.0333}};
  const std::string text = FormatBvh(Export(MakePerson({2})));
  for (const auto& [frame_time, rate] : rates) {
    const absl::StatusOr<BvhDocument> document =
        ParseBvh(absl::StrReplaceAll(
                     text, {{"Frame Time: 0.033333333", absl::StrCat("Frame Time: ", frame_time)}}),
                 "a.bvh");
    ASSERT_THAT(document, IsOk());
    EXPECT_EQ(FromBvh(*document, "a.bvh")->frame_rate_hz, rate) << frame_time;
  }
}

TEST(BvhImport, ReadsOneFrameMoreOrFewerThanStatedWithANote) {
  const std::string text = FormatBvh(Export(MakePerson({10})));
  for (const int stated : {9, 11}) {
    const absl::StatusOr<BvhDocument> document = ParseBvh(
        absl::StrReplaceAll(text, {{"Frames: 10", absl::StrCat("Frames: ", stated)}}), "a.bvh");
    ASSERT_THAT(document, IsOk());
    std::vector<std::string> notes;
    EXPECT_EQ(Read(*document, &notes).frame_count(), 10);
    EXPECT_THAT(notes, Contains(absl::StrCat("frames: the file has 10, and states ", stated)));
  }
}

TEST(BvhImport, ReadsTheSecondPersonOfAFileWithTwo) {
  const motion::Clip first = MakePerson({2}), second = MakePerson({2, 3, 0, {0, 1, 1.5f}, 30});
  BvhDocument both = Export(first);
  const BvhDocument other = Export(second);
  const std::size_t shift = both.joints.size(), channels = other.values.size() / 2;
  for (BvhJoint joint : other.joints) {
    if (joint.parent >= 0) joint.parent += static_cast<int>(shift);
    both.joints.push_back(joint);
  }
  std::vector<float> values;
  for (std::size_t frame = 0; frame < 2; ++frame) {
    for (const BvhDocument* from : {static_cast<const BvhDocument*>(&both), &other}) {
      const auto row = from->values.begin() + static_cast<std::ptrdiff_t>(frame * channels);
      values.insert(values.end(), row, row + static_cast<std::ptrdiff_t>(channels));
    }
  }
  both.values = values;
  BvhImportOptions options;
  EXPECT_LT(LargestDistance(*FromBvh(both, "a.bvh", options), first), kOneMillimetre);
  options.person = 1;
  EXPECT_LT(LargestDistance(*FromBvh(both, "a.bvh", options), second), kOneMillimetre);
}

}  // namespace
}  // namespace duet::formats::bvh
