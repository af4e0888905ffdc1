#include "server/registry/model_repository.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
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

TEST(ListCheckpointsTest, FindsNameAndVersionFolders) {
  TemporaryFolder folder;
  MakeCheckpoint(folder, "sbu/1");
  MakeCheckpoint(folder, "sbu/12");
  MakeCheckpoint(folder, "k3hi/3");
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

TEST(ListCheckpointsTest, IgnoresFilesAndHiddenFolders) {
  TemporaryFolder folder;
  WriteTestFile(folder / "README.md", "");
  MakeCheckpoint(folder, ".git/1");
  MakeCheckpoint(folder, "sbu/.1.partial");
  MakeCheckpoint(folder, "sbu/1");
  const absl::StatusOr<RepositoryListing> listing = ListCheckpoints(folder.path());
  ASSERT_THAT(listing, IsOk());
  EXPECT_THAT(listing->checkpoints, ElementsAre(folder / "sbu/1"));
  EXPECT_THAT(listing->skipped, IsEmpty());
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
}

TEST(ListCheckpointsTest, VersionFolderMayBeAMountedVolume) {
  TemporaryFolder folder;
  MakeCheckpoint(folder, "sbu/1/..2026_01");
  fs::create_directory_symlink("..2026_01", folder / "sbu/1/..data");
  fs::create_symlink("..data/manifest.json", folder / "sbu/1/manifest.json");
  const absl::StatusOr<RepositoryListing> listing = ListCheckpoints(folder.path());
  EXPECT_THAT(listing->checkpoints, ElementsAre(folder / "sbu/1"));
  EXPECT_THAT(listing->skipped, IsEmpty());
  EXPECT_EQ(ResolveCheckpoint(folder / "sbu/1"), fs::canonical(folder / "sbu/1/..2026_01"));
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

}  // namespace
}  // namespace duet::server::registry
