#include "model/formats/research/npz_archive.h"

#include <cstdlib>
#include <string>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/flat/npy_array.h"
#include "model/formats/research/npz_numbers.h"
#include "tests/formats/research/npz_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::formats::research {
namespace {

using test::Packed;

std::string TwoArrays(Packed packed) {
  return test::MakeNpz({{"a", test::Array({2, 2}, {1, 2, 3, 4})}, {"b", test::Array({1}, {5})}},
                       packed);
}

// What reading an array says.
std::string ReadError(const std::string& bytes, const char* name = "a") {
  const absl::StatusOr<NpzArchive> archive = NpzArchive::Parse(bytes, "m.npz");
  if (!archive.ok()) return std::string(archive.status().message());
  return std::string(ReadNumbers(*archive, name).status().message());
}

TEST(NpzArchive, ReadsStoredAndDeflatedArrays) {
  for (const Packed packed : {Packed::kStored, Packed::kDeflated}) {
    const std::string bytes = TwoArrays(packed);
    const absl::StatusOr<NpzArchive> archive = NpzArchive::Parse(bytes, "m.npz");
    ASSERT_TRUE(archive.ok()) << archive.status();
    EXPECT_THAT(archive->Names(), ElementsAre("a", "b"));
    const absl::StatusOr<NpzNumbers> numbers = ReadNumbers(*archive, "a");
    ASSERT_TRUE(numbers.ok()) << numbers.status();
    EXPECT_THAT(numbers->shape, ElementsAre(2, 2));
    EXPECT_THAT(numbers->values, ElementsAre(1, 2, 3, 4));
  }
}

TEST(NpzArchive, ACommentAfterTheDirectoryIsSkipped) {
  std::string bytes = TwoArrays(Packed::kDeflated);
  bytes[bytes.size() - 2] = 7;
  EXPECT_EQ(ReadError(bytes + "comment"), "");
}

TEST(NpzArchive, NamesTheArraysThatThereAre) {
  EXPECT_EQ(ReadError(TwoArrays(Packed::kStored), "poses"),
            "m.npz: expected an array poses, got \"a\", \"b\"");
}

TEST(NpzArchive, RejectsEveryTruncation) {
  for (const Packed packed : {Packed::kStored, Packed::kDeflated}) {
    const std::string bytes = TwoArrays(packed);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_THAT(ReadError(bytes.substr(0, size)), HasSubstr("expected")) << size;
    }
  }
}

TEST(NpzArchive, RejectsChangedData) {
  std::string bytes = TwoArrays(Packed::kStored);
  bytes[bytes.find("NUMPY")] = 'M';
  EXPECT_EQ(ReadError(bytes), "m.npz: a: expected an array in the archive, got damaged data");
}

// Replaces the four bytes of a number that the archive holds, everywhere.
void Replace(std::uint32_t from, std::uint32_t to, std::string* bytes) {
  const auto text = [](std::uint32_t number) {
    return std::string(reinterpret_cast<const char*>(&number), 4);
  };
  for (std::size_t at = 0; (at = bytes->find(text(from), at)) != std::string::npos; at += 4) {
    bytes->replace(at, 4, text(to));
  }
}

// A bomb states a size that its data cannot have, or one above every motion's.
TEST(NpzArchive, NeverAllocatesWhatSmallDataStates) {
  const std::string array = test::Array({500}, std::vector<float>(500));
  std::string bytes = test::MakeNpz({{"a", array}});
  const auto size = static_cast<std::uint32_t>(array.size());
  Replace(size, 500u << 20, &bytes);
  EXPECT_THAT(ReadError(bytes), HasSubstr("got damaged data"));
  Replace(500u << 20, 600u << 20, &bytes);
  EXPECT_THAT(ReadError(bytes), HasSubstr("expected at most 512 MiB, got 629145600 bytes"));
}

