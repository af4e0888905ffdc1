#include "model/formats/motion_file.h"

#include <algorithm>
#include <clocale>
#include <cmath>
#include <filesystem>
#include <locale>
#include <map>
#include <random>
#include <string>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/file.h"
#include "model/formats/flat/sbu_text.h"
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

class MotionFile : public ::testing::Test {
 protected:
  const motion::ClipPair pair_{MakePerson(), MakePerson({60, 3, 0, {0, 1.1f, 1.2f}, 30})};
  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(MotionFile, OnePersonIsWrittenInEveryFormat) {
  for (const char* name : {"one.csv", "one.json", "one.npy", "one.bvh"}) {
    const fs::path file = folder_ / name;
    const auto written = WritePeople(file, *FormatOf(file), {pair_.leader}, motion::SbuSkeleton());
    ASSERT_TRUE(written.ok()) << written.status();
    EXPECT_THAT(*written, ElementsAre(file));
    retargeting::ReadingReport report;
    ReadOptions options;
    options.frame_rate_hz = 30;
    options.side = Side::kRight;  // one person serves either side
    options.report = &report;
    const auto read = ReadLeader(file, options);
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_LT(LargestDistance(*read, pair_.leader), 1e-4f) << name;
    EXPECT_EQ(report.people, 1) << name;
  }
}

TEST_F(MotionFile, ParsesAMotionThatIsNotAFile) {
  const auto csv =
      FormatPeople(Format::kCsv, {pair_.leader, pair_.follower}, motion::SbuSkeleton());
  ASSERT_TRUE(csv.ok());
  ReadOptions options;
  options.side = Side::kRight;
  EXPECT_FALSE(ParseLeader(*csv, "a pipe", options).ok());
  options.format = Format::kCsv;
  const auto follower = ParseLeader(*csv, "a pipe", options);
  ASSERT_TRUE(follower.ok()) << follower.status();
  EXPECT_EQ(LargestDistance(*follower, pair_.follower), 0);
  options.format = Format::kBvh;
  EXPECT_THAT(std::string(ParseLeader(*csv, "a pipe", options).status().message()),
              HasSubstr("a pipe:1: "));
}

TEST_F(MotionFile, RejectsPeopleThatAFormatCannotHold) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const auto refused = [&](Format format, const std::vector<motion::Clip>& people) {
    return std::string(FormatPeople(format, people, skeleton).status().message());
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
  auto text = FormatPeople(Format::kCsv, {pair_.leader}, motion::SbuSkeleton());
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

std::string Damaged(std::string bytes, std::mt19937* random) {
  const char interesting[] = "0-9.e{}[](),:#\n \"\\\xff";
  for (int change = 0; change < 3; ++change) {
    const std::size_t at = (*random)() % bytes.size();
    const std::size_t length = std::min<std::size_t>((*random)() % 40, bytes.size() - at - 1);
    switch ((*random)() % 4) {
      case 0:
        bytes[at] = interesting[(*random)() % (sizeof(interesting) - 1)];
        break;
      case 1:
        bytes[at] = static_cast<char>((*random)());
        break;
      case 2:
        bytes.erase(at, length);
        break;
      default:
        bytes.insert(at, bytes.substr(at, length));
    }
  }
  return bytes;
}

TEST_F(MotionFile, ReadsBackWhatItWrites) {
  for (const char* name : {"a.csv", "a.json", "a.npy", "a.CSV"}) {
    const fs::path path = folder_ / name;
    const absl::StatusOr<std::vector<fs::path>> written =
        WritePair(path, pair_, motion::SbuSkeleton());
    ASSERT_TRUE(written.ok()) << written.status();
    EXPECT_THAT(*written, ElementsAre(path));
    ReadOptions options;
    if (path.extension() == ".npy") options.frame_rate_hz = 30;
    for (Side side : {Side::kLeft, Side::kRight}) {
      options.side = side;
      const absl::StatusOr<motion::Clip> clip = ReadLeader(path, options);
      ASSERT_TRUE(clip.ok()) << clip.status();
      EXPECT_EQ(clip->frame_rate_hz, 30);
      EXPECT_EQ(clip->poses, (side == Side::kLeft ? pair_.leader : pair_.follower).poses);
    }
  }
}

TEST_F(MotionFile, WritesBothPeopleAsGltfOrGlbByExtension) {
  for (const char* name : {"a.glb", "a.gltf"}) {
    const fs::path path = folder_ / name;
    ASSERT_TRUE(WritePair(path, pair_, motion::SbuSkeleton()).ok());
    const bool binary = base::ReadFile(path, 1 << 24, "a motion")->substr(0, 4) == "glTF";
    EXPECT_EQ(binary, path.extension() == ".glb");
    ReadOptions options;
    for (Side side : {Side::kLeft, Side::kRight}) {
      options.side = side;
      const absl::StatusOr<motion::Clip> clip = ReadLeader(path, options);
      ASSERT_TRUE(clip.ok()) << clip.status();
      EXPECT_LT(LargestDistance(*clip, side == Side::kLeft ? pair_.leader : pair_.follower), 2e-5f);
    }
  }
}

TEST_F(MotionFile, MetresPerUnitScaleEveryFormatOfPositions) {
  for (const char* name : {"a.csv", "a.json", "a.npy", "a.txt"}) {
    ASSERT_TRUE(WritePair(folder_ / name, pair_, motion::SbuSkeleton()).ok());
    ReadOptions options;
    options.frame_rate_hz = 30;
    options.coordinates = motion::Coordinates{};
    const absl::StatusOr<motion::Clip> metres = ReadLeader(folder_ / name, options);
    ASSERT_TRUE(metres.ok()) << metres.status();
    options.coordinates.reset();
    options.metres_per_unit = 0.5;
    const absl::StatusOr<motion::Clip> half = ReadLeader(folder_ / name, options);
    ASSERT_TRUE(half.ok()) << half.status();
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
  const auto text = FormatPeople(Format::kBvh, {pair_.leader}, motion::SbuSkeleton(), metres);
  ASSERT_TRUE(text.ok()) << text.status();
  ReadOptions options;
  options.format = Format::kBvh;
  options.metres_per_unit = 1;
  const absl::StatusOr<motion::Clip> clip = ParseLeader(*text, "written", options);
  ASSERT_TRUE(clip.ok()) << clip.status();
  EXPECT_LT(LargestDistance(*clip, pair_.leader), 1e-3f);
}

TEST_F(MotionFile, WritesABvhForEachPersonInOneWorld) {
  const absl::StatusOr<std::vector<fs::path>> written =
      WritePair(folder_ / "a.b.bvh", pair_, motion::SbuSkeleton());
  ASSERT_TRUE(written.ok()) << written.status();
  EXPECT_THAT(*written, ElementsAre(folder_ / "a.b.leader.bvh", folder_ / "a.b.follower.bvh"));
  const absl::StatusOr<motion::Clip> leader = ReadLeader((*written)[0]);
  const absl::StatusOr<motion::Clip> follower = ReadLeader((*written)[1]);
  ASSERT_TRUE(leader.ok()) << leader.status();
  ASSERT_TRUE(follower.ok()) << follower.status();
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
      ASSERT_TRUE(clip.ok()) << clip.status();
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

TEST_F(MotionFile, ReadsEitherPersonOfSbuText) {
  const fs::path path = folder_ / "skeleton_pos.txt";
  ASSERT_TRUE(base::WriteFile(path, *flat::FormatSbu({pair_.leader, pair_.follower})).ok());
  ReadOptions options;
  options.side = Side::kRight;
  const absl::StatusOr<motion::Clip> right = ReadLeader(path, options);
  ASSERT_TRUE(right.ok()) << right.status();
  EXPECT_EQ(right->frame_rate_hz, 15);
  EXPECT_LT(LargestDistance(*right, pair_.follower), 1e-5f);
  options.frame_rate_hz = 30;
  EXPECT_EQ(ReadLeader(path, options)->frame_rate_hz, 30);
}

TEST_F(MotionFile, UsesTheCallersCoordinates) {
  const fs::path path = folder_ / "a.csv";
  std::string header = "frame", row = "0";
  for (const std::string& joint : motion::SbuSkeleton().joint_names) {
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
  ASSERT_TRUE(clip.ok()) << clip.status();
  EXPECT_LT(Distance(clip->at(0, 7), {1, 3, -2}), 1e-6f);
}

TEST_F(MotionFile, WarnsIfTheUpAxisIsProbablyAnother) {
  motion::ClipPair z_up = pair_;
  for (motion::Clip* clip : {&z_up.leader, &z_up.follower}) {
    for (motion::Vec3& p : clip->poses.all()) p = {p.x, -p.z, p.y};
  }
  const fs::path path = folder_ / "a.csv";
  ASSERT_TRUE(WritePair(path, z_up, motion::SbuSkeleton()).ok());
  std::vector<std::string> notes;
  ReadOptions options;
  options.notes = &notes;
  ASSERT_TRUE(ReadLeader(path, options).ok());
  EXPECT_THAT(notes, Contains(HasSubstr("not below the root along y; z-up would fit")));
  notes.clear();
  options.coordinates = {motion::LengthUnit::kMetres, motion::UpAxis::kZUp};
  const absl::StatusOr<motion::Clip> clip = ReadLeader(path, options);
  ASSERT_TRUE(clip.ok()) << clip.status();
  EXPECT_LT(LargestDistance(*clip, pair_.leader), 1e-5f);
  EXPECT_THAT(notes, ::testing::IsEmpty());
  options.coordinates.reset();
  ASSERT_TRUE(WritePair(path, pair_, motion::SbuSkeleton()).ok());
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
  ASSERT_TRUE(clip.ok()) << clip.status();
  EXPECT_THAT(notes, Contains(HasSubstr("neck: LowerNeck (")));
}

TEST_F(MotionFile, ReadsTheFirstFrameAsAFollowersStart) {
  const absl::StatusOr<std::vector<fs::path>> written =
      WritePair(folder_ / "a.npy", pair_, motion::SbuSkeleton());
  ASSERT_TRUE(written.ok());
  ReadOptions options;
  options.side = Side::kRight;
  const absl::StatusOr<std::vector<motion::Vec3>> start = ReadFollowerStart((*written)[0], options);
  ASSERT_TRUE(start.ok()) << start.status();
  ASSERT_EQ(start->size(), 15u);
  EXPECT_EQ((*start)[14], pair_.follower.at(0, 14));
}

TEST_F(MotionFile, ReportsTheKnownExtensions) {
  EXPECT_THAT(std::string(ReadLeader("a.obj").status().message()),
              HasSubstr("extension: expected .txt (SBU text), .bvh"));
  EXPECT_THAT(std::string(WritePair("a.obj", pair_, motion::SbuSkeleton()).status().message()),
              HasSubstr("extension: expected .glb, .gltf, .bvh, .csv"));
  for (const char* known : {"a.json", "a.txt", "a.BVH"}) EXPECT_TRUE(IsReadable(known)) << known;
  for (const char* other : {"a", "a.obj", "a.sbu"}) EXPECT_FALSE(IsReadable(other)) << other;
}

TEST_F(MotionFile, NamesTheProgramThatConvertsAnotherFormat) {
  const std::map<std::string, std::string> converters = {{"a.fbx", "convert it with duet-fbx"},
                                                         {"a.FBX", "convert it with duet-fbx"},
                                                         {"01_02.amc", "duet_asf.py"},
                                                         {"01.asf", "duet_asf.py"},
                                                         {"a.usda", "duet-usd"},
                                                         {"a.npz", "duet_motion.research"}};
  for (const auto& [file, converter] : converters) {
    EXPECT_THAT(std::string(ReadLeader(file).status().message()), HasSubstr(converter)) << file;
    EXPECT_THAT(std::string(WritePair(file, pair_, motion::SbuSkeleton()).status().message()),
                HasSubstr(converter));
  }
}

TEST_F(MotionFile, RejectsAnInconsistentPair) {
  motion::ClipPair shorter = pair_;
  shorter.follower.poses.Resize(1);
  EXPECT_THAT(
      std::string(WritePair(folder_ / "a.csv", shorter, motion::SbuSkeleton()).status().message()),
      HasSubstr("expected the same joints, frames and rate"));
  motion::ClipPair broken = pair_;
  broken.follower.at(3, 1).x = std::nanf("");
  EXPECT_THAT(
      std::string(WritePair(folder_ / "a.csv", broken, motion::SbuSkeleton()).status().message()),
      HasSubstr("follower: frame 3 neck"));
  motion::ClipPair far_away = pair_;
  far_away.leader.at(0, 0).x = 3e38f;
  EXPECT_THAT(
      std::string(WritePair(folder_ / "a.bvh", far_away, motion::SbuSkeleton()).status().message()),
      HasSubstr("leader: frame 0 head: expected a finite position within +-1e+07 m"));
  motion::ClipPair renamed = pair_;
  renamed.leader.joint_names.pop_back();
  EXPECT_FALSE(WritePair(folder_ / "a.csv", renamed, motion::SbuSkeleton()).ok());
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(MotionFile, NamesAFileThatCannotBeReadOrWritten) {
  EXPECT_EQ(ReadLeader(folder_ / "none.csv").status().code(), absl::StatusCode::kNotFound);
  fs::create_directories(folder_ / "folder.csv");
  EXPECT_THAT(std::string(ReadLeader(folder_ / "folder.csv").status().message()),
              HasSubstr("got a folder"));
  EXPECT_THAT(
      std::string(
          WritePair(folder_ / "folder.csv", pair_, motion::SbuSkeleton()).status().message()),
      HasSubstr("expected a file, got a folder"));
  EXPECT_THAT(
      std::string(
          WritePair(folder_ / "no" / "a.csv", pair_, motion::SbuSkeleton()).status().message()),
      HasSubstr("cannot be written"));
}

// Bytes changed, dropped and doubled at random: an error or a motion, never a crash.
TEST_F(MotionFile, SurvivesDamagedFiles) {
  const motion::ClipPair small{MakePerson({2}), MakePerson({2})};
  ASSERT_TRUE(WritePair(folder_ / "a.csv", small, motion::SbuSkeleton()).ok());
  ASSERT_TRUE(WritePair(folder_ / "a.json", small, motion::SbuSkeleton()).ok());
  ASSERT_TRUE(WritePair(folder_ / "a.npy", small, motion::SbuSkeleton()).ok());
  ASSERT_TRUE(WritePair(folder_ / "a.bvh", small, motion::SbuSkeleton()).ok());
  ASSERT_TRUE(
      base::WriteFile(folder_ / "a.txt", *flat::FormatSbu({small.leader, small.follower})).ok());
  ReadOptions options;
  options.frame_rate_hz = 30;
  std::mt19937 random(7);
  int refused = 0;
  for (const char* name : {"a.csv", "a.json", "a.npy", "a.leader.bvh", "a.txt"}) {
    const absl::StatusOr<std::string> whole = base::ReadFile(folder_ / name, 1 << 20, "a motion");
    ASSERT_TRUE(whole.ok()) << whole.status();
    for (int round = 0; round < 200; ++round) {
      const fs::path path = folder_ / (std::string("damaged_") + name);
      ASSERT_TRUE(base::WriteFile(path, Damaged(*whole, &random)).ok());
      const absl::StatusOr<motion::Clip> clip = ReadLeader(path, options);
      refused += clip.ok() ? 0 : 1;
      if (!clip.ok()) continue;
      for (const motion::Vec3& position : clip->poses.all())
        EXPECT_TRUE(IsFinite(position)) << name;
    }
  }
  EXPECT_GT(refused, 300);
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
        WritePair(folder_ / name, pair_, motion::SbuSkeleton());
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
