#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "model/evaluation/experiments/synthetic_set.h"
#include "model/formats/flat/sbu_text.h"
#include "model/formats/motion_file.h"
#include "model/motion/skeleton_json.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::evaluation::experiments {
namespace {

using test::MadeUpPairs;
using test::ReadTestFile;
using test::TemporaryFolder;
using test::WriteTestFile;

// The jobs of a small set, written as for `duet batch`, and a data set as it answers: here each
// leader's own motion, moved by a metre.
class SyntheticFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    dataset_.sequences[0].partner_direction = motion::Vec3{0, 0, -1};
    jobs_ = PlanSyntheticSet(dataset_, {0, 2}, {1, 1, 7});
    ASSERT_THAT(WriteSyntheticJobs(dataset_, jobs_, 7, folder_ / "jobs"), IsOk());
    WriteLayout(dataset_.skeleton, dataset_.frame_rate_hz);
    std::string sides = "path\tleader_side\n", index;
    for (const SyntheticJob& job : jobs_) {
      WriteAnswer(job);
      absl::StrAppend(&sides, PathOf(job), "\tright\n");
      absl::StrAppend(&index, EntryOf(job), "\n");
    }
    WriteTestFile(folder_ / "set/index.tsv", sides);
    WriteTestFile(folder_ / "set/index.jsonl", index);
  }

  void WriteLayout(const motion::Skeleton& skeleton, double frame_rate_hz) {
    std::filesystem::create_directories(folder_ / "set");
    const nlohmann::json layout = {{"name", "made up"},
                                   {"frame_rate_hz", frame_rate_hz},
                                   {"unit", "metres"},
                                   {"up_axis", "y-up"},
                                   {"level", true},
                                   {"skeleton", SkeletonToJson(skeleton, motion::SbuParts())},
                                   {"classes", {{{"name", "give"}}, {{"name", "flinch"}}}}};
    WriteTestFile(folder_ / "set/dataset.json", layout.dump());
  }

  std::string PathOf(const SyntheticJob& job) const {
    return absl::StrCat(job.sequence.interaction_class == 0 ? "give/" : "flinch/", job.sequence.id,
                        ".txt");
  }

  std::string EntryOf(const SyntheticJob& job) const {
    nlohmann::json entry = {{"files", {{{"path", PathOf(job)}}}}, {"extra", {{"half", "7"}}}};
    if (const auto& to = job.sequence.partner_direction; to.has_value()) {
      entry["partner_direction"] = {to->x, to->y, to->z};
    }
    return entry.dump();
  }

  void WriteAnswer(const SyntheticJob& job) {
    formats::flat::SbuOptions options;
    options.coordinates = {};
    motion::Clip follower = job.sequence.pair.leader;
    for (motion::Vec3& point : follower.poses.all()) point.x += 1;
    const auto text = formats::flat::FormatSbu({follower, job.sequence.pair.leader}, options);
    ASSERT_THAT(text, IsOk());
    std::filesystem::create_directories((folder_ / "set" / PathOf(job)).parent_path());
    WriteTestFile(folder_ / "set" / PathOf(job), *text);
  }

  absl::StatusOr<SyntheticSet> Read() { return ReadSyntheticSet(dataset_, folder_ / "set"); }
  absl::Status ReadAfter(const std::string& from, const std::string& to) {
    const std::filesystem::path file = folder_ / "set/index.jsonl";
    WriteTestFile(file, absl::StrReplaceAll(ReadTestFile(file), {{from, to}}));
    return Read().status();
  }

  dataset::Dataset dataset_ = MadeUpPairs(2);
  std::vector<SyntheticJob> jobs_;
  TemporaryFolder folder_;
};

TEST_F(SyntheticFilesTest, LeadersAreFilesThatTheClientReads) {
  for (const SyntheticJob& job : jobs_) {
    const std::filesystem::path file = folder_ / "jobs/leaders" / (job.sequence.id + ".json");
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

TEST_F(SyntheticFilesTest, ManifestHasLabelsDirectionAndHalf) {
  const std::vector<std::string> lines =
      absl::StrSplit(ReadTestFile(folder_ / "jobs/manifest.tsv"), '\n');
  ASSERT_THAT(lines, testing::SizeIs(jobs_.size() + 2));  // the header, and the last line's end
  EXPECT_EQ(lines[0], "leader\tlabels\tpartner_direction\thalf");
  EXPECT_THAT(lines[1], testing::MatchesRegex("leaders/give-001.json\tgive=[0-9.]+\t0,0,-1\t7"));
  EXPECT_THAT(lines[4],
              testing::MatchesRegex("leaders/flinch-004.json\tgive=[0-9.]+,flinch=[0-9.]+\t\t7"));
}

TEST_F(SyntheticFilesTest, LeadersOfASetLieInItsFolder) {
  jobs_[0].sequence.set = "s01s02";
  ASSERT_THAT(WriteSyntheticJobs(dataset_, jobs_, 7, folder_ / "sets"), IsOk());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "sets/leaders/s01s02/give-001.json"));
  EXPECT_THAT(ReadTestFile(folder_ / "sets/manifest.tsv"),
              HasSubstr("\nleaders/s01s02/give-001.json\t"));
}

