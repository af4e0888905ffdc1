#include "model/formats/asf/amc_import.h"

#include <random>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/formats/asf/asf_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::asf {
namespace {

using test::AsfFiles;
using test::LargestDistance;
using test::MakeAsfFiles;
using test::MakePerson;

absl::StatusOr<motion::Clip> Read(const AsfFiles& files, const AmcImportOptions& options = {}) {
  const absl::StatusOr<AsfSkeleton> skeleton = ParseAsf(files.asf, "a.asf");
  if (!skeleton.ok()) return skeleton.status();
  const absl::StatusOr<AmcMotion> motion = ParseAmc(files.amc, "a.amc", *skeleton);
  if (!motion.ok()) return motion.status();
  return FromAmc(*skeleton, *motion, "a.amc", options);
}

TEST(AmcImport, ReadsAPerson) {
  const motion::Clip clip = MakePerson({60, 1, 4, {0.5f, 1.1f, 2}, 120});
  std::vector<std::string> notes;
  AmcImportOptions options;
  options.notes = &notes;
  const absl::StatusOr<motion::Clip> read = Read(MakeAsfFiles(clip), options);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->frame_rate_hz, 120);
  EXPECT_LT(LargestDistance(*read, clip), 0.001f);
  EXPECT_THAT(notes, Contains(HasSubstr("unit: 0.0564444 m (:units length 0.45)")));
  EXPECT_THAT(notes, Contains(HasSubstr("frame rate: 120 Hz, as CMU's captures have")));
}

// The same person in metres that claims to be in another unit.
TEST(AmcImport, IgnoresAStatedUnitThatGivesNoPersonsSize) {
  AsfFiles files = MakeAsfFiles(MakePerson({2}));
  const std::string stated = "length 0.45";
  ASSERT_NE(files.asf.find(stated), std::string::npos);
  files.asf.replace(files.asf.find(stated), stated.size(), "length 45");
  std::vector<std::string> notes;
  AmcImportOptions options;
  options.notes = &notes;
  ASSERT_TRUE(Read(files, options).ok());
  EXPECT_THAT(notes, Contains(HasSubstr("warning: unit: ignored :units length 45")));
  EXPECT_THAT(notes, Contains(HasSubstr("unit: CMU's unit")));
}

TEST(AmcImport, UsesTheSpecifiedRate) {
  AmcImportOptions options;
  options.frame_rate_hz = 60;
  EXPECT_EQ(Read(MakeAsfFiles(MakePerson({2})), options)->frame_rate_hz, 60);
}

TEST(AmcImport, FindsTheSkeletonOfTheMotionOrItsSubject) {
  EXPECT_THAT(SkeletonNames("01_02.amc"), ElementsAre("01_02.asf", "01.asf"));
  EXPECT_THAT(SkeletonNames("walk.amc"), ElementsAre("walk.asf"));
  EXPECT_THAT(SkeletonNames("_1.amc"), ElementsAre("_1.asf"));
}

TEST(AmcImport, RejectsEveryTruncation) {
  const AsfFiles files = MakeAsfFiles(MakePerson({2}));
  for (std::size_t size = 0; size + 8 < files.asf.size(); ++size) {
    EXPECT_FALSE(ParseAsf(files.asf.substr(0, size), "a.asf").ok()) << size;
  }
  const absl::StatusOr<AsfSkeleton> skeleton = ParseAsf(files.asf, "a.asf");
  ASSERT_TRUE(skeleton.ok()) << skeleton.status();
  // A cut within the last number, or at the end of a frame, is a motion too.
  const std::size_t second = files.amc.find("\n2\n");
  const std::size_t last = files.amc.rfind(' ') + 1;
  for (std::size_t size = 0; size < last; ++size) {
    if (size > second - 12 && size < second + 2) continue;
    EXPECT_FALSE(ParseAmc(files.amc.substr(0, size), "a.amc", *skeleton).ok()) << size;
  }
}

// Bytes changed at random: an error or a motion, never a crash.
TEST(AmcImport, SurvivesDamage) {
  const AsfFiles files = MakeAsfFiles(MakePerson({2}));
  const char interesting[] = "0123456789-e. \n:abtrxyz";
  std::mt19937 random(3);
  int refused = 0;
  for (int round = 0; round < 600; ++round) {
    AsfFiles damaged = files;
    for (std::string* text : {&damaged.asf, &damaged.amc}) {
      (*text)[random() % text->size()] = interesting[random() % (sizeof(interesting) - 1)];
      text->erase(random() % text->size(), random() % 3);
    }
    const absl::StatusOr<motion::Clip> clip = Read(damaged);
    refused += clip.ok() ? 0 : 1;
    if (!clip.ok()) continue;
    for (const motion::Vec3& position : clip->poses.all()) EXPECT_TRUE(IsFinite(position));
  }
  EXPECT_GT(refused, 200);
}

}  // namespace
}  // namespace duet::formats::asf