TEST(NpzArchive, RejectsOtherMethodsAndDirectories) {
  std::string bytes = TwoArrays(Packed::kDeflated);
  bytes[bytes.find("PK\x01\x02") + 10] = 12;
  EXPECT_THAT(ReadError(bytes), HasSubstr("expected a stored or deflated array, got method 12"));
  bytes = TwoArrays(Packed::kDeflated);
  bytes[bytes.rfind("PK\x05\x06") + 10] = 3;
  EXPECT_THAT(ReadError(bytes), HasSubstr("directory: expected 3 entries, got 2"));
  EXPECT_THAT(ReadError("no archive"), HasSubstr("expected an .npz archive (zip)"));
}

TEST(NpyNumbers, ReadsIntegersAndFortranOrder) {
  std::string fortran = test::Array({2, 3}, {1, 2, 3, 4, 5, 6});
  fortran.replace(fortran.find("False"), 5, "True ");
  const absl::StatusOr<flat::NpyNumbers> columns = flat::NpyNumbers::Parse(fortran, "a");
  ASSERT_TRUE(columns.ok()) << columns.status();
  std::vector<double> values;
  for (std::size_t i = 0; i < columns->size(); ++i) values.push_back(columns->at(i));
  EXPECT_THAT(values, ElementsAre(1, 3, 5, 2, 4, 6));
  std::string integers = test::Array({1}, {0});
  integers.replace(integers.find("<f4"), 3, "<i4");
  integers.replace(integers.size() - 4, 4, "\xfe\xff\xff\xff");
  const absl::StatusOr<flat::NpyNumbers> minus_two = flat::NpyNumbers::Parse(integers, "a");
  ASSERT_TRUE(minus_two.ok()) << minus_two.status();
  EXPECT_EQ(minus_two->at(0), -2);
}

TEST(NpyNumbers, RejectsPickledObjectsAndWrongSizes) {
  std::string object = test::Array({1}, {0});
  object.replace(object.find("<f4"), 3, "|O ");
  object.replace(object.find("|O '"), 4, "|O' ");
  EXPECT_THAT(std::string(flat::NpyNumbers::Parse(object, "J_regressor").status().message()),
              HasSubstr("J_regressor: expected an array of numbers, got a pickled Python object"));
  std::string large = test::Array({2, 2}, {1, 2, 3, 4});
  large.replace(large.find("(2, 2)"), 6, "(2, 9)");
  EXPECT_THAT(std::string(flat::NpyNumbers::Parse(large, "a").status().message()),
              HasSubstr("expected the values of shape (2, 9), got 16 bytes"));
}

TEST(NpzArchive, ReadsWhatNumPyWrites) {
  if (std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "no /usr/bin/python3 with numpy";
  }
  const test::TemporaryFolder folder;
  for (const char* save : {"savez", "savez_compressed"}) {
    const std::string path = (folder / "duet_theirs.npz").string();
    const std::string script =
        absl::StrCat("import numpy as n; n.", save, "('", path,
                     "', rate=30.0, a=n.asfortranarray(n.arange(6).reshape(2, 3)))");
    ASSERT_EQ(std::system(absl::StrCat("/usr/bin/python3 -c \"", script, "\"").c_str()), 0);
    const std::string bytes = test::ReadTestFile(path);
    const absl::StatusOr<NpzArchive> archive = NpzArchive::Parse(bytes, path);
    ASSERT_TRUE(archive.ok()) << archive.status();
    const absl::StatusOr<NpzNumbers> rate = ReadNumbers(*archive, "rate");
    ASSERT_TRUE(rate.ok()) << rate.status();
    EXPECT_THAT(rate->values, ElementsAre(30));
    const absl::StatusOr<NpzNumbers> numbers = ReadNumbers(*archive, "a");
    ASSERT_TRUE(numbers.ok()) << numbers.status();
    EXPECT_THAT(numbers->values, ElementsAre(0, 1, 2, 3, 4, 5));
  }
}

}  // namespace
}  // namespace duet::formats::research
