#include "model/cpu_engine/scratch.h"

#include <algorithm>
#include <new>

namespace duet::cpu_engine {
namespace {

constexpr std::size_t kSmallestBlock = std::size_t{1} << 16;

}  // namespace

void Scratch::Free::operator()(std::byte* bytes) const {
  ::operator delete (bytes, std::align_val_t{kAlignment});
}

std::size_t Scratch::bytes() const {
  std::size_t sum = 0;
  for (const Block& block : blocks_) sum += block.size;
  return sum;
}

void Scratch::Add(std::size_t size) {
  void* bytes = ::operator new (size, std::align_val_t{kAlignment});
  blocks_.push_back({std::unique_ptr<std::byte, Free>(static_cast<std::byte*>(bytes)), size});
  used_ = 0;
}

void* Scratch::Bytes(std::size_t size) {
  const std::size_t rounded = (size + kAlignment - 1) / kAlignment * kAlignment;
  if (blocks_.empty() || blocks_.back().size - used_ < rounded) {
    Add(std::max({kSmallestBlock, rounded, bytes()}));
  }
  void* taken = blocks_.back().bytes.get() + used_;
  used_ += rounded;
  taken_ += rounded;
  return taken;
}

void Scratch::Reset() {
  if (blocks_.size() > 1) {
    blocks_.clear();
    Add(taken_);
  }
  used_ = taken_ = 0;
}

}  // namespace duet::cpu_engine
