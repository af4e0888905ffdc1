#include "server/registry/model_repository.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::server::registry {
namespace {

using test::FakeDescription;
using test::FakeSynthesizer;
using test::TemporaryFolder;
using test::WriteTestFile;

namespace fs = std::filesystem;

void MakeCheckpoint(const TemporaryFolder& folder, const std::string& place) {
  fs::create_directories(folder / place);
  WriteTestFile(folder / (place + "/manifest.json"), "{}");
}

TEST(ListCheckpointsTest, FindsNameAndVersionFoldersAndIgnoresFilesAndHiddenFolders) {
  TemporaryFolder folder;
  for (const char* place : {"sbu/1", "sbu/12", "k3hi/3", ".git/1", "sbu/.1.partial"}) {
    MakeCheckpoint(folder, place);
  }
  WriteTestFile(folder / "README.md", "");
  const absl::StatusOr<RepositoryListing> listing = ListCheckpoints(folder.path());
  ASSERT_THAT(listing, IsOk());
  EXPECT_THAT(listing->checkpoints,
              ElementsAre(folder / "k3hi/3", folder / "sbu/1", folder / "sbu/12"));
  EXPECT_THAT(listing->skipped, IsEmpty());
}

// "folder: reason" of each.
std::vector<std::string> Skipped(const RepositoryListing& listing) {
  std::vector<std::string> skipped;
  for (const SkippedFolder& folder : listing.skipped) {
    skipped.push_back(folder.folder + ": " + folder.reason);
  }
  return skipped;
}

TEST(ListCheckpointsTest, ReportsFoldersWithoutCheckpointsWithTheReason) {
  TemporaryFolder folder;
  for (const char* version : {"0", "01", "v2", "-1", "1.tmp", "99999999999"}) {
    MakeCheckpoint(folder, std::string("sbu/") + version);
  }
  fs::create_directories(folder / "sbu/7");
  fs::create_directories(folder / "k3hi");
  const absl::StatusOr<RepositoryListing> listing = ListCheckpoints(folder.path());
  ASSERT_THAT(listing, IsOk());
  EXPECT_THAT(listing->checkpoints, IsEmpty());
  const auto no_version = [](const std::string& name) {
    return StartsWith("sbu/" + name + ": expected a version of at least 1");
  };
  EXPECT_THAT(Skipped(*listing),
              ElementsAre("k3hi: has no folder of a version, such as 1", no_version("-1"),
                          no_version("0"), no_version("01"), no_version("1.tmp"),
                          "sbu/7: expected a manifest.json, got none", no_version("99999999999"),
                          no_version("v2")));
}

// As Kubernetes mounts a volume: files behind ..data, which a new generation takes over all at
// once.
TEST(ListCheckpointsTest, FollowsTheLinksOfVolumes) {
  TemporaryFolder folder;
  MakeCheckpoint(folder, "..2026_01/sbu/1");
  MakeCheckpoint(folder, "..2026_02/sbu/2");
  fs::create_directory_symlink("..2026_01", folder / "..data");
  fs::create_directory_symlink("..data/sbu", folder / "sbu");
  EXPECT_THAT(ListCheckpoints(folder.path())->checkpoints, ElementsAre(folder / "sbu/1"));
  fs::create_directory_symlink("..2026_02", folder / "..new");
  fs::rename(folder / "..new", folder / "..data");
  EXPECT_THAT(ListCheckpoints(folder.path())->checkpoints, ElementsAre(folder / "sbu/2"));
  EXPECT_EQ(ResolveCheckpoint(folder / "sbu/2"), fs::canonical(folder / "..2026_02/sbu/2"));
  // A version that is a volume itself.
  MakeCheckpoint(folder, "k3hi/1/..2026_01");
  fs::create_directory_symlink("..2026_01", folder / "k3hi/1/..data");
  fs::create_symlink("..data/manifest.json", folder / "k3hi/1/manifest.json");
  EXPECT_THAT(ListCheckpoints(folder.path())->checkpoints,
              ElementsAre(folder / "k3hi/1", folder / "sbu/2"));
  EXPECT_EQ(ResolveCheckpoint(folder / "k3hi/1"), fs::canonical(folder / "k3hi/1/..2026_01"));
}

TEST(ListCheckpointsTest, NamesARepositoryThatIsNotThere) {
  EXPECT_THAT(ListCheckpoints("/nonexistent/models"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("/nonexistent/models")));
}

// Gives root's powers up for a scope, since root opens every folder.
class Unprivileged {
 public:
  Unprivileged() : was_(geteuid()) {
    if (was_ == 0 && seteuid(65534) != 0) ADD_FAILURE() << "cannot give root up";
  }
  ~Unprivileged() {
    if (was_ == 0 && seteuid(was_) != 0) ADD_FAILURE() << "cannot become root again";
  }

