// An error in every byte of a small checkpoint, and a cut at every length.

#include <cmath>
#include <string>

#include "gtest/gtest.h"
#include "model/base/sha256.h"
#include "model/checkpoint/checkpoint.h"
#include "tests/support/architectures.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

using test::FilledCheckpoint;
using test::TinyManifest;

struct Files {
  std::string manifest;
  std::string weights;
};

// The minimum number of weights: every byte costs a run of the whole reader.
Manifest TiniestManifest() {
  Manifest manifest = TinyManifest();
  test::PaperOf(manifest).slice_features = 0;
  test::PaperOf(manifest).encoder_hidden = test::PaperOf(manifest).attention = 1;
  return manifest;
}

Files TiniestFiles() {
  const Checkpoint checkpoint = FilledCheckpoint(TiniestManifest());
  Files files;
  files.weights = SerializeSafetensors(checkpoint.tensors, {{"format", "pt"}});
  Manifest manifest = checkpoint.manifest;
  manifest.weights = {"weights.safetensors", files.weights.size(), base::Sha256Hex(files.weights)};
  files.manifest = SerializeManifest(manifest);
  return files;
}

// Calls `check(corrupt)` for every byte of `text`, once with one bit flipped (a different one in
// each byte) and once with all bits flipped.
template <typename Check>
void FlipEveryByte(std::string text, const Check& check) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (int mask : {1 << at % 8, 0xff}) {
      SCOPED_TRACE(testing::Message() << "byte " << at << ", mask " << mask);
      text[at] = static_cast<char>(text[at] ^ mask);
      check(text);
      text[at] = static_cast<char>(text[at] ^ mask);
      if (testing::Test::HasFailure()) return;
    }
  }
}

// Checks what the reader guarantees for any input that it accepts.
void ExpectSound(const Checkpoint& checkpoint) {
  const std::vector<TensorSpec> specs = ExpectedTensors(checkpoint.manifest);
  ASSERT_EQ(checkpoint.tensors.size(), specs.size());
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const Tensor& tensor = checkpoint.tensors[i];
    EXPECT_EQ(tensor.name, specs[i].name);
    EXPECT_EQ(tensor.shape, specs[i].shape);
    std::size_t count = 1;
    for (int64_t size : tensor.shape) count *= static_cast<std::size_t>(size);
    EXPECT_EQ(tensor.values.size(), count);
    for (float value : tensor.values) ASSERT_TRUE(std::isfinite(value));
  }
}

TEST(Corruption, DetectsAnyChangedByteOfTheWeights) {
  const Files files = TiniestFiles();
  ASSERT_THAT(ParseCheckpoint(files.manifest, files.weights), IsOk());
  FlipEveryByte(files.weights, [&](const std::string& corrupt) {
    EXPECT_THAT(ParseCheckpoint(files.manifest, corrupt), Not(IsOk()));
  });
}

TEST(Corruption, ChangedWeightsWithAMatchingHashAreRejectedOrValid) {
  const Files files = TiniestFiles();
  Manifest manifest = TiniestManifest();
  FlipEveryByte(files.weights, [&](const std::string& corrupt) {
    manifest.weights = {"weights.safetensors", corrupt.size(), base::Sha256Hex(corrupt)};
    const absl::StatusOr<Checkpoint> read = ParseCheckpoint(SerializeManifest(manifest), corrupt);
    if (read.ok()) {
      ExpectSound(*read);
    } else {
      EXPECT_FALSE(read.status().message().empty());
    }
  });
}

TEST(Corruption, ChangedManifestIsRejectedOrValid) {
  const Files files = TiniestFiles();
  FlipEveryByte(files.manifest, [&](const std::string& corrupt) {
    const absl::StatusOr<Checkpoint> read = ParseCheckpoint(corrupt, files.weights);
    if (read.ok()) {
      ExpectSound(*read);
      EXPECT_THAT(Validate(read->manifest.model.skeleton), IsOk());
      // Accepted text is equal after it is written and read again.
      EXPECT_EQ(SerializeManifest(*ParseManifest(SerializeManifest(read->manifest))),
                SerializeManifest(read->manifest));
    } else {
      EXPECT_FALSE(read.status().message().empty());
    }
  });
}

TEST(Corruption, TruncatedWeightsAreDataLoss) {
  const Files files = TiniestFiles();
  for (std::size_t size = 0; size < files.weights.size(); ++size) {
    ASSERT_EQ(ParseCheckpoint(files.manifest, files.weights.substr(0, size)).status().code(),
              absl::StatusCode::kDataLoss)
        << size;
  }
}

}  // namespace
}  // namespace duet::checkpoint
