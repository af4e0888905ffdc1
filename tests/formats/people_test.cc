#include "model/formats/people.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_motion.h"

namespace duet::formats {
namespace {

using test::LargestDistance;
using test::MakePerson;

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;

class PeopleTest : public ::testing::Test {
 protected:
  std::filesystem::path Write(const std::string& name, const std::vector<motion::Clip>& people) {
    const std::filesystem::path file = folder_ / name;
    EXPECT_THAT(WritePeople(file, *FormatOf(file), people, motion::SbuSkeleton()), IsOk());
    return file;
  }

  static absl::StatusOr<ReadPeople> Read(const std::filesystem::path& file) {
    return ReadAllPeople([&](const ReadOptions& person) { return ReadLeader(file, person); }, {});
  }

  const motion::Clip leader_ = MakePerson();
  const motion::Clip follower_ = MakePerson({60, 3, 0, {0, 1.1f, 1.2f}, 30});
  const test::TemporaryFolder folder_;
};

TEST_F(PeopleTest, ReadsAllPeopleLeaderFirst) {
  const absl::StatusOr<ReadPeople> two = Read(Write("two.csv", {leader_, follower_}));
  ASSERT_THAT(two, IsOk());
  ASSERT_EQ(two->people.size(), 2u);
  EXPECT_LT(LargestDistance(two->people[0], leader_), 1e-5f);
  EXPECT_LT(LargestDistance(two->people[1], follower_), 1e-5f);
  const absl::StatusOr<ReadPeople> one = Read(Write("one.bvh", {leader_}));
  ASSERT_THAT(one, IsOk());
  EXPECT_EQ(one->people.size(), 1u);
  EXPECT_THAT(one->notes, Contains(HasSubstr("unit: centimetres")));
}

TEST_F(PeopleTest, ErrorsOfEitherPersonAreReturned) {
  int calls = 0;
  const auto fail_second = [&](const ReadOptions& person) -> absl::StatusOr<motion::Clip> {
    ++calls;
    if (person.side == Side::kRight) return absl::InvalidArgumentError("the second");
    person.report->people = 2;
    return leader_;
  };
  EXPECT_THAT(ReadAllPeople(fail_second, {}), StatusIs(kInvalid, "the second"));
  EXPECT_EQ(calls, 2);
}

TEST_F(PeopleTest, FilesAreCheckedBeforeTheyAreRead) {
  EXPECT_THAT(CheckReadable(folder_ / "absent.bvh", std::nullopt),
              StatusIs(absl::StatusCode::kNotFound, EndsWith("absent.bvh: no such file")));
  EXPECT_THAT(CheckReadable(folder_.path(), std::nullopt),
              StatusIs(kInvalid, EndsWith(": expected a motion file, got a folder")));
  test::WriteTestFile(folder_ / "a.obj", "");
  EXPECT_THAT(CheckReadable(folder_ / "a.obj", std::nullopt),
              StatusIs(kInvalid, AllOf(HasSubstr("extension: expected"), EndsWith("\".obj\""))));
  EXPECT_THAT(CheckReadable(folder_ / "a.obj", Format::kCsv), IsOk());
  EXPECT_THAT(CheckReadable(Write("a.npy", {leader_}), std::nullopt), IsOk());
}

TEST_F(PeopleTest, FolderOfAnOutputMustExist) {
  EXPECT_THAT(CheckFolderOf("new.csv"), IsOk());
  EXPECT_THAT(CheckFolderOf(folder_ / "new.csv"), IsOk());
  EXPECT_THAT(CheckFolderOf(folder_ / "no/new.csv"),
              StatusIs(kInvalid, HasSubstr("no/new.csv: there is no folder ")));
}

}  // namespace
}  // namespace duet::formats
