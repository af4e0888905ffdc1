#include "server/registry/checkpoint_fingerprint.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"

namespace duet::server::registry {
namespace {

using test::ReadTestFile;
using test::TemporaryFolder;
using test::WriteTestFile;

namespace fs = std::filesystem;

class CheckpointFingerprintTest : public ::testing::Test {
 protected:
  void SetUp() override {
    WriteTestFile(manifest_, "{}");
    WriteTestFile(weights_, "weights");
  }
  static CheckpointFingerprint FingerprintOf(
      const fs::path& folder,
      CheckpointFingerprint::Time now = CheckpointFingerprint::Clock::now()) {
    CheckpointFingerprint fingerprint = CheckpointFingerprint::Of(folder, now);
    fingerprint.ReadContent(folder);
    return fingerprint;
  }
  CheckpointFingerprint Fingerprint() const { return FingerprintOf(folder_.path()); }
  // Replaces a file's content and gives it the times that it had, as a disk that rots does.
  void RestoringTimes(const fs::path& path, const std::string& content) {
    struct stat before = {};
    ASSERT_EQ(stat(path.c_str(), &before), 0);
    WriteTestFile(path, content);
    const timespec times[] = {before.st_atim, before.st_mtim};
    ASSERT_EQ(utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
  }

  TemporaryFolder folder_;
  const fs::path manifest_ = folder_ / "manifest.json";
  const fs::path weights_ = folder_ / "weights.safetensors";
};

TEST_F(CheckpointFingerprintTest, MatchesWhatHasNotChanged) {
  CheckpointFingerprint fingerprint = Fingerprint();
  EXPECT_TRUE(fingerprint.Matches(folder_.path()));
  EXPECT_TRUE(fingerprint.IsUntouched(folder_.path()));
}

TEST_F(CheckpointFingerprintTest, WeightsOfTheSameSizeAndTimeAreAChange) {
  CheckpointFingerprint fingerprint = Fingerprint();
  RestoringTimes(weights_, "Weights");
  EXPECT_FALSE(fingerprint.Matches(folder_.path()));
  WriteTestFile(weights_, "weights");
  EXPECT_TRUE(fingerprint.Matches(folder_.path())) << "as they were";
}

// The bytes that this process has read from files.
long BytesRead() {
  std::ifstream io("/proc/self/io");
  std::string name;
  long bytes = 0;
  io >> name >> bytes;
  EXPECT_EQ(name, "rchar:");
  return bytes;
}

TEST_F(CheckpointFingerprintTest, UntouchedFileIsNotReadAgain) {
  constexpr long kBytes = 1 << 22;
  WriteTestFile(weights_, std::string(kBytes, 'w'));
  const auto later = CheckpointFingerprint::Clock::now() + std::chrono::hours(1);
  CheckpointFingerprint settled = FingerprintOf(folder_.path(), later);
  CheckpointFingerprint fresh = Fingerprint();
  const long before = BytesRead();
  EXPECT_TRUE(settled.Matches(folder_.path(), later));
  const long between = BytesRead();
  EXPECT_TRUE(fresh.Matches(folder_.path(), later));
  const long after = BytesRead();
  EXPECT_LT(between - before, kBytes);
  EXPECT_GE(after - between, kBytes) << "its times prove nothing yet";
  EXPECT_TRUE(fresh.Matches(folder_.path(), later));
  EXPECT_LT(BytesRead() - after, kBytes) << "now they do";
}

TEST_F(CheckpointFingerprintTest, ContentThatWasNotReadMatchesNothing) {
  EXPECT_FALSE(CheckpointFingerprint::Of(folder_.path()).Matches(folder_.path()));
}

TEST_F(CheckpointFingerprintTest, FilesOfAnotherSizeAreNotRead) {
  constexpr long kBytes = 1 << 22;
  WriteTestFile(folder_ / "large", std::string(kBytes, 'w'));
  CheckpointFingerprint fingerprint = Fingerprint();
  fs::resize_file(weights_, std::uintmax_t{64} << 30);  // sparse
  const long before = BytesRead();
  EXPECT_FALSE(fingerprint.Matches(folder_.path()));
  EXPECT_LT(BytesRead() - before, kBytes) << "nor any other file";
}

TEST_F(CheckpointFingerprintTest, ReadingCanBeStopped) {
  CheckpointFingerprint whole = Fingerprint();
  int blocks = 0;
  const auto stop = [&blocks] { return ++blocks > 3; };
  fs::resize_file(weights_, std::uintmax_t{64} << 30);  // sparse
  CheckpointFingerprint fingerprint = CheckpointFingerprint::Of(folder_.path());
  fingerprint.ReadContent(folder_.path(), stop);
  fs::resize_file(weights_, 7);
  EXPECT_FALSE(fingerprint.Matches(folder_.path()));
  WriteTestFile(weights_, "weights");
  blocks = 0;
  EXPECT_FALSE(
      whole.Matches(folder_.path(), CheckpointFingerprint::Clock::now(), [] { return true; }));
  EXPECT_TRUE(whole.Matches(folder_.path())) << "nothing was forgotten";
}

TEST_F(CheckpointFingerprintTest, ACopyOfTheSameContentIsNoChange) {
  CheckpointFingerprint fingerprint = Fingerprint();
  fs::copy(weights_, folder_ / "next");
  fs::rename(folder_ / "next", weights_);
  EXPECT_FALSE(fingerprint.IsUntouched(folder_.path()));
  EXPECT_TRUE(fingerprint.Matches(folder_.path()));
  EXPECT_TRUE(fingerprint.IsUntouched(folder_.path())) << "the copy's times are remembered";
}

TEST_F(CheckpointFingerprintTest, AddedOrRemovedFileIsAChange) {
  CheckpointFingerprint fingerprint = Fingerprint();
  WriteTestFile(folder_ / "more.safetensors", "");
  EXPECT_FALSE(fingerprint.Matches(folder_.path()));
  fs::remove(folder_ / "more.safetensors");
  EXPECT_TRUE(fingerprint.Matches(folder_.path()));
  fs::remove(weights_);
  EXPECT_FALSE(fingerprint.Matches(folder_.path()));
}

TEST_F(CheckpointFingerprintTest, DocumentsAndHiddenFilesDoNotCount) {
  CheckpointFingerprint fingerprint = Fingerprint();
  WriteTestFile(folder_ / "MODEL_CARD.md", "better");
  WriteTestFile(folder_ / ".nfs1", "");
  EXPECT_TRUE(fingerprint.IsUntouched(folder_.path()));
}

TEST_F(CheckpointFingerprintTest, OfNothingMatchesNothing) {
  CheckpointFingerprint nothing;
  EXPECT_FALSE(nothing.Matches(folder_.path()));
  TemporaryFolder empty;
  nothing = FingerprintOf(empty.path());
  EXPECT_FALSE(nothing.Matches(empty.path()));
  EXPECT_FALSE(nothing.Matches("/nonexistent"));
}

// Opening it for reading would wait for a writer.
TEST_F(CheckpointFingerprintTest, NamedPipeIsNotRead) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  CheckpointFingerprint fingerprint = Fingerprint();
  EXPECT_TRUE(fingerprint.Matches(folder_.path()));
}

TEST_F(CheckpointFingerprintTest, FollowsAVolumesLinkToTheNextGeneration) {
  for (const char* generation : {"..1", "..2", "..3"}) {
    fs::create_directories(folder_ / "volume" / generation);
    WriteTestFile(folder_ / "volume" / generation / "manifest.json",
                  generation == std::string("..3") ? "other" : "same");
  }
  const fs::path volume = folder_ / "volume";
  const auto publish = [&volume](const char* generation) {
    fs::create_directory_symlink(generation, volume / "..next");
    fs::rename(volume / "..next", volume / "..data");
  };
  publish("..1");
  CheckpointFingerprint fingerprint = FingerprintOf(volume);
  publish("..2");
  EXPECT_TRUE(fingerprint.Matches(volume));
  publish("..3");
  EXPECT_FALSE(fingerprint.Matches(volume));
}

}  // namespace
}  // namespace duet::server::registry
