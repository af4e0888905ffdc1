#include "model/importing/import.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "model/dataset/dataset.h"
#include "model/formats/flat/flat_files.h"
#include "model/formats/motion_file.h"
#include "model/motion/coordinates.h"
#include "model/retargeting/reading_report.h"
#include "tests/importing/bvh_people.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::importing {
namespace {

namespace fs = std::filesystem;
using test::ReadTestFile;
using test::TemporaryFolder;
using test::WriteTestFile;

class ImportTest : public ::testing::Test {
 protected:
  ImportTest() {
    options_.from = folder_ / "captures";
    options_.out = folder_ / "studio";
  }

  absl::Status Go() {
    report_ = {};
    return Import(options_, &report_);
  }

  dataset::Dataset Read() {
    const absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(options_.out);
    EXPECT_THAT(dataset, IsOk());
    return dataset.ok() ? *dataset : dataset::Dataset{};
  }

  // What was assumed of one thing, its lines joined.
  std::string Assumed(const std::string& what) const {
    std::vector<std::string> values;
    for (const Assumption& one : report_.assumptions) {
      if (one.what == what) values.push_back(one.value);
    }
    return absl::StrJoin(values, "; ");
  }

  TemporaryFolder folder_;
  ImportOptions options_;
  ImportReport report_;
};

TEST_F(ImportTest, MakesADatasetOfBvhPairs) {
  WriteBvhPairs(options_.from, 3);
  ASSERT_THAT(Go(), IsOk());
  EXPECT_EQ(report_.pairs, 6);
  EXPECT_EQ(report_.sequences, 6);
  EXPECT_THAT(report_.refused, IsEmpty());
  const dataset::Dataset dataset = Read();
  EXPECT_EQ(dataset.name, "studio");
  EXPECT_THAT(dataset.classes, ElementsAre("kick", "shove"));
  EXPECT_EQ(dataset.frame_rate_hz, 30);
  EXPECT_EQ(dataset.skeleton.joint_count(), 20);
  EXPECT_THAT(dataset.parts, SizeIs(5));
  EXPECT_THAT(dataset.notes, IsEmpty());  // all is written out
  ASSERT_THAT(dataset.sequences, SizeIs(6));
  const dataset::Sequence& kick = dataset.sequences[0];
  EXPECT_EQ(kick.id, "kick/kick_01.txt");
  EXPECT_EQ(kick.pair.leader.frame_count(), 31);  // 60 at 60 Hz
  // Leaders were put at the origin, their partners 1.2 m ahead; a leads in the odd pairs alone.
  for (const dataset::Sequence& sequence : dataset.sequences) {
    EXPECT_NEAR(sequence.pair.leader.at(0, 0).z, 0, 1e-3) << sequence.id;
    EXPECT_NEAR(sequence.pair.follower.at(0, 0).z, 1.2, 1e-3) << sequence.id;
    EXPECT_NEAR(sequence.pair.leader.at(0, 0).y, 0.91, 1e-3) << sequence.id;
  }
  const motion::Vec3 foot = kick.pair.leader.at(15, dataset.skeleton.Find("right_foot"));
  EXPECT_GT(foot.z, 0.5f);
}

TEST_F(ImportTest, ReportsAssumptionsWithTheirFlags) {
  WriteBvhPairs(options_.from, 2);
  WriteTestFile(options_.from / "notes.md", "taken on Monday");
  ASSERT_THAT(Go(), IsOk());
  EXPECT_EQ(Assumed("ignored"), "1 .md file: not a motion");
  EXPECT_EQ(Assumed("pairs"), "4 by their names");
  EXPECT_EQ(Assumed("skeleton"), "20 joints, from kick_01_a.bvh");
  EXPECT_EQ(Assumed("root"), "hips");
  EXPECT_THAT(Assumed("joints"), HasSubstr("left_hip, right_hip: LeftUpLeg, RightUpLeg"));
  EXPECT_EQ(Assumed("unit"), "centimetres: legs are 0.93 m long");
  EXPECT_EQ(Assumed("up axis"), "y-up");
  EXPECT_THAT(Assumed("joint map"), HasSubstr("head: half way from the head's joint to Head.end, "
                                              "for 8 people"));
  EXPECT_EQ(Assumed("frame rate"), "30 frames per second, from files with 60");
  EXPECT_THAT(Assumed("leader"),
              AllOf(HasSubstr("4 pairs by who moves farther"),
                    HasSubstr("kick: who moves left_foot or right_foot farther"),
                    HasSubstr("shove: who moves left_hand or right_hand farther")));
  EXPECT_THAT(Assumed("class"), HasSubstr("kick: 2 pairs; one leads, with either hand, bodies are "
                                          "kept apart"));
  EXPECT_THAT(Assumed("level"), HasSubstr("no: people lean"));
  for (const Assumption& one : report_.assumptions) {
    if (one.what == "ignored") continue;
    EXPECT_THAT(one.flag, HasSubstr("--")) << one.what;
  }
}

TEST_F(ImportTest, FlagsOverrideInference) {
  WriteBvhPairs(options_.from, 2);
  options_.name = "fights";
  options_.to_rate_hz = 15;
  options_.symmetric = options_.touches = {"shove"};
  options_.handed = {"kick"};
  options_.level = true;
  ASSERT_THAT(Go(), IsOk());
  const dataset::Dataset dataset = Read();
  EXPECT_EQ(dataset.name, "fights");
  EXPECT_EQ(dataset.frame_rate_hz, 15);
  EXPECT_EQ(dataset.sequences[0].pair.leader.frame_count(), 16);
  EXPECT_THAT(dataset.symmetric, ElementsAre(false, true));
  EXPECT_THAT(dataset.touches, ElementsAre(false, true));
  EXPECT_THAT(dataset.handed, ElementsAre(true, false));
  EXPECT_THAT(ReadTestFile(options_.out / "dataset.json"), HasSubstr("\"level\": true"));
}

TEST_F(ImportTest, ReportsUnknownClassesInFlags) {
  WriteBvhPairs(options_.from, 1);
  options_.handed = {"punch"};
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kInvalidArgument,
                             HasSubstr("--handed: expected one of kick, shove, got \"punch\"")));
  EXPECT_FALSE(fs::exists(options_.out));
}

