#include "model/evaluation/experiments/synthetic_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_replace.h"
#include "model/evaluation/experiments/synthetic_plan.h"
#include "model/formats/motion_file.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::evaluation::experiments {
namespace {

using test::IsOk;
using test::MadeUpPairs;
using test::ReadTestFile;
using test::StatusIs;
using test::TemporaryFolder;
using test::WriteTestFile;

using testing::HasSubstr;

// The jobs of a small set, written as for a server.
class SyntheticFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    dataset_.sequences[0].partner_direction = motion::Vec3{0, 0, -1};
    jobs_ = PlanSyntheticSet(dataset_, {0, 2}, {1, 1, 7});
    ASSERT_THAT(WriteSyntheticJobs(dataset_, jobs_, 7, folder_.path()), IsOk());
  }

  // What `duet synthesize` leaves for a job: here the leader, moved by a metre.
  void Answer(const SyntheticJob& job, const motion::Skeleton& skeleton, double frame_rate_hz) {
    motion::ClipPair pair = job.sequence.pair;
    pair.follower = pair.leader;
    for (motion::Vec3& point : pair.follower.poses.all()) point.x += 1;
    pair.leader.frame_rate_hz = pair.follower.frame_rate_hz = frame_rate_hz;
    ASSERT_THAT(formats::WritePair(FollowerFile(job), pair, skeleton), IsOk());
  }

  void AnswerAll() {
    for (const SyntheticJob& job : jobs_) {
      Answer(job, dataset_.skeleton, dataset_.frame_rate_hz);
    }
  }

  std::filesystem::path FollowerFile(const SyntheticJob& job) const {
    return folder_ / "followers" / (job.sequence.id + ".json");
  }

  absl::Status ReadAfter(const std::string& from, const std::string& to) {
    const std::filesystem::path file = folder_ / "jobs.tsv";
    WriteTestFile(file, absl::StrReplaceAll(ReadTestFile(file), {{from, to}}));
    return ReadSyntheticSet(dataset_, folder_.path()).status();
  }

  dataset::Dataset dataset_ = MadeUpPairs(2);
  std::vector<SyntheticJob> jobs_;
  TemporaryFolder folder_;
};

TEST_F(SyntheticFilesTest, LeadersAreFilesThatTheClientReads) {
  for (const SyntheticJob& job : jobs_) {
    const std::filesystem::path file = folder_ / "leaders" / (job.sequence.id + ".json");
    const absl::StatusOr<motion::Clip> leader = formats::ReadLeader(file);
    ASSERT_THAT(leader, IsOk());
    EXPECT_EQ(leader->frame_rate_hz, dataset_.frame_rate_hz);
    ASSERT_EQ(leader->poses.all().size(), job.sequence.pair.leader.poses.all().size());
    for (size_t i = 0; i < leader->poses.all().size(); ++i) {
      EXPECT_LT(Distance(leader->poses.all()[i], job.sequence.pair.leader.poses.all()[i]), 1e-5f);
    }
    EXPECT_THAT(ReadTestFile(file), testing::Not(HasSubstr("follower")));
  }
}

TEST_F(SyntheticFilesTest, ReadsBackWhatWasAnswered) {
  AnswerAll();
  const absl::StatusOr<SyntheticSet> set = ReadSyntheticSet(dataset_, folder_.path());
  ASSERT_THAT(set, IsOk());
  EXPECT_EQ(set->half, 7u);
  ASSERT_EQ(set->sequences.size(), jobs_.size());
  for (size_t i = 0; i < jobs_.size(); ++i) {
    const dataset::Sequence& sequence = set->sequences[i];
    EXPECT_EQ(sequence.interaction_class, jobs_[i].sequence.interaction_class);
    EXPECT_EQ(sequence.partner_direction, jobs_[i].sequence.partner_direction);
    const motion::Vec3 apart = sequence.pair.follower.at(3, 4) - sequence.pair.leader.at(3, 4);
    EXPECT_NEAR(apart.x, 1, 1e-5);
  }
  EXPECT_TRUE(set->sequences[0].partner_direction.has_value());
  EXPECT_FALSE(set->sequences.back().partner_direction.has_value());
}

TEST_F(SyntheticFilesTest, NamesTheLineOfAJobThatMakesNoSense) {
  AnswerAll();
  const auto invalid = [](const char* text) {
    return StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(text));
  };
  EXPECT_THAT(ReadAfter("id\tclass", "id"), invalid("jobs.tsv:1"));
  EXPECT_THAT(ReadAfter("id\thalf", "id\tclass\thalf"), IsOk());
  EXPECT_THAT(ReadAfter("give-001", "../give-001"), invalid("jobs.tsv:2: id: \"../give-001\""));
  EXPECT_THAT(ReadAfter("../give-001", "give-001"), IsOk());
  EXPECT_THAT(ReadAfter("\tgive\t", "\tgave\t"), invalid("wanted one of give, flinch"));
  EXPECT_THAT(ReadAfter("\tgave\t", "\tgive\t"), IsOk());
  EXPECT_THAT(ReadAfter("flinch\t7", "flinch\t8"), invalid("half: 8 came, wanted 7"));
  EXPECT_THAT(ReadAfter("flinch\t8", "flinch\tx"), invalid("half: \"x\" came"));
  EXPECT_THAT(ReadAfter("flinch\tx", "flinch\t7"), IsOk());
  EXPECT_THAT(ReadAfter("\t-\n", "\t0,1,0\n"), invalid("partner: \"0,1,0\""));
}

TEST_F(SyntheticFilesTest, RefusesAnswersThatDoNotFit) {
  AnswerAll();
  const auto read = [&] { return ReadSyntheticSet(dataset_, folder_.path()).status(); };
  Answer(jobs_[0], dataset_.skeleton, 30);
  EXPECT_THAT(read(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("30 came, wanted")));
  std::filesystem::copy_file(folder_ / "leaders" / (jobs_[0].sequence.id + ".json"),
                             FollowerFile(jobs_[0]),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(read(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("wanted 2")));
  std::filesystem::remove(FollowerFile(jobs_[0]));
  EXPECT_THAT(read(), StatusIs(absl::StatusCode::kNotFound, HasSubstr(jobs_[0].sequence.id)));
}

}  // namespace
}  // namespace duet::evaluation::experiments