 private:
  const uid_t was_;
};

TEST(ListCheckpointsTest, GoesOnPastAFolderThatIsClosed) {
  TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms(0755));
  MakeCheckpoint(folder, "sbu/1");
  fs::create_directories(folder / "lost+found");
  fs::permissions(folder / "lost+found", fs::perms::none);
  absl::StatusOr<RepositoryListing> listing;
  {
    const Unprivileged unprivileged;
    listing = ListCheckpoints(folder.path());
  }
  fs::permissions(folder / "lost+found", fs::perms::owner_all);
  ASSERT_THAT(listing, IsOk());
  EXPECT_THAT(listing->checkpoints, ElementsAre(folder / "sbu/1"));
  EXPECT_THAT(Skipped(*listing),
              ElementsAre(AllOf(StartsWith("lost+found: "), HasSubstr("ermission denied"))));
}

ModelLoader LoaderOf(const std::string& name, int version) {
  return [=](const fs::path&) -> absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> {
    engine::ModelDescription description = FakeDescription();
    description.name = name;
    description.version = version;
    return std::make_shared<FakeSynthesizer>(description);
  };
}

TEST(LoadCheckpointTest, GivesTheModelAndWhereItCameFrom) {
  const LoadReport report = LoadCheckpoint("/models/sbu/3", LoaderOf("sbu", 3));
  ASSERT_THAT(report.model, IsOk());
  EXPECT_EQ(report.source, "sbu/3");
  EXPECT_GE(report.load_seconds, 0);
}

TEST(LoadCheckpointTest, RejectsAManifestThatContradictsItsFolder) {
  EXPECT_THAT(
      LoadCheckpoint("/models/sbu/3", LoaderOf("sbu", 4)).model,
      StatusIs(absl::StatusCode::kInvalidArgument,
               AllOf(HasSubstr("got sbu version 4"), HasSubstr("expected model sbu version 3"))));
  EXPECT_THAT(LoadCheckpoint("/models/sbu/3", LoaderOf("k3hi", 3)).model,
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("got k3hi version 3")));
}

TEST(GoldenLeaderTest, StandsOnTheFloorAndMoves) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const motion::Poses leader = GoldenLeader(skeleton, 30, 15);
  ASSERT_EQ(leader.frame_count(), 30);
  ASSERT_EQ(leader.joint_count(), skeleton.joint_count());
  float lowest = std::numeric_limits<float>::max();
  for (const motion::Vec3& position : leader.all()) {
    lowest = std::min(lowest, position.y);
    EXPECT_LT(position.y, 2);
    EXPECT_LT(std::abs(position.x), 1);
    EXPECT_LT(std::abs(position.z), 1);
  }
  EXPECT_EQ(lowest, 0);
  EXPECT_GT(leader.at(0, skeleton.root).y, 0.5);
  EXPECT_NE(leader.at(0, 0), leader.at(10, 0));
  const float hips =
      Distance(leader.at(0, skeleton.hips->left), leader.at(0, skeleton.hips->right));
  EXPECT_GT(hips, 0.1) << "the leader faces somewhere";
}

TEST(GoldenLeaderTest, NeedsNoLandmarks) {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"a", "b", "c"};
  skeleton.bones = {{0, 1}, {0, 2}};
  const motion::Poses leader = GoldenLeader(skeleton, 2, 30);
  for (const motion::Vec3& position : leader[0]) {
    EXPECT_TRUE(IsFinite(position));
    EXPECT_GE(position.y, 0);
  }
}

TEST(CheckAnswersTest, AsksForNoClassAndForEachAlone) {
  FakeSynthesizer model;
  std::vector<std::vector<float>> labels;
  model.on_batch = [&](absl::Span<const engine::SynthesisWindow* const> windows) {
    for (const engine::SynthesisWindow* window : windows) {
      EXPECT_EQ(window->leader.frame_count(), 46);
      EXPECT_EQ(window->options.clean_up, false);
      labels.emplace_back(window->labels.begin(), window->labels.begin() + 6);
    }
  };
  EXPECT_THAT(CheckAnswers(model), IsOk());
  ASSERT_EQ(labels.size(), 7u);
  EXPECT_EQ(labels[0], std::vector<float>(6, 0));
  for (std::size_t i = 0; i < 6; ++i) {
    std::vector<float> alone(6, 0);
    alone[i] = 1;
    EXPECT_EQ(labels[i + 1], alone);
  }
}

TEST(CheckAnswersTest, RejectsFollowersThatAreFarAwayOrNotFinite) {
  for (const float x : {9.0f, -6e32f, std::numeric_limits<float>::infinity(),
                        std::numeric_limits<float>::quiet_NaN()}) {
    FakeSynthesizer model;
    // Of one class alone, and of its lowest joints.
    model.answer = [x](motion::Vec3 leader, absl::Span<const float> labels) {
      return labels[3] > 0 && leader.y < 0.1f ? motion::Vec3{x, 1, 0} : leader;
    };
    EXPECT_THAT(CheckAnswers(model),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("m in frame 0")))
        << x;
  }
}

}  // namespace
}  // namespace duet::server::registry
