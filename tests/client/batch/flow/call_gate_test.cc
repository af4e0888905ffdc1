#include "client/batch/flow/call_gate.h"

#include <atomic>
#include <thread>
#include <vector>

#include "gtest/gtest.h"

namespace duet::client::batch::flow {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

TEST(CallGate, NeverStartsMoreCallsThanTheWindow) {
  Options options;
  options.max_in_flight = 3;
  CallGate gate(options, hours(1));
  std::atomic<int> under_way{0}, most{0}, made{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      for (int n = 0; n < 50; ++n) {
        const auto call = gate.Start();
        const int now = ++under_way;
        for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
        }
        ++made;
        --under_way;
        gate.Finish(*call, CallEnd::kAnswered, std::nullopt);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made, 400);
  EXPECT_LE(most, 3);
}

TEST(CallGate, StopWakesWaitingThreads) {
  CallGate gate(Options(), hours(1));
  while (gate.state().in_flight < gate.state().limit) gate.Start();
  std::thread waiting([&gate] { EXPECT_FALSE(gate.Start().has_value()); });
  gate.Stop();
  waiting.join();
}

TEST(CallGate, EndsIfServersStayAway) {
  Options options;
  options.first_backoff = options.longest_backoff = milliseconds(1);
  CallGate gate(options, milliseconds(0));
  gate.Finish(*gate.Start(), CallEnd::kAway, std::nullopt);
  EXPECT_FALSE(gate.state().lost_patience);
  gate.Finish(*gate.Start(), CallEnd::kAway, std::nullopt);
  EXPECT_TRUE(gate.state().lost_patience);
  EXPECT_FALSE(gate.Start().has_value());
}

}  // namespace
}  // namespace duet::client::batch::flow
