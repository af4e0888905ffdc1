#include "server/batching/batch_decision.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "tests/support/matchers.h"

namespace duet::server::batching {
namespace {

using common::TimePoint;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr auto kDeadlineExceeded = absl::StatusCode::kDeadlineExceeded;
constexpr TimePoint kNow(seconds(1000));
constexpr int kFrames = 40;
// 10 ms for a batch, 5 ms for a window of kFrames.
constexpr CostEstimate kCost = {0.010, 0.005 / kFrames};

// A window that came 100 ms ago.
WaitingWindow Window(Lane lane = Lane::kShort, std::size_t model = 0) {
  WaitingWindow window;
  window.lane = lane;
  window.model = model;
  window.frames = kFrames;
  window.queued_at = kNow - milliseconds(100);
  return window;
}

// One whose evaluation must end so much later: with an eighth of its time left then.
WaitingWindow Due(milliseconds left) {
  WaitingWindow window = Window();
  window.deadline = window.queued_at + (milliseconds(100) + left) * 8 / 7;
  return window;
}

// One worker, models of known cost.
QueueState State(std::vector<WaitingWindow> windows, std::size_t models = 1) {
  QueueState state;
  state.windows = std::move(windows);
  state.models.assign(models, {kCost, 0, kFrames});
  return state;
}

QueueState Waiting(int count) {
  return State(std::vector<WaitingWindow>(static_cast<std::size_t>(count), Window()));
}

std::vector<std::size_t> BatchOf(const QueueState& state, int max_windows = 16) {
  return Decide(state, {max_windows}, kNow).batch;
}

std::vector<std::size_t> UpTo(std::size_t count) {
  std::vector<std::size_t> indices(count);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

TEST(DecideTest, EmptyQueueNeedsNoBatch) {
  const Decision decision = Decide(QueueState(), {16}, kNow);
  EXPECT_THAT(decision.batch, IsEmpty());
  EXPECT_THAT(decision.dropped, IsEmpty());
  EXPECT_EQ(decision.look_again, TimePoint::max());
}

TEST(DecideTest, DropsWindowsThatCannotMeetTheirDeadlineWithAReason) {
  const Decision late = Decide(State({Due(milliseconds(14))}), {16}, kNow);
  EXPECT_THAT(late.batch, IsEmpty());
  ASSERT_EQ(late.dropped.size(), 1u);
  EXPECT_THAT(late.dropped[0].reason,
              StatusIs(kDeadlineExceeded,
                       AllOf(HasSubstr("takes about 0.015"), HasSubstr("it was not started"))));
  EXPECT_THAT(BatchOf(State({Due(milliseconds(16))})), ElementsAre(0));
}

TEST(DecideTest, WithUnknownCostAWindowNeedsOnlyTimeForItsReply) {
  QueueState state = State({Due(milliseconds(1))});
  state.models[0].cost = {};
  EXPECT_THAT(BatchOf(state), ElementsAre(0));
  state.windows[0] = Due(milliseconds(-1));
  EXPECT_THAT(BatchOf(state), IsEmpty());
}

// One without a deadline whose result is wanted so long after now.
WaitingWindow WantedIn(milliseconds left) {
  WaitingWindow window = Window();
  window.due = kNow + left;
  return window;
}

// One of another client, which has had so many turns.
WaitingWindow Of(std::size_t client, std::int64_t turns = 0, int frames = kFrames) {
  WaitingWindow window = Window();
  window.client = client;
  window.client_turns = turns;
  window.frames = frames;
  return window;
}
WaitingWindow Waited(milliseconds time, milliseconds deadline) {
  WaitingWindow window = Window();
  window.queued_at = kNow - time;
  window.deadline = window.queued_at + deadline;
  return window;
}
WaitingWindow Both(milliseconds deadline, milliseconds due) {
  WaitingWindow window = Due(deadline);
  window.due = kNow + due;
  return window;
}

TEST(DecideTest, ChoosesAndOrdersWindows) {
  constexpr milliseconds kLater(100000);
  const WaitingWindow short_call = Window(), long_call = Window(Lane::kLong),
                      bulk = Window(Lane::kBulk), other_model = Window(Lane::kShort, 1);
  const WaitingWindow candidates = Of(0, 0, 3 * kFrames), heavy = Of(0, 0, 6 * kFrames);
  WaitingWindow quick = Due(milliseconds(12));
  quick.frames = kFrames / 4;
  const struct {
    const char* what;
    std::vector<WaitingWindow> windows;
    std::vector<std::size_t> batch;
    int max_windows = 16;
    std::vector<double> served_seconds = {0, 0};  // of each model
  } cases[] = {
      {"all that wait", {5, short_call}, {0, 1, 2, 3, 4}},
      {"at most a full batch", {5, short_call}, {0, 1, 2}, 3},
      {"a short window needs less time", {quick}, {0}},
      {"short calls before long ones", {bulk, long_call, short_call}, {2}},
      {"long calls before bulk", {bulk, long_call}, {1}},
      {"windows of one model", {short_call, other_model, short_call}, {0, 2}},
      {"the model that was served least", {short_call, other_model}, {1}, 16, {2, 1}},
      {"the other way round", {short_call, other_model}, {0}, 16, {2, 3}},
      {"lanes before models", {bulk, other_model}, {1}, 16, {0, 5}},
      {"the nearest deadline",
       {Due(milliseconds(500)), Due(milliseconds(300)), Due(milliseconds(400))},
       {1, 2},
       2},
      {"no deadline is like one a second after arrival",
       {short_call, Waited(milliseconds(100), milliseconds(999))},
       {1},
       1},
      {"and not like a later one",
       {short_call, Waited(milliseconds(100), milliseconds(1001))},
       {0},
       1},
      {"due soonest",
       {short_call, WantedIn(milliseconds(33)), WantedIn(milliseconds(20))},
       {2, 1},
       2},
      {"but after one that has waited for a second",
       {WantedIn(milliseconds(1)), Waited(seconds(1), kLater)},
       {1},
       1},
      {"the deadline, if it is before the due time",
       {WantedIn(milliseconds(400)), Both(milliseconds(300), milliseconds(500))},
       {1},
       1},
      {"otherwise the due time",
       {WantedIn(milliseconds(400)), Both(kLater, milliseconds(500))},
       {0},
       1},
      {"clients take turns", {Of(0), Of(0), Of(0), Of(0), Of(1), Of(1)}, {0, 4, 1}, 3},
      {"three of them", {Of(0), Of(0), Of(0), Of(0), Of(1), Of(2)}, {0, 4, 5}, 3},
      {"the client that had fewer turns first",
       {Of(0, 17), Of(0, 17), Of(1, 16), Of(1, 16)},
       {2, 0, 3, 1}},
      // Client 0 has had 3 turns after window 0, and 4 after window 1.
      {"a window takes as many turns as candidates",
       {candidates, Of(0), Of(1), Of(1), Of(1), Of(1)},
       {2, 3, 0, 4, 1, 5}},
      {"a short window takes a whole turn",
       {Of(0, 0, kFrames / 10), Of(0, 0, kFrames / 10), Of(0, 0, kFrames / 10), Of(1)},
       {0, 3, 1, 2}},
      {"candidates fill a batch", {4, heavy}, {0, 1}, 16},
      {"and a larger one", {4, heavy}, {0, 1, 2}, 18},
      {"more than a batch runs alone", {4, heavy}, {0}, 2},
      {"candidates do not join another client's window",
       {Of(0, 0, 16 * kFrames), Of(0, 0, 16 * kFrames), Of(1)},
       {2}},
  };
  for (const auto& one : cases) {
    QueueState state = State(one.windows, 2);
    for (const std::size_t model : {0, 1}) {
      state.models[model].served_seconds = one.served_seconds[model];
    }
    EXPECT_EQ(BatchOf(state, one.max_windows), one.batch) << one.what;
  }
}

TEST(DecideTest, LowerLaneRunsAfterSevenTimesItsFrames) {
  for (const Lane lane : {Lane::kLong, Lane::kBulk}) {
    QueueState state = State({Window(Lane::kShort), Window(lane), Window(lane)});
    int& overtaken = state.overtaken_frames[static_cast<std::size_t>(lane)];
    overtaken = 7 * 2 * kFrames - 1;
    EXPECT_THAT(BatchOf(state), ElementsAre(0));
    overtaken = 7 * 2 * kFrames;
    EXPECT_THAT(BatchOf(state), ElementsAre(1, 2));
  }
}

TEST(DecideTest, WindowThatMissesItsDueTimeIsStillEvaluated) {
  for (const milliseconds left : {milliseconds(1), milliseconds(0), milliseconds(-60000)}) {
    const Decision decision = Decide(State({WantedIn(left)}), {16}, kNow);
    EXPECT_THAT(decision.batch, ElementsAre(0)) << left.count() << " ms";
    EXPECT_THAT(decision.dropped, IsEmpty());
  }
}

TEST(DecideTest, MostUrgentWindowLimitsTheBatch) {
  // 10 ms and 5 ms a window: 12 take 70 ms, at 171 windows a second, 16 at 178.
  QueueState state = Waiting(15);
  state.windows.push_back(Due(milliseconds(71)));
  std::vector<std::size_t> batch = BatchOf(state);
  EXPECT_EQ(batch.size(), 12u);
  EXPECT_EQ(batch.front(), 15u);
}

TEST(DecideTest, UrgentWindowWaitsIfThroughputWouldFallByMoreThanAQuarter) {
  // One that can only go alone, at 67 windows a second: the 16 others go.
  QueueState state = Waiting(16);
  state.windows.insert(state.windows.begin(), Due(milliseconds(16)));
  std::vector<std::size_t> others = UpTo(17);
  others.erase(others.begin());
  EXPECT_THAT(BatchOf(state), ElementsAreArray(others));
  EXPECT_THAT(Decide(state, {16}, kNow).dropped, IsEmpty());
}

TEST(DecideTest, WindowsThatReplaceUrgentOnesMeetTheirDeadlines) {
  // The batch of the first 16 would take 90 ms; 6 of the others have that long, the longest does
  // not fit beside them.
  std::vector<WaitingWindow> windows(16, Due(milliseconds(16)));
  windows.resize(22, Due(milliseconds(91)));
  windows.resize(23, Window());
  windows.back().frames = 20 * kFrames;
  EXPECT_THAT(BatchOf(State(windows)), ElementsAre(16, 17, 18, 19, 20, 21));
}

TEST(DecideTest, OthersRunInASmallerBatchIfALargeOneIsTooLate) {
  // 16 take 90 ms, for which nobody has time; 8 take 50 ms.
  std::vector<WaitingWindow> windows(16, Due(milliseconds(55)));
  windows[0] = Due(milliseconds(16));
  EXPECT_THAT(BatchOf(State(windows)), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
}

TEST(DecideTest, LowerLaneBatchesAreShortWhileShortCallsArrive) {
  for (const Lane lane : {Lane::kLong, Lane::kBulk}) {
    QueueState state = State(std::vector<WaitingWindow>(16, Window(lane)));
    EXPECT_EQ(BatchOf(state).size(), 16u);
    state.last_short = kNow - milliseconds(999);
    // Three of 15 ms: 7 windows take 45 ms.
    EXPECT_THAT(BatchOf(state), ElementsAreArray(UpTo(7)));
    state.windows[1].frames *= 3;
    EXPECT_THAT(BatchOf(state), ElementsAreArray(UpTo(5)));
    state.last_short = kNow - seconds(1);
    EXPECT_EQ(BatchOf(state).size(), 14u) << "as many frames as 16 windows have";
  }
  QueueState state = Waiting(16);
  state.last_short = kNow;
  EXPECT_EQ(BatchOf(state).size(), 16u) << "batches of short calls are not";
}

TEST(DecideTest, FreeWorkersShareWaitingWindows) {
  QueueState state = Waiting(8);
  state.free_workers = 2;
  EXPECT_THAT(BatchOf(state), ElementsAre(0, 1, 2, 3));
  state.free_workers = 4;
  EXPECT_THAT(BatchOf(state), ElementsAre(0, 1));
  state = Waiting(5);
  state.windows[4].frames = 4 * kFrames;
  state.free_workers = 2;
  EXPECT_THAT(BatchOf(state), ElementsAre(0, 1, 2, 3)) << "frames, not windows";
}

TEST(DecideTest, LeavesAShareForAWorkerThatIsSoonFree) {
  QueueState state = Waiting(8);
  state.busy_until = {kNow - milliseconds(3)};
  EXPECT_THAT(BatchOf(state), ElementsAreArray(UpTo(4)));
  // 20 ms more, in which this worker takes four windows more than the other.
  state.busy_until = {kNow + milliseconds(20)};
  EXPECT_THAT(BatchOf(state), ElementsAreArray(UpTo(6)));
  state.busy_until = {kNow + seconds(1)};
  EXPECT_THAT(BatchOf(state), ElementsAreArray(UpTo(8)));
}

TEST(DecideTest, WindowsOfOtherModelsOccupyOtherWorkers) {
  QueueState state = Waiting(4);
  state.models.resize(2, {kCost, 1, kFrames});
  state.windows.resize(8, Window(Lane::kShort, 1));
  state.free_workers = 2;
  EXPECT_THAT(BatchOf(state), ElementsAre(0, 1, 2, 3));
}

// Two windows that came 10 and 5 ms ago while another worker is busy.
QueueState WithCompany() {
  QueueState state = Waiting(2);
  state.windows[0].queued_at = kNow - milliseconds(10);
  state.windows[1].queued_at = kNow - milliseconds(5);
  state.busy_until = {kNow + seconds(1)};
  return state;
}

const BatchLimits kPatient = {16, milliseconds(50)};

TEST(DecideTest, WaitsForMoreWindowsWhileWorkersAreBusy) {
  const Decision decision = Decide(WithCompany(), kPatient, kNow);
  EXPECT_THAT(decision.batch, IsEmpty());
  EXPECT_EQ(decision.look_again, kNow + milliseconds(40));
  EXPECT_THAT(Decide(WithCompany(), kPatient, kNow + milliseconds(39)).batch, IsEmpty());
  EXPECT_THAT(Decide(WithCompany(), kPatient, kNow + milliseconds(40)).batch, ElementsAre(0, 1));
}

TEST(DecideTest, WaitsForRecentClients) {
  QueueState state = WithCompany();
  state.busy_until.clear();
  state.last_company = kNow - milliseconds(45);
  EXPECT_EQ(Decide(state, kPatient, kNow).look_again, kNow + milliseconds(5));
  state.last_company = kNow - milliseconds(50);
  EXPECT_THAT(Decide(state, kPatient, kNow).batch, ElementsAre(0, 1));
}

TEST(DecideTest, StartsImmediatelyIfWaitingBringsNothing) {
  QueueState alone = WithCompany(), with_others = WithCompany(), with_candidates = WithCompany();
  alone.windows.resize(1);
  alone.busy_until.clear();
  EXPECT_THAT(Decide(alone, {16, seconds(1)}, kNow).batch, ElementsAre(0)) << "an idle server";
  EXPECT_THAT(Decide(WithCompany(), {2, milliseconds(50)}, kNow).batch, ElementsAre(0, 1))
      << "a full batch";
  for (WaitingWindow& window : with_candidates.windows) window.frames = 8 * kFrames;
  EXPECT_THAT(Decide(with_candidates, kPatient, kNow).batch, ElementsAre(0, 1)) << "likewise";
  with_others.windows.push_back(Window(Lane::kBulk));
  EXPECT_THAT(Decide(with_others, kPatient, kNow).batch, ElementsAre(0, 1)) << "another lane waits";
}

TEST(DecideTest, NeverWaitsPastADeadline) {
  QueueState state = WithCompany();
  // It must be done 30 ms from now, 35 ms after it came.
  state.windows[1].deadline = state.windows[1].queued_at + milliseconds(40);
  // The two take 20 ms.
  EXPECT_EQ(Decide(state, kPatient, kNow).look_again, kNow + milliseconds(10));
}

QueueState RandomState(std::mt19937& random) {
  const auto below = [&](int end) {
    return static_cast<int>(random() % static_cast<unsigned>(end));
  };
  QueueState state;
  for (int i = 0; i <= below(3); ++i) {
    state.models.push_back({{0.001 * below(20), 0.0001 * below(3)}, 0.1 * below(5), 46});
  }
  for (int i = below(40); i > 0; --i) {
    WaitingWindow window =
        Window(static_cast<Lane>(below(3)),
               static_cast<std::size_t>(below(static_cast<int>(state.models.size()))));
    window.frames = (2 + below(45)) * (below(3) == 0 ? 1 + below(16) : 1);
    window.client = static_cast<std::size_t>(below(3));
    window.client_turns = 10 * static_cast<int>(window.client);
    window.queued_at = kNow - milliseconds(below(3000));
    if (below(2) == 0) window.deadline = kNow + milliseconds(below(200) - 10);
    window.cancelled = below(10) == 0;
    state.windows.push_back(window);
  }
  for (int& frames : state.overtaken_frames) frames = below(3000);
  state.overtaken_frames[0] = 0;
  state.free_workers = 1 + below(3);
  for (int i = below(3); i > 0; --i) state.busy_until.push_back(kNow + milliseconds(below(50) - 5));
  if (below(2) == 0) state.last_company = kNow - milliseconds(below(20));
  if (below(2) == 0) state.last_short = kNow - milliseconds(below(2000));
  if (below(2) == 0) state.last_light = kNow - milliseconds(below(2000));
  state.heavy_batches = below(static_cast<int>(state.busy_until.size()) + 1);
  return state;
}

// What must hold of every decision.
void Check(const QueueState& state, const BatchLimits& limits, const Decision& decision) {
  const auto cost = [&](std::size_t i) { return state.models[state.windows[i].model].cost; };
  const auto left = [&](std::size_t i) {
    const WaitingWindow& window = state.windows[i];
    return common::SecondsBetween(kNow, window.deadline - (window.deadline - window.queued_at) / 8);
  };
  std::map<std::size_t, int> seen;
  for (const Decision::Drop& drop : decision.dropped) ++seen[drop.window];
  for (const std::size_t i : decision.batch) ++seen[i];
  for (const auto& [window, times] : seen) ASSERT_EQ(times, 1) << "window " << window;
  ASSERT_LE(static_cast<int>(decision.batch.size()), limits.max_windows);
  for (std::size_t i = 0; i < state.windows.size(); ++i) {
    const WaitingWindow& window = state.windows[i];
    const bool hopeless = window.deadline <= kNow || left(i) < cost(i).Seconds(window.frames);
    const bool dropped = std::any_of(decision.dropped.begin(), decision.dropped.end(),
                                     [&](const Decision::Drop& drop) { return drop.window == i; });
    ASSERT_EQ(dropped, window.cancelled || hopeless) << "window " << i;
  }
  int frames = 0;
  for (const std::size_t i : decision.batch) {
    ASSERT_EQ(state.windows[i].model, state.windows[decision.batch[0]].model);
    ASSERT_EQ(state.windows[i].lane, state.windows[decision.batch[0]].lane);
    frames += state.windows[i].frames;
  }
  for (const std::size_t i : decision.batch) {
    ASSERT_LE(cost(i).Seconds(frames), left(i));
    if (decision.batch.size() > 1) {
      ASSERT_LE(frames, limits.max_windows * state.models[state.windows[i].model].window_frames);
    }
  }
  // A worker rests only when nothing waits, or until a time to come.
  if (decision.batch.empty() && decision.dropped.size() < state.windows.size()) {
    ASSERT_GT(decision.look_again, kNow);
    ASSERT_LE(decision.look_again,
              std::max(kNow + limits.max_delay, state.last_light + seconds(1)));
  }
}

TEST(DecideTest, InvariantsHoldInRandomStates) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    SCOPED_TRACE("state " + std::to_string(i));
    const QueueState state = RandomState(random);
    const BatchLimits limits = {1 + static_cast<int>(random() % 20),
                                milliseconds(random() % 2 == 0 ? 0 : random() % 30)};
    Check(state, limits, Decide(state, limits, kNow));
    if (HasFatalFailure()) return;
  }
}

// Two workers, one of which evaluates a heavy window, while two heavy ones wait and light ones have
// come 400 ms ago.
QueueState BesideHeavy() {
  QueueState state = Waiting(2);
  for (WaitingWindow& window : state.windows) window.frames = 4 * kFrames;
  state.busy_until = {kNow + seconds(1)};
  state.heavy_batches = 1;
  state.last_light = kNow - milliseconds(400);
  return state;
}

TEST(DecideTest, HeavyWindowsLeaveAWorkerToLightOnes) {
  QueueState state = BesideHeavy();
  const Decision decision = Decide(state, {16}, kNow);
  EXPECT_THAT(decision.batch, IsEmpty());
  EXPECT_THAT(decision.dropped, IsEmpty());
  EXPECT_EQ(decision.look_again, kNow + milliseconds(600));
  state.windows.push_back(Window(Lane::kBulk));
  EXPECT_THAT(BatchOf(state), ElementsAre(2));
  state = BesideHeavy();
  state.last_light = kNow - seconds(1);
  EXPECT_THAT(BatchOf(state), ElementsAre(0, 1)) << "no light ones come";
}

TEST(DecideTest, HeavyWindowsDoNotDelayLightOnesInTheSameBatch) {
  std::vector<WaitingWindow> windows(5, Window());
  for (const std::size_t i : {1, 3}) windows[i].frames = 4 * kFrames;
  EXPECT_THAT(BatchOf(State(windows)), ElementsAre(0, 2, 4));
  windows[1].due = kNow;
  EXPECT_THAT(BatchOf(State(windows)), ElementsAre(1, 3)) << "the most urgent one determines it";
}

TEST(BatchCostTest, IsProportionalToFramesUntilSeveralSizesAreSeen) {
  BatchCost cost;
  for (int i = 0; i < 3; ++i) cost.Observe(40, 0.02, kNow);
  EXPECT_NEAR(cost.At(kNow).batch_seconds, 0, 1e-9);
  EXPECT_NEAR(cost.At(kNow).frame_seconds, 0.0005, 1e-9);
}

// What a model costs that takes 4 ms for a batch and 1 ms for each frame.
double TrueSeconds(int frames) { return 0.004 + 0.001 * frames; }

TEST(BatchCostTest, SeparatesBatchCostFromFrameCostBySeveralSizes) {
  BatchCost cost;
  for (int i = 0; i < 20; ++i) {
    const int frames = 10 + 30 * (i % 5);
    cost.Observe(frames, TrueSeconds(frames), kNow);
  }
  EXPECT_NEAR(cost.At(kNow).batch_seconds, 0.004, 0.001);
  for (const int frames : {10, 46, 130}) {
    EXPECT_NEAR(cost.At(kNow).Seconds(frames), TrueSeconds(frames), 0.05 * TrueSeconds(frames));
  }
}

TEST(BatchCostTest, FollowsAModelThatBecomesSlower) {
  BatchCost cost;
  for (int i = 0; i < 20; ++i) cost.Observe(40, 0.02, kNow);
  for (int i = 0; i < 20; ++i) cost.Observe(40, 0.06, kNow);
  EXPECT_NEAR(cost.At(kNow).Seconds(40), 0.06, 0.002);
}

TEST(BatchCostTest, OutlierCountsAtMostFourTimesTheEstimate) {
  BatchCost cost;
  for (int i = 0; i < 20; ++i) cost.Observe(40, 0.02, kNow);
  BatchCost paused = cost, slow = cost;
  paused.Observe(40, 10, kNow);
  slow.Observe(40, 4 * 0.02, kNow);
  EXPECT_NEAR(paused.At(kNow).Seconds(40), slow.At(kNow).Seconds(40), 1e-9);
  EXPECT_GT(paused.At(kNow).Seconds(40), 0.025);
}

TEST(BatchCostTest, NeitherPartIsEverNegative) {
  BatchCost falling, steep;
  for (int i = 0; i < 5; ++i) {
    falling.Observe(10, 0.02, kNow);
    falling.Observe(100, 0.01, kNow);
    steep.Observe(10, 0.001, kNow);
    steep.Observe(100, 0.1, kNow);
  }
  EXPECT_EQ(falling.At(kNow).frame_seconds, 0);
  EXPECT_GT(falling.At(kNow).batch_seconds, 0);
  EXPECT_NEAR(steep.At(kNow).batch_seconds, 0, 1e-9);
  EXPECT_GT(steep.At(kNow).frame_seconds, 0);
}

TEST(BatchCostTest, HalvesEachSecondWithoutABatch) {
  BatchCost cost;
  cost.Observe(40, 0.02, kNow);
  EXPECT_NEAR(cost.At(kNow).Seconds(40), 0.02, 1e-9);
  EXPECT_NEAR(cost.At(kNow + seconds(1)).Seconds(40), 0.01, 1e-9);
  EXPECT_NEAR(cost.At(kNow + seconds(3)).Seconds(40), 0.0025, 1e-9);
  EXPECT_NEAR(cost.At(kNow - milliseconds(5)).Seconds(40), 0.02, 1e-9);
  cost.Observe(40, 0.02, kNow + seconds(3));
  EXPECT_NEAR(cost.At(kNow + seconds(3)).Seconds(40), 0.02, 1e-9);
}

}  // namespace
}  // namespace duet::server::batching
