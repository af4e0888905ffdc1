#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "gtest/gtest.h"
#include "model/checkpoint/safetensors.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

using test::ReadTestFile;
using test::TemporaryFolder;
using test::TinyCheckpoint;
using test::WriteTestFile;

constexpr char kPython[] = "/usr/bin/python3";

// Values that only an exact copy preserves: no short decimal form, denormal, negative zero.
std::vector<Tensor> AwkwardTensors() {
  std::vector<Tensor> tensors = TinyCheckpoint().tensors;
  tensors.push_back(
      {"awkward", {2, 3}, {1.0f / 3, -0.0f, 1e-45f, 3.4028235e38f, -1e-7f, 16777216}});
  tensors.push_back({"scalar", {}, {2.5f}});
  return tensors;
}

// The text form that the script reads and prints.
std::string ToText(const std::vector<Tensor>& tensors) {
  std::string text;
  for (const Tensor& tensor : tensors) {
    absl::StrAppend(&text, tensor.name, "\t", absl::StrJoin(tensor.shape, ","), "\t",
                    absl::StrJoin(tensor.values, " ",
                                  [](std::string* out, float value) {
                                    absl::StrAppendFormat(out, "%.9g", value);
                                  }),
                    "\n");
  }
  return text;
}

std::vector<Tensor> FromText(const std::string& text) {
  std::vector<Tensor> tensors;
  for (absl::string_view line : absl::StrSplit(text, '\n', absl::SkipEmpty())) {
    const std::vector<std::string> fields = absl::StrSplit(line, '\t');
    EXPECT_EQ(fields.size(), 3u) << line;
    if (fields.size() != 3) return {};
    Tensor tensor;
    tensor.name = fields[0];
    for (absl::string_view size : absl::StrSplit(fields[1], ',', absl::SkipEmpty())) {
      EXPECT_TRUE(absl::SimpleAtoi(size, &tensor.shape.emplace_back())) << size;
    }
    for (absl::string_view value : absl::StrSplit(fields[2], ' ', absl::SkipEmpty())) {
      EXPECT_TRUE(absl::SimpleAtof(value, &tensor.values.emplace_back())) << value;
    }
    tensors.push_back(tensor);
  }
  return tensors;
}

void ExpectSame(const std::vector<Tensor>& got, const std::vector<Tensor>& wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(got[i].name, wanted[i].name);
    EXPECT_EQ(got[i].shape, wanted[i].shape) << got[i].name;
    EXPECT_EQ(got[i].values, wanted[i].values) << got[i].name;
  }
}

class PythonInterop : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kPython)) GTEST_SKIP() << kPython << " is not installed";
  }

  // Runs the script over `file_` with standard input and output from and to files.
  void RunScript(const std::string& mode) {
    const char* source = std::getenv("DUET_SOURCE_DIR");
    ASSERT_NE(source, nullptr) << "DUET_SOURCE_DIR is not set";
    const std::string command =
        absl::StrCat(kPython, " '", source, "/tests/checkpoint/safetensors_text.py' ", mode, " '",
                     file_.string(), "' < '", input_.string(), "' > '", output_.string(), "'");
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "weights.safetensors";
  std::filesystem::path input_ = folder_ / "input";
  std::filesystem::path output_ = folder_ / "output";
};

TEST_F(PythonInterop, PythonReadsFilesOfTheWriter) {
  WriteTestFile(file_, SerializeSafetensors(AwkwardTensors(), {{"a", "b"}}));
  WriteTestFile(input_, "");
  RunScript("read");
  ExpectSame(FromText(ReadTestFile(output_)), AwkwardTensors());
}

TEST_F(PythonInterop, ReaderReadsFilesOfPython) {
  WriteTestFile(input_, ToText(AwkwardTensors()));
  RunScript("write");
  const absl::StatusOr<std::vector<Tensor>> tensors = ParseSafetensors(ReadTestFile(file_));
  ASSERT_THAT(tensors, IsOk());
  ExpectSame(*tensors, AwkwardTensors());
}

}  // namespace
}  // namespace duet::checkpoint
