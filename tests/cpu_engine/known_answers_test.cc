// Answers of small networks, recorded when they equalled LibTorch's (parity_test.cc), so that
// builds and sanitizers without LibTorch notice a change of either network.
#include <gtest/gtest.h>

#include <cmath>

#include "model/cpu_engine/cpu_synthesizer.h"
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
  ExpectNear(Digests(RandomCheckpoint(manifest, 1)), {-0.427058, -0.150484, -8.720854, -8.109073,
                                                      1.315912, 0.729884, -6.503859, -3.846356});
}

TEST(KnownAnswersTest, SamplingGeneratorGivesTheRecordedAnswers) {
  ExpectNear(Digests(RandomCheckpoint(FlowManifest(), 3)),
             {0.850734, 0.534333, -7.664476, -6.933314, 1.120935, 0.261015, -5.959330, -3.086495});
}

}  // namespace
}  // namespace duet::cpu_engine
