#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/file.h"
#include "model/formats/flat/flat_files.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_motion.h"

namespace duet::formats::flat {
namespace {

std::vector<motion::Clip> MakePair() {
  return {test::MakePerson({12}), test::MakePerson({12, 3, 0, {0, 1, 1.2f}, 30})};
}

std::string ParseError(const std::string& bytes) {
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseNpy(bytes, "a.npy", motion::SbuSkeleton().joint_names);
  EXPECT_EQ(motion.status().code(), absl::StatusCode::kInvalidArgument) << motion.status();
  return std::string(motion.status().message());
}

std::string Replaced(const std::string& from, const std::string& to) {
  return absl::StrReplaceAll(FormatNpy(MakePair()), {{from, to}});
}

TEST(Npy, ReadsBackAPairExactly) {
  const std::vector<motion::Clip> pair = MakePair();
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseNpy(FormatNpy(pair), "a.npy", pair[0].joint_names);
  ASSERT_TRUE(motion.ok()) << motion.status();
  ASSERT_EQ(motion->people.size(), 2u);
  EXPECT_EQ(motion->people[0].poses, pair[0].poses);
  EXPECT_EQ(motion->people[1].poses, pair[1].poses);
  EXPECT_EQ(motion->people[0].frame_rate_hz, 0);
}

// Versions 2 and 3 have four bytes for the length of the header where version 1 has two.
TEST(Npy, ReadsLaterVersionsOfTheFormat) {
  const std::vector<motion::Clip> pair = MakePair();
  for (const char version : {'\x02', '\x03'}) {
    std::string bytes = FormatNpy(pair);
    bytes[6] = version;
    bytes.insert(10, 2, '\0');
    const absl::StatusOr<motion::RecordedMotion> motion =
        ParseNpy(bytes, "a.npy", pair[0].joint_names);
    ASSERT_TRUE(motion.ok()) << motion.status();
    EXPECT_EQ(motion->people[1].poses, pair[1].poses);
  }
  for (const char version : {'\0', '\x04'}) {
    std::string bytes = FormatNpy(pair);
    bytes[6] = version;
    EXPECT_THAT(ParseError(bytes), HasSubstr("format version: expected 1 to 3"));
  }
}

// The format's own reader and writer, where this machine has them.
TEST(Npy, IsReadAndWrittenByNumPy) {
  if (std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "no /usr/bin/python3 with numpy";
  }
  const test::TemporaryFolder folder;
  const std::filesystem::path ours = folder / "duet_ours.npy", theirs = folder / "duet_theirs.npy";
  const std::vector<motion::Clip> pair = MakePair();
  ASSERT_TRUE(base::WriteFile(ours, FormatNpy(pair)).ok());
  const std::string script =
      absl::StrCat("import numpy as n; a = n.load('", ours.string(),
                   "'); assert a.shape == (2, 12, 15, 3) and a.dtype == n.float32; n.save('",
                   theirs.string(), "', a[1].astype(n.float64) * 2)");
  ASSERT_EQ(std::system(absl::StrCat("/usr/bin/python3 -c \"", script, "\"").c_str()), 0);
  const absl::StatusOr<std::string> bytes = base::ReadFile(theirs, 1 << 20, "an array");
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseNpy(*bytes, "b.npy", pair[0].joint_names);
  ASSERT_TRUE(motion.ok()) << motion.status();
  ASSERT_EQ(motion->people.size(), 1u);
  ASSERT_EQ(motion->people[0].frame_count(), 12);
  EXPECT_EQ(motion->people[0].at(11, 14), 2 * pair[1].at(11, 14));
}

TEST(Npy, RejectsOtherArrays) {
  EXPECT_THAT(ParseError(Replaced("<f4", "<i4")), HasSubstr("descr: expected"));
  EXPECT_THAT(ParseError(Replaced("<f4", ">f4")), HasSubstr("descr: expected"));
  EXPECT_THAT(ParseError(Replaced("False", "True ")), HasSubstr("fortran_order: expected False"));
  EXPECT_THAT(ParseError(Replaced("(2, 12, 15, 3)", "(2, 15, 12, 3)")),
              HasSubstr("frames, got (2, 15, 12, 3)"));
  EXPECT_THAT(ParseError(Replaced("(2, 12, 15, 3)", "(3, 12, 15, 3)")),
              HasSubstr("frames, got (3, 12, 15, 3)"));
  EXPECT_THAT(ParseError(Replaced("(2, 12, 15, 3)", "(2, 00, 15, 3)")),
              HasSubstr("frames, got (2, 0, 15, 3)"));
  EXPECT_THAT(ParseError(Replaced("(2, 12, 15, 3)", "(2, 13, 15, 3)")),
              HasSubstr("bytes of values"));
  EXPECT_THAT(ParseError(Replaced("(2, 12, 15, 3)", "(2, xx, 15, 3)")), HasSubstr("whole numbers"));
  EXPECT_THAT(ParseError(Replaced("shape", "shade")), HasSubstr("frames, got ()"));
}

TEST(Npy, RejectsAHeaderLongerThanTheFile) {
  std::string bytes = FormatNpy(MakePair());
  bytes[8] = bytes[9] = '\xff';
  EXPECT_THAT(ParseError(bytes), HasSubstr("bytes, got 65535"));
}

TEST(Npy, NamesAPositionThatIsNotFinite) {
  std::string bytes = FormatNpy(MakePair());
  const std::size_t second_joint = bytes.find('\n') + 1 + (15 * 3 + 3) * 4;
  bytes.replace(second_joint, 4, std::string("\0\0\xc0\x7f", 4));
  EXPECT_THAT(ParseError(bytes), HasSubstr("frame 1 neck: expected a finite position, got nan"));
}

}  // namespace
}  // namespace duet::formats::flat
