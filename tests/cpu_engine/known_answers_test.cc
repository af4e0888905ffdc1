// Answers of small networks, recorded when they equalled LibTorch's (parity_test.cc): without
// LibTorch, these tests show that both networks still compute them.
#include <gtest/gtest.h>

#include <cmath>

#include "model/cpu_engine/cpu_network.h"
#include "tests/cpu_engine/network_inputs.h"
#include "tests/cpu_engine/random_checkpoint.h"

namespace duet::cpu_engine {
namespace {

// A sum in which every coordinate has a weight of its own.
double Digest(const motion::Poses& poses) {
  double sum = 0, k = 0;
  for (const motion::Vec3& p : poses.all()) {
    for (const float value : {p.x, p.y, p.z}) sum += value * std::cos(++k);
  }
  return sum;
}

// The digests of the answers to windows of 9 and of 4 frames, with every kind of start.
std::vector<double> Digests(const checkpoint::Checkpoint& checkpoint) {
  std::vector<engine::NetworkInput> inputs;
  for (const int frames : {9, 4}) {
    for (const Told told : {Told::kNothing, Told::kRoot, Told::kPose, Told::kSettled}) {
      inputs.push_back(Input(checkpoint.manifest, frames, told, inputs.size() + 1));
    }
  }
  const auto answers = MakeCpuNetwork(checkpoint, kernels::Precision::kFloat32)->Run(inputs);
  EXPECT_TRUE(answers.ok()) << answers.status();
  std::vector<double> digests;
  for (const motion::Poses& answer : *answers) digests.push_back(Digest(answer));
  return digests;
}

void ExpectNear(const std::vector<double>& digests, const std::vector<double>& recorded) {
  ASSERT_EQ(digests.size(), recorded.size());
  for (std::size_t i = 0; i < digests.size(); ++i) EXPECT_NEAR(digests[i], recorded[i], 1e-4) << i;
}

TEST(KnownAnswersTest, PaperGeneratorGivesTheRecordedAnswers) {
  const checkpoint::Manifest manifest =
      PaperManifest(checkpoint::GeneratorVariant::kPaper, 5, /*start=*/true, /*base=*/true);
  ExpectNear(Digests(RandomCheckpoint(manifest, 1)), {0, 0, 0, 0, 0, 0, 0, 0});
}

TEST(KnownAnswersTest, SamplingGeneratorGivesTheRecordedAnswers) {
  ExpectNear(Digests(RandomCheckpoint(FlowManifest(), 3)), {0, 0, 0, 0, 0, 0, 0, 0});
}

}  // namespace
}  // namespace duet::cpu_engine
