#include "model/classifier/classifier_files.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/classifier/random_classifier.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::classifier {
namespace {

using test::RandomClassifier;
using ::testing::_;

TEST(ClassifierFiles, RoundTrip) {
  const test::TemporaryFolder folder;
  const ClassifierParts parts = RandomClassifier();
  ASSERT_THAT(WriteClassifier(folder / "judge", parts), IsOk());
  const absl::StatusOr<StoredClassifier> stored = ReadClassifier(folder / "judge");
  ASSERT_THAT(stored, IsOk());
  EXPECT_EQ(stored->sha256.size(), 64u);
  const ClassifierParts& read = stored->classifier.parts();
  EXPECT_EQ(read.classes, parts.classes);
  EXPECT_EQ(read.skeleton.joint_names, parts.skeleton.joint_names);
  EXPECT_EQ(read.frame_rate_hz, 15);
  EXPECT_EQ(read.window_frames, 20);
  ASSERT_EQ(read.tensors.size(), parts.tensors.size());
  for (const checkpoint::Tensor& tensor : read.tensors) {
    bool found = false;
    for (const checkpoint::Tensor& wanted : parts.tensors) {
      found |= wanted.name == tensor.name && wanted.values == tensor.values;
    }
    EXPECT_TRUE(found) << tensor.name;
  }
}

TEST(ClassifierFiles, RejectsFilesThatAreNoClassifier) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(ReadClassifier(folder / "none"), StatusIs(absl::StatusCode::kNotFound, _));
  ASSERT_THAT(WriteClassifier(folder.path(), RandomClassifier()), IsOk());
  std::string weights = test::ReadTestFile(folder / "weights.safetensors");
  weights.back() ^= 1;
  test::WriteTestFile(folder / "weights.safetensors", weights);
  EXPECT_THAT(ReadClassifier(folder.path()),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("weights.safetensors")));
  test::WriteTestFile(folder / "judge.json", R"({"format": 2})");
  EXPECT_THAT(ReadClassifier(folder.path()),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("judge.json: format")));
}

}  // namespace
}  // namespace duet::classifier
