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

TEST_F(MotionFile, FilesAndFoldersAreCheckedBeforeTheyAreUsed) {
  EXPECT_THAT(CheckReadable(folder_ / "absent.bvh", std::nullopt),
              StatusIs(absl::StatusCode::kNotFound, EndsWith("absent.bvh: no such file")));
  EXPECT_THAT(CheckReadable(folder_, std::nullopt),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       EndsWith(": expected a motion file, got a folder")));
  test::WriteTestFile(folder_ / "a.obj", "");
  EXPECT_THAT(CheckReadable(folder_ / "a.obj", std::nullopt),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("extension: expected")));
  EXPECT_THAT(CheckReadable(folder_ / "a.obj", Format::kCsv), IsOk());
  EXPECT_THAT(CheckFolderOf("new.csv"), IsOk());
  EXPECT_THAT(CheckFolderOf(folder_ / "no/new.csv"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("there is no folder ")));
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
  const auto remarks = [this](const motion::ClipPair& pair, const motion::Clip& wanted,
                              const std::optional<motion::Coordinates>& coordinates) {
    EXPECT_THAT(WritePair(folder_ / "a.csv", pair, kSkeleton), IsOk());
    retargeting::ReadingReport report;
    ReadOptions options;
    options.report = &report;
    options.coordinates = coordinates;
    const absl::StatusOr<motion::Clip> clip = ReadLeader(folder_ / "a.csv", options);
    EXPECT_THAT(clip, IsOk());
    EXPECT_LT(LargestDistance(*clip, wanted), 1e-5f);
    return report.remarks;
  };
  EXPECT_THAT(remarks(z_up, z_up.leader, std::nullopt),
              Contains(HasSubstr("not below the root along y; z-up would fit")));
  EXPECT_THAT(remarks(z_up, pair_.leader,
                      motion::Coordinates{motion::LengthUnit::kMetres, motion::UpAxis::kZUp}),
              ::testing::IsEmpty());
  EXPECT_THAT(remarks(pair_, pair_.leader, std::nullopt), ::testing::IsEmpty());
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

TEST_F(MotionFile, AFollowerIsWrittenOnARigInTheRigsOwnFormat) {
  ASSERT_THAT(WritePeople(folder_ / "rig.bvh", Format::kBvh, {pair_.leader}, kSkeleton), IsOk());
  const absl::StatusOr<std::string> text =
      FormatOntoRig(pair_.follower, {folder_ / "rig.bvh", {}}, Format::kBvh);
  ASSERT_THAT(text, IsOk());
  ReadOptions options;
  options.format = Format::kBvh;
  const absl::StatusOr<motion::Clip> read = ParseLeader(*text, "written", options);
  ASSERT_THAT(read, IsOk());
  EXPECT_LT(Distance(read->at(9, 11), pair_.follower.at(9, 11)), 0.01f) << "a foot";
  const auto refused = [&](const char* rig, Format format) {
    return std::string(
        FormatOntoRig(pair_.follower, {folder_ / rig, {}}, format).status().message());
  };
  EXPECT_THAT(refused("rig.csv", Format::kGlb), HasSubstr("rig: expected a .bvh, .glb or .gltf"));
  EXPECT_THAT(refused("rig.fbx", Format::kGlb), HasSubstr("convert it with duet_fbx.py"));
  EXPECT_THAT(refused("rig.bvh", Format::kGlb), HasSubstr("it is written in its own format"));
  EXPECT_THAT(refused("none.glb", Format::kGlb), HasSubstr("none.glb: no such file"));
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
