#include <gmock/gmock.h>

#include "model/cpu_engine/paper_network.h"

namespace duet::cpu_engine {
namespace {

using ::testing::ElementsAre;

std::vector<int> List(const int* values, int count) { return {values, values + count}; }

TEST(WindowBatchTest, OrdersWindowsByLengthAndKeepsTheirFramesTogether) {
  std::vector<engine::NetworkInput> inputs(4);
  const int frames[] = {3, 7, 2, 7};
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].leader = motion::Poses(frames[i], 1);
  Scratch scratch;
  Scratch::Use use(&scratch);
  const WindowBatch batch = MakeWindowBatch(inputs, &use);
  ASSERT_EQ(batch.count, 4);
  EXPECT_EQ(batch.rows, 19);
  EXPECT_THAT(List(batch.input, 4), ElementsAre(1, 3, 0, 2));
  EXPECT_THAT(List(batch.length, 4), ElementsAre(7, 7, 3, 2));
  EXPECT_THAT(List(batch.first_row, 4), ElementsAre(0, 7, 14, 17));
  EXPECT_EQ(batch.LongerThan(0, 4), 4);
  EXPECT_EQ(batch.LongerThan(2, 4), 3);
  EXPECT_EQ(batch.LongerThan(3, 3), 2);
  EXPECT_EQ(batch.LongerThan(7, 2), 0);
  const WindowBatch last = batch.Some(1, 2);
  EXPECT_EQ(last.rows, 10);
  EXPECT_THAT(List(last.first_row, last.count), ElementsAre(7, 14));
  EXPECT_EQ(batch.Some(3, 9).count, 1);
}

}  // namespace
}  // namespace duet::cpu_engine
