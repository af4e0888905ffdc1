#include "model/network/torch_network.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <vector>

#include "tests/cpu_engine/network_inputs.h"
#include "tests/cpu_engine/random_checkpoint.h"
#include "tests/support/matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::network {
namespace {

using cpu_engine::FlowManifest;
using cpu_engine::Inputs;
using cpu_engine::PaperManifest;
using cpu_engine::RandomCheckpoint;
using test::TinyCheckpoint;

TEST(TorchNetworkTest, BatchOfDifferentLengthsEqualsSingle) {
  for (const checkpoint::Manifest& manifest :
       {PaperManifest(checkpoint::GeneratorVariant::kPaper, 5, true, true), FlowManifest()}) {
    const auto network = MakeTorchNetwork(RandomCheckpoint(manifest, 1));
    ASSERT_THAT(network, IsOk());
    const std::vector<engine::NetworkInput> inputs = Inputs(manifest);
    const auto together = (*network)->Run(inputs);
    ASSERT_THAT(together, IsOk());
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const auto alone = (*network)->Run({&inputs[i], 1});
      ASSERT_THAT(alone, IsOk());
      float farthest = 0;
      for (std::size_t k = 0; k < (*together)[i].all().size(); ++k) {
        farthest = std::max(farthest, Distance((*together)[i].all()[k], alone->front().all()[k]));
      }
      EXPECT_LT(farthest, 1e-4f) << manifest.model.samples << ", window " << i;
    }
  }
}

TEST(TorchNetworkTest, ExceptionsBecomeAStatus) {
  const auto network = MakeTorchNetwork(TinyCheckpoint());
  ASSERT_THAT(network, IsOk());
  // A leader of one joint, although the parts need three: LibTorch throws.
  engine::NetworkInput input;
  input.leader = motion::Poses(2, 1);
  EXPECT_THAT((*network)->Run({&input, 1}),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("LibTorch failed: ")));
}

TEST(TorchNetworkTest, CheckpointOfOtherShapesIsRejected) {
  checkpoint::Checkpoint checkpoint = TinyCheckpoint();
  checkpoint.tensors[0].shape[0] += 1;
  EXPECT_THAT(MakeTorchNetwork(checkpoint),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(checkpoint.tensors[0].name)));
}

}  // namespace
}  // namespace duet::network
