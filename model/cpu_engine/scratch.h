#ifndef DUET_MODEL_CPU_ENGINE_SCRATCH_H_
#define DUET_MODEL_CPU_ENGINE_SCRATCH_H_

#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

namespace duet::cpu_engine {

// Memory for what an evaluation needs while it runs, kept for the next one: once an evaluation of
// its size has run, another allocates nothing.
//
//   Scratch::Use use(&scratch);
//   float* gates = use.Take<float>(rows * 160);   // not initialised; gone with `use`
//
// Threads: not safe to call concurrently: one for each thread.
class Scratch {
 public:
  // One evaluation. One at a time.
  class Use {
   public:
    explicit Use(Scratch* scratch) : scratch_(scratch) {}
    ~Use() { scratch_->Reset(); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

    // `count` values on a cache line of their own.
    template <typename T>
    T* Take(std::ptrdiff_t count) {
      static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kAlignment);
      return static_cast<T*>(scratch_->Bytes(static_cast<std::size_t>(count) * sizeof(T)));
    }

   private:
    Scratch* scratch_;
  };

  // What is held between evaluations.
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
  // Makes one block of several, as large as what was taken of them: the next evaluation finds all
  // its memory in one piece.
  void Reset();
  void Add(std::size_t size);

  std::vector<Block> blocks_;
  std::size_t used_ = 0;   // of the last block
  std::size_t taken_ = 0;  // of all blocks
};

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_SCRATCH_H_