TEST_F(SyntheticFilesTest, AnsweredSetIsReadBack) {
  const absl::StatusOr<SyntheticSet> set = Read();
  ASSERT_THAT(set, IsOk());
  EXPECT_EQ(set->half, 7u);
  ASSERT_EQ(set->sequences.size(), jobs_.size());
  for (const SyntheticJob& job : jobs_) {
    const auto found =
        std::find_if(set->sequences.begin(), set->sequences.end(),
                     [&](const dataset::Sequence& one) { return one.id == PathOf(job); });
    ASSERT_NE(found, set->sequences.end());
    EXPECT_EQ(found->interaction_class, job.sequence.interaction_class);
    EXPECT_EQ(found->partner_direction, job.sequence.partner_direction);
    // In the world that was asked for: the reader's levelling is undone.
    EXPECT_LT(Distance(found->pair.leader.at(3, 4), job.sequence.pair.leader.at(3, 4)), 1e-5f);
    const motion::Vec3 apart = found->pair.follower.at(3, 4) - found->pair.leader.at(3, 4);
    EXPECT_NEAR(apart.x, 1, 1e-5);
  }
}

TEST_F(SyntheticFilesTest, InvalidEntriesAreErrorsThatNameTheLine) {
  const auto invalid = [](const char* text) {
    return StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(text));
  };
  EXPECT_THAT(ReadAfter("\"half\":\"7\"", "\"hall\":\"7\""), invalid("index.jsonl:1: extra.half"));
  EXPECT_THAT(ReadAfter("\"hall\":\"7\"", "\"half\":\"x\""), invalid("got \"x\""));
  EXPECT_THAT(ReadAfter("\"half\":\"x\"", "\"half\":\"7\""), IsOk());
  EXPECT_THAT(ReadAfter("0.0,0.0,-1.0", "0.0,\"a\",-1.0"), invalid("partner_direction"));
  EXPECT_THAT(ReadAfter("0.0,\"a\",-1.0", "0.0,0.0,-1.0"), IsOk());
  EXPECT_THAT(ReadAfter("give/give-001.txt", "give/give-009.txt"),
              invalid("expected an entry of \"give/give-001.txt\", got none"));
  EXPECT_THAT(ReadAfter("give/give-009.txt", "give/give-001.txt"), IsOk());
  const std::string index = ReadTestFile(folder_ / "set/index.jsonl");
  WriteTestFile(folder_ / "set/index.jsonl",
                index + R"({"files":[{"path":"a"}],"extra":{"half":"8"}})" + "\n");
  EXPECT_THAT(Read(), invalid("index.jsonl:5: half: expected 7 as above, got 8"));
  WriteTestFile(folder_ / "set/index.jsonl",
                index + R"({"files":[{"path":"a"}],"extra":{"half":"7"}})" + "\n");
  EXPECT_THAT(Read(), invalid("expected the 4 clips of the folder, got 5"));
  std::filesystem::remove(folder_ / "set/index.jsonl");
  EXPECT_THAT(Read(), StatusIs(absl::StatusCode::kNotFound, HasSubstr("index.jsonl")));
}

TEST_F(SyntheticFilesTest, RefusesSetsOfOtherData) {
  const auto wanted = [](const char* what) {
    return StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(what));
  };
  WriteLayout(dataset_.skeleton, 30);
  EXPECT_THAT(Read(), wanted("expected the frame rate of the data"));
  motion::Skeleton other = dataset_.skeleton;
  other.joint_names[0] = "hat";
  WriteLayout(other, dataset_.frame_rate_hz);
  EXPECT_THAT(Read(), wanted("expected the joints of the data"));
  WriteLayout(dataset_.skeleton, dataset_.frame_rate_hz);
  dataset_.classes[1] = "dodge";
  EXPECT_THAT(Read(), wanted("expected the classes of the data"));
}

}  // namespace
}  // namespace duet::evaluation::experiments