TEST_F(ImportTest, ATableSpecifiesLeadersAndSubjects) {
  WriteBvhPairs(options_.from, 1);
  WriteTestFile(options_.from / "pairs.tsv",
                "leader\tfollower\tlabel\tsubjects\n"
                "kick_01_b.bvh\tkick_01_a.bvh\tduel\tbo,ann\n");
  ASSERT_THAT(Go(), IsOk());
  const dataset::Dataset dataset = Read();
  EXPECT_THAT(dataset.classes, ElementsAre("duel"));
  ASSERT_THAT(dataset.sequences, SizeIs(1));
  EXPECT_THAT(dataset.sequences[0].subjects, ElementsAre("bo", "ann"));
  EXPECT_EQ(dataset.sequences[0].leader_source, "index");
  EXPECT_NEAR(dataset.sequences[0].pair.leader.at(0, 0).z, 1.2, 1e-3);
}

// Coordinates that people may be captured in.
struct CapturedIn {
  double units_per_centimetre;
  const char* unit;
  motion::UpAxis up_axis;
};

// The same motion in other coordinates, as BVH.
std::string BvhIn(const CapturedIn& coordinates, const motion::Clip& person) {
  motion::Clip clip = person;
  for (motion::Vec3& p : clip.poses.all()) {
    p = FromWorld({motion::LengthUnit::kMetres, coordinates.up_axis}, p);
  }
  formats::WriteOptions options;
  options.bvh_metres_per_unit = 0.01 / coordinates.units_per_centimetre;
  const absl::StatusOr<std::string> text =
      formats::FormatPeople(formats::Format::kBvh, {clip}, motion::SbuSkeleton(), options);
  EXPECT_THAT(text, IsOk());
  return text.value_or("");
}

// How a reader of a single file understands it, as `duet inspect` and `duet synthesize` do.
retargeting::ReadingReport ReadAlone(const fs::path& file) {
  retargeting::ReadingReport report;
  formats::ReadOptions options;
  options.report = &report;
  EXPECT_THAT(formats::ReadLeader(file, options), IsOk());
  return report;
}

TEST_F(ImportTest, InfersTheSameUnitAndAxisAsAReaderOfOneFile) {
  const motion::Clip a = test::MakePerson(), b = test::MakePerson({60, 3, 0, {0, 1.1f, 1.2f}, 30});
  const std::pair<double, const char*> units[] = {{1, "centimetres"},          {0.01, "metres"},
                                                  {10, "millimetres"},         {1 / 2.54, "inches"},
                                                  {0.45 / 2.54, "CMU's unit"}, {0.1, "decimetres"}};
  options_.overwrite = true;
  options_.skeleton = "sbu";
  fs::create_directories(options_.from);
  for (const auto& [factor, unit] : units) {
    for (const auto axis : {motion::UpAxis::kYUp, motion::UpAxis::kZUp, motion::UpAxis::kYDown}) {
      const CapturedIn coordinates = {factor, unit, axis};
      WriteTestFile(options_.from / "hug_a.bvh", BvhIn(coordinates, a));
      WriteTestFile(options_.from / "hug_b.bvh", BvhIn(coordinates, b));
      ASSERT_THAT(Go(), IsOk()) << unit;
      const retargeting::ReadingReport report = ReadAlone(options_.from / "hug_a.bvh");
      EXPECT_THAT(report.unit->value, HasSubstr(unit));
      EXPECT_THAT(Assumed("unit"), StartsWith(report.unit->value + ":"));
      EXPECT_EQ(report.up_axis->value, UpAxisName(axis));
      EXPECT_EQ(Assumed("up axis"), report.up_axis->value);
    }
  }
}

