#ifndef DUET_MODEL_CPU_ENGINE_SCRATCH_H_
#define DUET_MODEL_CPU_ENGINE_SCRATCH_H_

#include <cstddef>
#include <memory_resource>
#include <type_traits>
#include <vector>

namespace duet::cpu_engine {

// Temporary memory of evaluations, kept between them. After one evaluation, another of at most the
// same size allocates nothing.
//
//   Scratch::Use use(&scratch);
//   float* gates = use.Take<float>(rows * 160);  // not initialised; valid as long as `use`
//
// Threads: not safe to call concurrently. Use one per thread.
class Scratch {
 public:
  // The memory of one evaluation. At most one exists at a time.
  class Use {
   public:
    explicit Use(Scratch* scratch)
        : scratch_(scratch), memory_(scratch->bytes_.data(), scratch->bytes_.size()) {}
    ~Use() {
      // The next evaluation of this size finds all of its memory in one block.
      if (taken_ > scratch_->bytes_.size()) scratch_->bytes_ = std::vector<std::byte>(taken_);
    }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

    // Returns `count` values that begin on their own cache line.
    template <typename T>
    T* Take(std::ptrdiff_t count) {
      static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kAlignment);
      // Whole vectors: kernels write them to the end of the last one.
      const std::size_t size =
          (static_cast<std::size_t>(count) * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
      taken_ += size + kAlignment;
      return static_cast<T*>(memory_.allocate(size, kAlignment));
    }

   private:
    static constexpr std::size_t kAlignment = 64;
    Scratch* scratch_;
    std::pmr::monotonic_buffer_resource memory_;
    std::size_t taken_ = 0;  // with the most that alignment can add
  };

  // Bytes held between evaluations.
  std::size_t bytes() const { return bytes_.size(); }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_SCRATCH_H_
