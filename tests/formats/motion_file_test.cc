#include "model/formats/motion_file.h"

#include <clocale>
#include <cmath>
#include <filesystem>
#include <locale>
#include <map>
#include <string>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/file.h"
#include "model/formats/flat/flat_files.h"
#include "model/formats/follower_rig.h"
#include "tests/formats/gltf/gltf_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_motion.h"

namespace duet::formats {
namespace {

using test::LargestDistance;
using test::MakePerson;

namespace fs = std::filesystem;

const motion::Skeleton kSkeleton = motion::SbuSkeleton();

class MotionFile : public ::testing::Test {
 protected:
  const motion::ClipPair pair_{MakePerson(), MakePerson({60, 3, 0, {0, 1.1f, 1.2f}, 30})};
  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

// The error of a writer.
std::string Refusal(const absl::StatusOr<std::vector<fs::path>>& written) {
  return std::string(written.status().message());
}

TEST_F(MotionFile, ReadsBackTheOnePersonThatItWrites) {
  for (const char* name : {"one.csv", "one.json", "one.npy", "one.bvh"}) {
    const fs::path file = folder_ / name;
    const auto written = WritePeople(file, *FormatOf(file), {pair_.leader}, kSkeleton);
    ASSERT_THAT(written, IsOk());
    EXPECT_THAT(*written, ElementsAre(file));
    retargeting::ReadingReport report;
    ReadOptions options;
    options.frame_rate_hz = 30;
    options.side = Side::kRight;  // one person serves either side
    options.report = &report;
    const auto read = ReadLeader(file, options);
    ASSERT_THAT(read, IsOk());
    EXPECT_LT(LargestDistance(*read, pair_.leader), 1e-4f) << name;
    EXPECT_EQ(report.people, 1) << name;
  }
}

TEST_F(MotionFile, ParsesAMotionThatIsNotAFile) {
  const auto csv = FormatPeople(Format::kCsv, {pair_.leader, pair_.follower}, kSkeleton);
  ASSERT_TRUE(csv.ok());
  ReadOptions options;
  options.side = Side::kRight;
  EXPECT_FALSE(ParseLeader(*csv, "a pipe", options).ok());
  options.format = Format::kCsv;
  const auto follower = ParseLeader(*csv, "a pipe", options);
  ASSERT_THAT(follower, IsOk());
  EXPECT_EQ(LargestDistance(*follower, pair_.follower), 0);
  options.format = Format::kBvh;
  EXPECT_THAT(std::string(ParseLeader(*csv, "a pipe", options).status().message()),
              HasSubstr("a pipe:1: "));
}

TEST_F(MotionFile, RejectsPeopleThatAFormatCannotHold) {
  const auto refused = [&](Format format, const std::vector<motion::Clip>& people) {
    return std::string(FormatPeople(format, people, kSkeleton).status().message());
  };
  EXPECT_THAT(refused(Format::kBvh, {pair_.leader, pair_.follower}),
              HasSubstr("people: expected 1, got 2"));
  EXPECT_THAT(refused(Format::kCsv, {}), HasSubstr("people: expected one or two, got 0"));
  EXPECT_THAT(refused(Format::kCsv, {pair_.leader, pair_.follower, pair_.leader}),
              HasSubstr("people: expected one or two, got 3"));
}

TEST_F(MotionFile, ReportNamesTheOriginOfEachDecision) {
  using retargeting::Origin;
  const fs::path file = folder_ / "half.csv";
  auto text = FormatPeople(Format::kCsv, {pair_.leader}, kSkeleton);
  ASSERT_TRUE(text.ok());
  const std::string comment = text->substr(0, text->find('\n'));
  text->replace(0, comment.size(), "# unit=metres");
  ASSERT_TRUE(base::WriteFile(file, *text).ok());
  retargeting::ReadingReport report;
  ReadOptions options;
  options.report = &report;
  EXPECT_FALSE(ReadLeader(file, options).ok());
  EXPECT_EQ(report.format, "CSV");
  EXPECT_EQ(report.frame_rate, std::nullopt);
  EXPECT_EQ(report.unit->origin, Origin::kFile);
  EXPECT_EQ(report.up_axis->origin, Origin::kDefault);
  ASSERT_EQ(report.joints.size(), 15u);
  EXPECT_EQ(report.joints[0].parts[0].name, "head");
  options.frame_rate_hz = 25;
  options.coordinates = motion::Coordinates{};
  EXPECT_TRUE(ReadLeader(file, options).ok());
  EXPECT_EQ(report.frame_rate->value, "25 Hz");
  EXPECT_EQ(report.frame_rate->origin, Origin::kGiven);
  EXPECT_EQ(report.up_axis->origin, Origin::kGiven);
}

TEST_F(MotionFile, ReadsBackThePairThatItWrites) {
  const std::map<const char*, float> errors = {{"a.csv", 0},     {"a.json", 0},    {"a.npy", 0},
                                               {"a.CSV", 0},     {"a.txt", 1e-5f}, {"a.glb", 2e-5f},
                                               {"a.gltf", 2e-5f}};
  for (const auto& [name, most] : errors) {
    const fs::path path = folder_ / name;
    const auto written = WritePair(path, pair_, kSkeleton);
    ASSERT_THAT(written, IsOk());
    EXPECT_THAT(*written, ElementsAre(path));
    ReadOptions options;
    if (path.extension() == ".npy" || path.extension() == ".txt") options.frame_rate_hz = 30;
    for (Side side : {Side::kLeft, Side::kRight}) {
      options.side = side;
      const absl::StatusOr<motion::Clip> clip = ReadLeader(path, options);
      ASSERT_THAT(clip, IsOk());
      EXPECT_EQ(clip->frame_rate_hz, 30);
      EXPECT_LE(LargestDistance(*clip, side == Side::kLeft ? pair_.leader : pair_.follower), most);
    }
  }
  const bool binary[] = {
      base::ReadFile(folder_ / "a.glb", 1 << 24, "a motion")->substr(0, 4) == "glTF",
      base::ReadFile(folder_ / "a.gltf", 1 << 24, "a motion")->at(0) != '{'};
  EXPECT_THAT(binary, ElementsAre(true, false));
}

TEST_F(MotionFile, MetresPerUnitScaleEveryFormatOfPositions) {
  for (const char* name : {"a.csv", "a.json", "a.npy", "a.txt"}) {
    ASSERT_TRUE(WritePair(folder_ / name, pair_, kSkeleton).ok());
    ReadOptions options;
    options.frame_rate_hz = 30;
    options.coordinates = motion::Coordinates{};
    const absl::StatusOr<motion::Clip> metres = ReadLeader(folder_ / name, options);
    ASSERT_THAT(metres, IsOk());
    options.coordinates.reset();
    options.metres_per_unit = 0.5;
    const absl::StatusOr<motion::Clip> half = ReadLeader(folder_ / name, options);
    ASSERT_THAT(half, IsOk());
    motion::Clip expected = *metres;
    for (motion::Vec3& p : expected.poses.all()) p = p * 0.5F;
    EXPECT_LT(LargestDistance(*half, expected), 1e-5F) << name;
    options.metres_per_unit = 2000;
    EXPECT_THAT(ReadLeader(folder_ / name, options),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("metres per unit")));
  }
}

TEST_F(MotionFile, WritesBvhInTheRequestedUnit) {
  WriteOptions metres;
  metres.bvh_metres_per_unit = 1;
  const auto text = FormatPeople(Format::kBvh, {pair_.leader}, kSkeleton, metres);
  ASSERT_THAT(text, IsOk());
  ReadOptions options;
  options.format = Format::kBvh;
  options.metres_per_unit = 1;
  const absl::StatusOr<motion::Clip> clip = ParseLeader(*text, "written", options);
  ASSERT_THAT(clip, IsOk());
  EXPECT_LT(LargestDistance(*clip, pair_.leader), 1e-3f);
}

TEST_F(MotionFile, WritesABvhForEachPersonInOneWorld) {
  const absl::StatusOr<std::vector<fs::path>> written =
      WritePair(folder_ / "a.b.bvh", pair_, kSkeleton);
  ASSERT_THAT(written, IsOk());
  EXPECT_THAT(*written, ElementsAre(folder_ / "a.b.leader.bvh", folder_ / "a.b.follower.bvh"));
  const absl::StatusOr<motion::Clip> leader = ReadLeader((*written)[0]);
  const absl::StatusOr<motion::Clip> follower = ReadLeader((*written)[1]);
  ASSERT_THAT(leader, IsOk());
  ASSERT_THAT(follower, IsOk());
  EXPECT_LT(LargestDistance(*leader, pair_.leader), 0.001f);
  EXPECT_LT(LargestDistance(*follower, pair_.follower), 0.001f);
}

TEST_F(MotionFile, ReadsEitherPersonOfAGltfFileAndItsBufferBesideIt) {
  test::GltfBuilder builder;
  test::AddPerson(pair_.leader, {}, &builder);
  test::AddPerson(pair_.follower, {}, &builder);
  ASSERT_TRUE(base::WriteFile(folder_ / "a.glb", builder.Binary()).ok());
  ASSERT_TRUE(base::WriteFile(folder_ / "b.gltf", builder.WithFile("b.bin")).ok());
  ASSERT_TRUE(base::WriteFile(folder_ / "b.bin", builder.buffer()).ok());
  for (const char* name : {"a.glb", "b.gltf"}) {
    ReadOptions options;
    options.metres_per_unit = 2;
    options.frame_rate_hz = 30;
    for (Side side : {Side::kLeft, Side::kRight}) {
      options.side = side;
      const absl::StatusOr<motion::Clip> clip = ReadLeader(folder_ / name, options);
      ASSERT_THAT(clip, IsOk());
      motion::Clip larger = side == Side::kLeft ? pair_.leader : pair_.follower;
      for (motion::Vec3& p : larger.poses.all()) p = p * 2;
      EXPECT_LT(LargestDistance(*clip, larger), 0.002f) << name;
    }
    EXPECT_TRUE(IsReadable(name));
  }
}

TEST_F(MotionFile, ABufferIsNoLinkToAnotherFolder) {
  test::GltfBuilder builder;
  test::AddPerson(pair_.leader, {}, &builder);
  for (const char* name : {"here", "store", "elsewhere"}) fs::create_directory(folder_ / name);
  ASSERT_TRUE(base::WriteFile(folder_ / "here/a.gltf", builder.WithFile("a.bin")).ok());
  ASSERT_TRUE(base::WriteFile(folder_ / "elsewhere/a.bin", builder.buffer()).ok());
  fs::create_symlink(folder_ / "elsewhere/a.bin", folder_ / "here/a.bin");
  const auto refused = StatusIs(absl::StatusCode::kInvalidArgument,
                                HasSubstr("got a link to a file in another folder"));
  EXPECT_THAT(ReadLeader(folder_ / "here/a.gltf").status(), refused);
  EXPECT_THAT(FormatOntoRig(pair_.leader, {folder_ / "here/a.gltf", {}}, Format::kGlb).status(),
              refused);
  // A link to a neighbour.
  ASSERT_TRUE(base::WriteFile(folder_ / "here/b.bin", builder.buffer()).ok());
  fs::remove(folder_ / "here/a.bin");
  fs::create_symlink("b.bin", folder_ / "here/a.bin");
  EXPECT_THAT(ReadLeader(folder_ / "here/a.gltf").status(), IsOk());
  // Both are links to one folder, as in a cache of downloads.
  fs::remove(folder_ / "here/a.bin");
  fs::rename(folder_ / "here/a.gltf", folder_ / "store/1");
  fs::rename(folder_ / "here/b.bin", folder_ / "store/2");
  fs::create_symlink(folder_ / "store/1", folder_ / "here/a.gltf");
  fs::create_symlink(folder_ / "store/2", folder_ / "here/a.bin");
  EXPECT_THAT(ReadLeader(folder_ / "here/a.gltf").status(), IsOk());
}

TEST_F(MotionFile, SbuTextHasTheRateOfSbuUnlessTheCallerStatesOne) {
  const fs::path path = folder_ / "skeleton_pos.txt";
  ASSERT_TRUE(base::WriteFile(path, *flat::FormatSbu({pair_.leader, pair_.follower})).ok());
  EXPECT_EQ(ReadLeader(path)->frame_rate_hz, 15);
}

TEST_F(MotionFile, UsesTheCallersCoordinates) {
  const fs::path path = folder_ / "a.csv";
  std::string header = "frame", row = "0";
  for (const std::string& joint : kSkeleton.joint_names) {
    absl::StrAppend(&header, ",", joint, "_x,", joint, "_y,", joint, "_z");
    absl::StrAppend(&row, ",1000,2000,3000");
  }
  ASSERT_TRUE(base::WriteFile(path, absl::StrCat(header, "\n", row, "\n")).ok());
  ReadOptions options;
  EXPECT_THAT(std::string(ReadLeader(path, options).status().message()),
              HasSubstr("frame rate: expected one, got none"));
  options.frame_rate_hz = 24;
  options.coordinates = {motion::LengthUnit::kMillimetres, motion::UpAxis::kZUp};
  const absl::StatusOr<motion::Clip> clip = ReadLeader(path, options);
  ASSERT_THAT(clip, IsOk());
  EXPECT_LT(Distance(clip->at(0, 7), {1, 3, -2}), 1e-6f);
}

TEST_F(MotionFile, WarnsIfTheUpAxisIsProbablyAnother) {
  motion::ClipPair z_up = pair_;
  for (motion::Clip* clip : {&z_up.leader, &z_up.follower}) {
    for (motion::Vec3& p : clip->poses.all()) p = {p.x, -p.z, p.y};
  }
  const fs::path path = folder_ / "a.csv";
  ASSERT_TRUE(WritePair(path, z_up, kSkeleton).ok());
  std::vector<std::string> notes;
  ReadOptions options;
  options.notes = &notes;
  ASSERT_TRUE(ReadLeader(path, options).ok());
  EXPECT_THAT(notes, Contains(HasSubstr("not below the root along y; z-up would fit")));
  notes.clear();
  options.coordinates = {motion::LengthUnit::kMetres, motion::UpAxis::kZUp};
  const absl::StatusOr<motion::Clip> clip = ReadLeader(path, options);
  ASSERT_THAT(clip, IsOk());
  EXPECT_LT(LargestDistance(*clip, pair_.leader), 1e-5f);
  EXPECT_THAT(notes, ::testing::IsEmpty());
  options.coordinates.reset();
  ASSERT_TRUE(WritePair(path, pair_, kSkeleton).ok());
  ASSERT_TRUE(ReadLeader(path, options).ok());
  EXPECT_THAT(notes, ::testing::IsEmpty());
}

// Two joints may be the neck: in the first frame the upper one is between the shoulders, in all
// others the lower one.
TEST_F(MotionFile, MapsJointsFromTheWholeMotion) {
  motion::Clip person = pair_.leader;
  person.joint_names[1] = "LowerNeck";
  person.joint_names.push_back("UpperNeck");
  std::string text = "frame";
  for (const std::string& joint : person.joint_names) {
    absl::StrAppend(&text, ",", joint, "_x,", joint, "_y,", joint, "_z");
  }
  for (const int frame : {0, 1, 2}) {
    absl::StrAppend(&text, "\n", frame);
    std::vector<motion::Vec3> pose(pair_.leader.poses[0].begin(), pair_.leader.poses[0].end());
    pose.push_back(pose[1] + motion::Vec3{0, 0.05f, 0});
    if (frame == 0) std::swap(pose[1], pose.back());
    for (const motion::Vec3& p : pose) absl::StrAppend(&text, ",", p.x, ",", p.y, ",", p.z);
  }
  const fs::path path = folder_ / "a.csv";
  ASSERT_TRUE(base::WriteFile(path, text + "\n").ok());
  ReadOptions options;
  options.frame_rate_hz = 30;
  std::vector<std::string> notes;
  options.notes = &notes;
  const absl::StatusOr<motion::Clip> clip = ReadLeader(path, options);
  ASSERT_THAT(clip, IsOk());
  EXPECT_THAT(notes, Contains(HasSubstr("neck: LowerNeck (")));
}

TEST_F(MotionFile, ReadsTheFirstFrameAsAFollowersStart) {
  const absl::StatusOr<std::vector<fs::path>> written =
      WritePair(folder_ / "a.npy", pair_, kSkeleton);
  ASSERT_TRUE(written.ok());
  ReadOptions options;
  options.side = Side::kRight;
  const absl::StatusOr<std::vector<motion::Vec3>> start = ReadFollowerStart((*written)[0], options);
  ASSERT_THAT(start, IsOk());
  ASSERT_EQ(start->size(), 15u);
  EXPECT_EQ((*start)[14], pair_.follower.at(0, 14));
}

TEST_F(MotionFile, ReportsTheKnownExtensions) {
  EXPECT_THAT(std::string(ReadLeader("a.obj").status().message()),
              HasSubstr("extension: expected .txt (SBU text), .bvh"));
  EXPECT_THAT(Refusal(WritePair("a.obj", pair_, kSkeleton)),
              HasSubstr("extension: expected .glb, .gltf, .bvh, .csv"));
  for (const char* known : {"a.json", "a.txt", "a.BVH"}) EXPECT_TRUE(IsReadable(known)) << known;
  for (const char* other : {"a", "a.obj", "a.sbu"}) EXPECT_FALSE(IsReadable(other)) << other;
}

TEST_F(MotionFile, NamesTheProgramThatConvertsAnotherFormat) {
  const std::map<std::string, std::string> converters = {{"a.fbx", "convert it with duet_fbx.py"},
                                                         {"a.FBX", "convert it with duet_fbx.py"},
                                                         {"01_02.amc", "duet_asf.py"},
                                                         {"01.asf", "duet_asf.py"},
                                                         {"a.npz", "duet_motion.research"}};
  for (const auto& [file, converter] : converters) {
    EXPECT_THAT(std::string(ReadLeader(file).status().message()), HasSubstr(converter)) << file;
    EXPECT_THAT(Refusal(WritePair(file, pair_, kSkeleton)), HasSubstr(converter));
  }
}

TEST_F(MotionFile, RejectsAnInconsistentPair) {
  motion::ClipPair shorter = pair_, broken = pair_, far_away = pair_, renamed = pair_;
  shorter.follower.poses.Resize(1);
  broken.follower.at(3, 1).x = std::nanf("");
  far_away.leader.at(0, 0).x = 3e38f;
  renamed.leader.joint_names.pop_back();
  EXPECT_THAT(Refusal(WritePair(folder_ / "a.csv", shorter, kSkeleton)),
              HasSubstr("expected the same joints, frames and rate"));
  EXPECT_THAT(Refusal(WritePair(folder_ / "a.csv", broken, kSkeleton)),
              HasSubstr("follower: frame 3 neck"));
  EXPECT_THAT(Refusal(WritePair(folder_ / "a.bvh", far_away, kSkeleton)),
              HasSubstr("leader: frame 0 head: expected a finite position within +-1e+07 m"));
  EXPECT_THAT(WritePair(folder_ / "a.csv", renamed, kSkeleton), Not(IsOk()));
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(MotionFile, NamesAFileThatCannotBeReadOrWritten) {
  EXPECT_EQ(ReadLeader(folder_ / "none.csv").status().code(), absl::StatusCode::kNotFound);
  fs::create_directories(folder_ / "folder.csv");
  EXPECT_THAT(std::string(ReadLeader(folder_ / "folder.csv").status().message()),
              HasSubstr("got a folder"));
  EXPECT_THAT(Refusal(WritePair(folder_ / "folder.csv", pair_, kSkeleton)),
              HasSubstr("expected a file, got a folder"));
  EXPECT_THAT(Refusal(WritePair(folder_ / "no" / "a.csv", pair_, kSkeleton)),
              HasSubstr("cannot be written"));
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

// A comma for the decimal point, in C++ streams and, where such a locale is installed, in C, must
// not change what numbers mean.
TEST_F(MotionFile, DoesNotDependOnTheLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale(), new DecimalComma));
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  }
  for (const char* name : {"a.csv", "a.json", "a.bvh"}) {
    const absl::StatusOr<std::vector<fs::path>> written =
        WritePair(folder_ / name, pair_, kSkeleton);
    EXPECT_TRUE(written.ok()) << written.status();
    const absl::StatusOr<motion::Clip> clip = ReadLeader(written->front());
    EXPECT_TRUE(clip.ok()) << clip.status();
    EXPECT_LT(LargestDistance(*clip, pair_.leader), 0.001f);
  }
  std::locale::global(before);
  std::setlocale(LC_ALL, "C");
}

}  // namespace
}  // namespace duet::formats
