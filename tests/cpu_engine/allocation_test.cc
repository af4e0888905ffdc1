// After an evaluation of the same size, another one allocates only its answers.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "model/cpu_engine/cpu_synthesizer.h"
#include "model/embedded/embedded.h"

namespace {

std::atomic<int> allocations{0};

}  // namespace

// Counts every allocation of this program. The array and nothrow forms call this one.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* bytes = std::malloc(size)) return bytes;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto to = static_cast<std::size_t>(alignment);
  if (void* bytes = std::aligned_alloc(to, (size + to - 1) / to * to)) return bytes;
  throw std::bad_alloc();
}
void operator delete(void* bytes) noexcept { std::free(bytes); }
void operator delete(void* bytes, std::size_t) noexcept { std::free(bytes); }
void operator delete(void* bytes, std::align_val_t) noexcept { std::free(bytes); }
void operator delete(void* bytes, std::size_t, std::align_val_t) noexcept { std::free(bytes); }

namespace duet::cpu_engine {
namespace {

int AllocationsOf(const engine::Network& network, absl::Span<const engine::NetworkInput> inputs) {
  const int before = allocations;
  EXPECT_TRUE(network.Run(inputs).ok());
  return allocations - before;
}

TEST(AllocationTest, EvaluationAllocatesOnlyItsAnswers) {
  for (const embedded::EmbeddedCheckpoint& embedded : embedded::EmbeddedCheckpoints()) {
    const auto checkpoint = checkpoint::ParseCheckpoint(embedded.manifest, embedded.weights);
    ASSERT_TRUE(checkpoint.ok());
    const engine::ModelDescription& model = checkpoint->manifest.model;
    std::vector<engine::NetworkInput> inputs;
    for (const int frames : {model.window_frames, 3, 20}) {
      engine::NetworkInput input;
      input.leader = motion::Poses(frames, model.skeleton.joint_count());
      input.labels.assign(static_cast<std::size_t>(frames) * model.classes.size(), 0.25f);
      inputs.push_back(std::move(input));
    }
    for (const kernels::Precision precision : {kernels::Precision::kFloat32, BestPrecision()}) {
      const auto network = MakeCpuNetwork(*checkpoint, precision);
      AllocationsOf(*network, inputs);  // the first evaluation of this size
      // The vector of answers, and each answer.
      EXPECT_EQ(AllocationsOf(*network, inputs), 1 + static_cast<int>(inputs.size()))
          << model.name << " " << model.version;
    }
  }
}

TEST(AllocationTest, MemoryOfAThreadIsBoundedForAnyBatchSize) {
  for (const embedded::EmbeddedCheckpoint& embedded : embedded::EmbeddedCheckpoints()) {
    const auto checkpoint = checkpoint::ParseCheckpoint(embedded.manifest, embedded.weights);
    ASSERT_TRUE(checkpoint.ok());
    const engine::ModelDescription& model = checkpoint->manifest.model;
    engine::NetworkInput input;
    input.leader = motion::Poses(model.window_frames, model.skeleton.joint_count());
    input.labels.assign(static_cast<std::size_t>(model.window_frames) * model.classes.size(), 1);
    const auto network = MakeCpuNetwork(*checkpoint, BestPrecision());
    ASSERT_TRUE(network->Run(std::vector<engine::NetworkInput>(40, input)).ok());
    const std::size_t kept = ThreadScratchBytes();
    ASSERT_TRUE(network->Run(std::vector<engine::NetworkInput>(160, input)).ok());
    EXPECT_EQ(ThreadScratchBytes(), kept) << model.name << " " << model.version;
    EXPECT_LT(kept, std::size_t{32} << 20) << model.name << " " << model.version;
  }
}

}  // namespace
}  // namespace duet::cpu_engine
