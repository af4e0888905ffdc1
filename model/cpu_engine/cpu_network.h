#ifndef DUET_MODEL_CPU_ENGINE_CPU_NETWORK_H_
#define DUET_MODEL_CPU_ENGINE_CPU_NETWORK_H_

#include <cstddef>
#include <memory>

#include "model/checkpoint/checkpoint.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/engine/network.h"

namespace duet::cpu_engine {

// The fastest on this processor (kernels::IsInt16Faster).
kernels::Precision BestPrecision();

// Runs a checkpoint's generator, of any architecture, in this project's own kernels.
//
// A window's answer is bit-identical whatever else is in the batch. Large batches are evaluated in
// parts, which bounds the memory of a thread; the thread keeps it for the next batch
// (ThreadScratchBytes).
std::unique_ptr<const engine::Network> MakeCpuNetwork(const checkpoint::Checkpoint& checkpoint,
                                                      kernels::Precision precision);

// Memory that the calling thread keeps for evaluations, bytes.
std::size_t ThreadScratchBytes();

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_CPU_NETWORK_H_
