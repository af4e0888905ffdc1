#ifndef DUET_MODEL_CPU_ENGINE_SCRATCH_H_
#define DUET_MODEL_CPU_ENGINE_SCRATCH_H_

#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

namespace duet::cpu_engine {

// Temporary memory of evaluations, kept between them. After one evaluation, another of at most the
// same size allocates nothing.
//
//   Scratch::Use use(&scratch);
//   float* gates = use.Take<float>(rows * 160);   // not initialised; valid until `use` is
//   destroyed
//
// Threads: not safe to call concurrently. Use one per thread.
class Scratch {
 public:
  // The memory of one evaluation. At most one exists at a time.
  class Use {
   public:
    explicit Use(Scratch* scratch) : scratch_(scratch) {}
    ~Use() { scratch_->Reset(); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

    // Returns `count` values that begin on their own cache line.
    template <typename T>
    T* Take(std::ptrdiff_t count) {
      static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kAlignment);
      return static_cast<T*>(scratch_->Bytes(static_cast<std::size_t>(count) * sizeof(T)));
    }

   private:
    Scratch* scratch_;
  };

  // Bytes held between evaluations.
  std::size_t bytes() const;

 private:
  static constexpr std::size_t kAlignment = 64;
  struct Free {
    void operator()(std::byte* bytes) const;
  };
  struct Block {
    std::unique_ptr<std::byte, Free> bytes;
    std::size_t size;
  };

  void* Bytes(std::size_t size);
  // Replaces several blocks by one of the size that was taken from them, so that the next
  // evaluation uses one block.
  void Reset();
  void Add(std::size_t size);

  std::vector<Block> blocks_;
  std::size_t used_ = 0;   // of the last block
  std::size_t taken_ = 0;  // of all blocks
};

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_SCRATCH_H_
