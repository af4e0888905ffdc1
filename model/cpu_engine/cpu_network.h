#ifndef DUET_MODEL_CPU_ENGINE_CPU_NETWORK_H_
#define DUET_MODEL_CPU_ENGINE_CPU_NETWORK_H_

#include <cstddef>
#include <memory>

#include "model/checkpoint/checkpoint.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/engine/network.h"

namespace duet::cpu_engine {

// bfloat16 where the processor multiplies it, else float32.
kernels::Precision BestPrecision();

// A checkpoint's generator, the paper's or the sampling one, in this project's own kernels.
//
// A window's answer is the same to the bit whatever else is in the batch. Batches of many frames
// are taken in parts, so that what a thread needs is bounded; it keeps that for the next batch
// (ThreadScratchBytes). bfloat16 is slow without kernels::HasBf16().
std::unique_ptr<const engine::Network> MakeCpuNetwork(const checkpoint::Checkpoint& checkpoint,
                                                      kernels::Precision precision);

// Memory that this thread keeps for evaluations.
std::size_t ThreadScratchBytes();

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_CPU_NETWORK_H_