TEST_F(ImportTest, RejectsLegsOfNoPersonInAnyUsualUnit) {
  BvhPerson giant;
  giant.scale = 3;
  WriteBvhPairs(options_.from, 1, giant);
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kInvalidArgument,
                             AllOf(HasSubstr("unit: expected legs of 0.7 to 1.4 m"),
                                   HasSubstr("specify --metres-per-unit"))));
}

// Two files of one person as one file of two ROOTs.
std::string Joined(const std::string& a, const std::string& b) {
  const std::vector<std::string> first = absl::StrSplit(a, "MOTION\n");
  const std::vector<std::string> second = absl::StrSplit(b, "MOTION\n");
  const std::vector<std::string> lines = absl::StrSplit(first[1], '\n');
  const std::vector<std::string> more = absl::StrSplit(second[1], '\n');
  std::string text = absl::StrCat(first[0], second[0].substr(std::string("HIERARCHY\n").size()),
                                  "MOTION\n", lines[0], "\n", lines[1], "\n");
  for (std::size_t i = 2; i + 1 < lines.size(); ++i) {
    absl::StrAppend(&text, lines[i], " ", more[i], "\n");
  }
  return text;
}

TEST_F(ImportTest, OneFileMayHoldBothPeople) {
  BvhPerson follower;
  follower.leads = false;
  follower.prefix = "Second:";
  fs::create_directories(options_.from);
  WriteTestFile(options_.from / "kick_01.bvh", Joined(BvhText({}), BvhText(follower)));
  ASSERT_THAT(Go(), IsOk());
  const dataset::Dataset dataset = Read();
  EXPECT_EQ(dataset.sequences[0].id, "kick/kick_01.txt");
  EXPECT_NEAR(dataset.sequences[0].pair.follower.at(0, 0).z, 1.2, 1e-3);
}

TEST_F(ImportTest, ReadsEveryFormatOfPairs) {
  test::PersonOptions across;
  across.at = {0, 1.1f, 1};
  const motion::ClipPair pair = {test::MakePerson(), test::MakePerson(across)};
  options_.level = false;
  for (const char* extension : {"csv", "json", "npy"}) {
    options_.from = folder_ / extension;
    options_.out = folder_ / absl::StrCat(extension, "_set");
    fs::create_directories(options_.from);
    const fs::path file = options_.from / absl::StrCat("greet_1.", extension);
    ASSERT_THAT(formats::WritePair(file, pair, motion::SbuSkeleton()), IsOk());
    options_.frame_rate_hz = std::nullopt;
    if (std::string(extension) == "npy") {
      EXPECT_THAT(Go(), Not(IsOk()));
      EXPECT_THAT(report_.refused[0].reason, HasSubstr("--frame-rate"));
      options_.frame_rate_hz = 30;
    }
    ASSERT_THAT(Go(), IsOk()) << extension;
    const dataset::Dataset dataset = Read();
    EXPECT_EQ(dataset.skeleton.joint_names, motion::SbuSkeleton().joint_names);
    EXPECT_LT(test::LargestDistance(dataset.sequences[0].pair.leader, pair.leader), 1e-5f);
    EXPECT_LT(test::LargestDistance(dataset.sequences[0].pair.follower, pair.follower), 1e-5f);
  }
}

TEST_F(ImportTest, RejectedPairsAreReported) {
  WriteBvhPairs(options_.from, 1);
  fs::rename(options_.from / "shove_01_b.bvh", options_.from / "shove_02_b.bvh");
  WriteTestFile(options_.from / "hug_01_a.bvh", "HIERARCHY\n");
  WriteTestFile(options_.from / "hug_01_b.bvh", BvhText({}));
  WriteTestFile(options_.from / "wave_01.bvh", BvhText({}));
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kInvalidArgument,
                             HasSubstr("4 refused and 1 usable; nothing was written")));
  EXPECT_FALSE(fs::exists(options_.out));
  ASSERT_THAT(report_.refused, SizeIs(4));
  EXPECT_THAT(report_.refused[0].reason, HasSubstr("expected a file that ends in b"));
  EXPECT_THAT(report_.refused[2].name, "hug_01_a.bvh and hug_01_b.bvh");
  EXPECT_THAT(report_.refused[2].reason, HasSubstr("hug_01_a.bvh:"));
  EXPECT_THAT(report_.refused[3].reason, HasSubstr("people: expected 2 in the file"));
  options_.skip_refused = true;
  ASSERT_THAT(Go(), IsOk());
  EXPECT_THAT(report_.refused, SizeIs(4));
  EXPECT_THAT(Read().sequences, SizeIs(1));
}

