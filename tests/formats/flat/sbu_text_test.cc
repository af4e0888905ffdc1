#include <cstdlib>
#include <filesystem>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/flat/flat_files.h"
#include "tests/support/matchers.h"

namespace duet::formats::flat {
namespace {

// Two joints in metres: what a person with their own data writes.
SbuOptions TwoJoints() {
  SbuOptions options;
  options.joint_names = {"torso", "head"};
  options.frame_rate_hz = 25;
  options.coordinates = {motion::LengthUnit::kMetres, motion::UpAxis::kYUp};
  return options;
}

constexpr char kTwoFrames[] =
    "7,0,1,0,0,1.5,0,1,1,0,1,1.5,0\n"
    "8,0,1,0.1,0,1.5,0.1,1,1,0,1,1.5,-2e-1\n";

std::string ParseError(const std::string& text) {
  const absl::StatusOr<SbuRecording> recording = ParseSbu(text, "a.txt", TwoJoints());
  EXPECT_EQ(recording.status().code(), absl::StatusCode::kInvalidArgument) << recording.status();
  return std::string(recording.status().message());
}

TEST(SbuText, ReadsBothPeople) {
  const absl::StatusOr<SbuRecording> recording = ParseSbu(kTwoFrames, "a.txt", TwoJoints());
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_EQ(recording->left.frame_count(), 2);
  EXPECT_EQ(recording->right.frame_count(), 2);
  EXPECT_EQ(recording->left.frame_rate_hz, 25);
  EXPECT_EQ(recording->left.at(1, 0), (motion::Vec3{0, 1, 0.1f}));
  EXPECT_EQ(recording->right.at(1, 1), (motion::Vec3{1, 1.5f, -0.2f}));
}

TEST(SbuText, DefaultsToSbuJointsUnitAndRate) {
  std::string line = "180";
  for (int value = 0; value < 90; ++value) absl::StrAppend(&line, ",", value < 45 ? "0.5" : "0.25");
  const absl::StatusOr<SbuRecording> recording = ParseSbu(line, "a.txt");
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_EQ(recording->left.joint_names, motion::SbuSkeleton().joint_names);
  EXPECT_EQ(recording->left.frame_rate_hz, 15);
  EXPECT_NEAR(recording->left.at(0, 0).x, 0, 1e-6);
  EXPECT_NEAR(recording->left.at(0, 0).y, 0, 1e-6);
  EXPECT_NEAR(recording->left.at(0, 0).z, 0.64, 1e-6);
  EXPECT_NEAR(recording->right.at(0, 14).x, 0.64, 1e-6);
  EXPECT_NEAR(recording->right.at(0, 14).y, 0.48, 1e-6);
}

TEST(SbuText, NamesThePlaceOfABadValue) {
  const std::string text = absl::StrReplaceAll(kTwoFrames, {{"-2e-1", "abc"}});
  const std::string error = ParseError(text);
  EXPECT_THAT(error, HasSubstr("a.txt:2:33: right person's head z"));
  EXPECT_THAT(error, HasSubstr("expected a finite number, got \"abc\""));
}

TEST(SbuText, RejectsNumbersThatAreNotPositions) {
  for (const char* bad :
       {"nan", "inf", "1e400", "1e30", "0x10", "1.5.2", "1,5", "", "1 2", "--1"}) {
    const std::string text = absl::StrReplaceAll(kTwoFrames, {{"-2e-1", bad}});
    EXPECT_THAT(ParseError(text), HasSubstr("a.txt:2")) << bad;
  }
}

TEST(SbuText, RejectsAWrongNumberOfValues) {
  EXPECT_THAT(ParseError("1,0,1,0\n"), HasSubstr("a.txt:1: expected 13 comma-separated values"));
}

TEST(SbuText, RejectsFrameNumbersThatSkip) {
  const std::string text = absl::StrCat(kTwoFrames, "10,0,1,0,0,1.5,0,1,1,0,1,1.5,0\n");
  EXPECT_THAT(ParseError(text), HasSubstr("a.txt:3:1: frame number: expected 9 after 8, got 10"));
  EXPECT_THAT(ParseError(absl::StrReplaceAll(kTwoFrames, {{"8,", "7,"}})),
              HasSubstr("expected a larger one after 7, got 7"));
  EXPECT_THAT(ParseError(absl::StrReplaceAll(kTwoFrames, {{"8,", "99999999999999999999,"}})),
              HasSubstr("expected a whole number"));
}

TEST(SbuText, WritesWhatItReads) {
  const absl::StatusOr<SbuRecording> recording = ParseSbu(kTwoFrames, "a.txt", TwoJoints());
  ASSERT_TRUE(recording.ok());
  const absl::StatusOr<std::string> text = FormatSbu(*recording, TwoJoints());
  ASSERT_TRUE(text.ok());
  const absl::StatusOr<SbuRecording> again = ParseSbu(*text, "b.txt", TwoJoints());
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(again->left.poses, recording->left.poses);
  EXPECT_EQ(again->right.poses, recording->right.poses);
}

// Every real capture, where somebody has them.
TEST(SbuText, ReadsEveryCaptureOfTheDataSet) {
  const char* folder = std::getenv("DUET_DATA_DIR");
  const char* source = std::getenv("DUET_SOURCE_DIR");
  const std::filesystem::path data =
      folder != nullptr
          ? std::filesystem::path(folder)
          : std::filesystem::path(source != nullptr ? source : ".") / "../shared/data";
  if (!std::filesystem::is_directory(data / "sbu")) {
    GTEST_SKIP() << "no captures at " << data << "; set DUET_DATA_DIR to read them";
  }
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    const bool sbu = entry.path().filename() == "skeleton_pos.txt";
    const bool k3hi = entry.path().string().find("k3hi") != std::string::npos &&
                      entry.path().extension() == ".txt";
    if (!sbu && !k3hi) continue;
    const absl::StatusOr<SbuRecording> recording = ReadSbu(entry.path());
    ASSERT_TRUE(recording.ok()) << recording.status();
    EXPECT_GE(recording->left.frame_count(), 10);
    ++files;
  }
  EXPECT_GT(files, 200);
}

}  // namespace
}  // namespace duet::formats::flat
