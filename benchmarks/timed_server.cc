// duet-server with an engine of known cost: it keeps a core busy for 1 ms a batch and 0.7 ms for
// each window of 45 frames. Shows what batching gains and costs, whatever the engine of the day.

#include <time.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "server/lifecycle/run_server.h"
#include "tests/support/fake_synthesizer.h"

namespace {

using duet::engine::Synthesizer;

constexpr double kBatchSeconds = 0.001;
constexpr double kFrameSeconds = 0.0007 / 45;

double ThreadSeconds() {
  timespec now = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void KeepBusy(absl::Span<const duet::engine::SynthesisWindow* const> windows) {
  double end = ThreadSeconds() + kBatchSeconds;
  for (const duet::engine::SynthesisWindow* window : windows) {
    end += kFrameSeconds * window->leader.frame_count();
  }
  while (ThreadSeconds() < end) {
  }
}

}  // namespace

int main(int argc, char** argv) {
  auto* const stop = new duet::server::watchdog::StopSignal;  // see RunServer
  using duet::server::lifecycle::ModelSource;
  const ModelSource source{
      "timed",
      [](const std::filesystem::path&) {
        return absl::UnimplementedError("this engine has no checkpoints");
      },
      [] {
        auto model = std::make_shared<duet::test::FakeSynthesizer>();
        model->on_batch = KeepBusy;
        return std::vector<std::shared_ptr<const Synthesizer>>{std::move(model)};
      }};
  return duet::server::lifecycle::RunServer(
      argc, argv, [&](const auto&) -> absl::StatusOr<ModelSource> { return source; }, *stop,
      std::make_shared<duet::server::metrics::StreamLogSink>(stderr));
}