TEST_F(ImportTest, PeopleInWorldsOfTheirOwnAreRejected) {
  WriteBvhPairs(options_.from, 1);
  BvhPerson also_leads;
  also_leads.variant = 1;
  WriteTestFile(options_.from / "kick_01_b.bvh", BvhText(also_leads));
  EXPECT_THAT(Go(), Not(IsOk()));
  ASSERT_THAT(report_.refused, SizeIs(1));
  EXPECT_THAT(report_.refused[0].reason,
              HasSubstr("distance of the two people: expected 0.05 to 10 m, got 0 m"));
}

TEST_F(ImportTest, LongPairsAreCutAndUnequalOnesTrimmed) {
  BvhPerson person;
  person.frames = 150;
  WriteBvhPairs(options_.from, 2, person);
  person.leads = false;
  person.frames = 130;
  WriteTestFile(options_.from / "kick_01_b.bvh", BvhText(person));
  options_.longest_seconds = 1;
  ASSERT_THAT(Go(), IsOk());
  EXPECT_EQ(report_.pairs, 4);
  EXPECT_EQ(report_.sequences, 12);
  EXPECT_THAT(Assumed("length"), HasSubstr("1 pair whose people differ by up to 0.33 s"));
  EXPECT_THAT(Assumed("longest"), HasSubstr("cut 4 longer pairs"));
  const dataset::Dataset dataset = Read();
  EXPECT_EQ(dataset.sequences[0].id, "kick/kick_01_p1.txt");
  int frames = 0;
  for (const dataset::Sequence& sequence : dataset.sequences) {
    if (sequence.interaction_class == 0) frames += sequence.pair.leader.frame_count();
    // The piece in which nobody acts is led by whoever leads the whole.
    EXPECT_NEAR(sequence.pair.leader.at(0, 0).z, 0, 0.01) << sequence.id;
  }
  EXPECT_EQ(frames, 66 + 76);
}

TEST_F(ImportTest, ReplacesOnlyDatasetsAndOnlyWhenAsked) {
  WriteBvhPairs(options_.from, 1);
  ASSERT_THAT(Go(), IsOk());
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr("--overwrite")));
  WriteTestFile(options_.out / "kick" / "stale.txt", "of an earlier import");
  options_.overwrite = true;
  ASSERT_THAT(Go(), IsOk());
  EXPECT_FALSE(fs::exists(options_.out / "kick" / "stale.txt"));
  options_.out = folder_ / "thesis";
  fs::create_directories(options_.out);
  WriteTestFile(options_.out / "chapter1", "dear to somebody");
  EXPECT_THAT(
      Go(), StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr("got a folder with other files")));
  EXPECT_TRUE(fs::exists(options_.out / "chapter1"));
  fs::create_symlink("loop", folder_ / "loop");
  options_.out = folder_ / "loop";
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kNotFound, HasSubstr("loop: no such folder")));
  options_.out = options_.from / "inside";
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kInvalidArgument,
                             HasSubstr("--out: expected a folder outside --from")));
}

TEST_F(ImportTest, AFailedImportKeepsTheDatasetThatWasThere) {
  WriteBvhPairs(options_.from, 1);
  ASSERT_THAT(Go(), IsOk());
  WriteTestFile(options_.from / "kick_01_a.bvh", "broken");
  options_.overwrite = true;
  EXPECT_THAT(Go(), Not(IsOk()));
  EXPECT_THAT(Read().sequences, SizeIs(2));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2);  // nothing beside it
}

TEST_F(ImportTest, ReportsTheExpectedNamesIfThereAreNoPairs) {
  fs::create_directories(options_.from);
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kInvalidArgument,
                             AllOf(HasSubstr("no pairs among 0 motion files"),
                                   HasSubstr("kick_01_a.bvh and kick_01_b.bvh"))));
  options_.from = folder_ / "nowhere";
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kNotFound, HasSubstr("nowhere")));
}

}  // namespace
}  // namespace duet::importing
