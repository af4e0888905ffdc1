#include "model/cpu_engine/scratch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace duet::cpu_engine {
namespace {

TEST(ScratchTest, PiecesDoNotOverlapAndBeginOnACacheLine) {
  Scratch scratch;
  for (int round = 0; round < 3; ++round) {
    Scratch::Use use(&scratch);
    std::vector<int*> pieces;
    for (int i = 0; i < 200; ++i) {
      pieces.push_back(use.Take<int>(i * 10 + 1));
      std::fill_n(pieces.back(), i * 10 + 1, i);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pieces.back()) % 64, 0u);
    }
    for (int i = 0; i < 200; ++i) {
      const int* const piece = pieces[static_cast<std::size_t>(i)];
      const std::ptrdiff_t size = std::ptrdiff_t{i} * 10 + 1;
      EXPECT_TRUE(std::all_of(piece, piece + size, [i](int value) { return value == i; })) << i;
    }
  }
}

TEST(ScratchTest, KeepsTheMemoryOfTheLargestUse) {
  Scratch scratch;
  const auto use_of = [&](int pieces) {
    Scratch::Use use(&scratch);
    for (int i = 0; i < pieces; ++i) use.Take<float>(100'000);
  };
  use_of(10);
  const std::size_t held = scratch.bytes();
  EXPECT_GE(held, 10u * 400'000);
  EXPECT_LE(held, 20u * 400'000);
  use_of(10);
  use_of(1);
  EXPECT_EQ(scratch.bytes(), held);
}

}  // namespace
}  // namespace duet::cpu_engine
