// duet-server with a fake engine, for tests of the process as a whole. A checkpoint folder whose
// manifest.json begins with "good" loads; anything else is refused.
//
// A weight of -1 makes the engine fail as engines may, that window alone or all of its batch:
//   kick  it throws           hug          it says that it failed
//   push  its answer is NaN   shake_hands  it takes until nobody wants the answer any more
//
// A weight of -2 blocks threads for ever, each with a line of the event "blocking" in the log:
//   kick  the worker that evaluates the window
//   push  from then on any thread of gRPC that asks for a model's description
//   hug   from then on the main thread when it does, which it does to update the health service,
//         under a lock of the server

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "server/lifecycle/run_server.h"
#include "tests/support/fake_synthesizer.h"

namespace {

using duet::engine::Synthesizer;

enum Class { kKick, kPush, kShakeHands, kHug };  // as FakeDescription has them

std::atomic<bool> grpc_blocks{false};
std::atomic<bool> main_blocks{false};

[[noreturn]] void BlockForEver() {
  std::fputs("{\"event\":\"blocking\"}\n", stderr);
  while (true) pause();
}

// gRPC names its threads; the others have the program's name.
bool IsOfGrpc() {
  char name[16] = "";
  pthread_getname_np(pthread_self(), name, sizeof(name));
  return std::string_view(name).substr(0, 4) != "duet";
}

class Model final : public duet::test::FakeSynthesizer {
 public:
  using FakeSynthesizer::FakeSynthesizer;
  const duet::engine::ModelDescription& description() const override {
    if (grpc_blocks && IsOfGrpc()) BlockForEver();
    if (main_blocks && gettid() == getpid()) BlockForEver();
    return FakeSynthesizer::description();
  }
};

absl::Status FailAsAsked(const duet::engine::SynthesisWindow& window) {
  const auto is_asked = [&window](Class one) { return window.labels[one] == -1; };
  if (is_asked(kKick)) throw std::runtime_error("out of luck");
  const auto is_to_block = [&window](Class one) { return window.labels[one] == -2; };
  if (is_to_block(kKick)) BlockForEver();
  if (is_to_block(kPush)) grpc_blocks = true;
  if (is_to_block(kHug)) main_blocks = true;
  if (is_asked(kHug)) return absl::InternalError("out of order");
  while (is_asked(kShakeHands) && window.cancelled != nullptr && !*window.cancelled) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return absl::OkStatus();
}

std::shared_ptr<const Synthesizer> MakeSynthesizer(duet::engine::ModelDescription description) {
  auto model = std::make_shared<Model>(std::move(description));
  model->window_status = FailAsAsked;
  model->answer = [](duet::motion::Vec3 leader, absl::Span<const float> labels) {
    if (labels[kPush] == -1) leader.x = std::numeric_limits<float>::quiet_NaN();
    return duet::test::FakeAnswer(leader, labels);
  };
  return model;
}

absl::StatusOr<std::shared_ptr<const Synthesizer>> LoadFolder(const std::filesystem::path& folder) {
  std::string word;
  std::ifstream(folder / "manifest.json") >> word;
  if (word != "good") return absl::InvalidArgumentError("the manifest is not good");
  duet::engine::ModelDescription description = duet::test::FakeDescription();
  description.name = folder.parent_path().filename().string();
  description.version = std::stoi(folder.filename().string());
  return MakeSynthesizer(std::move(description));
}

}  // namespace

int main(int argc, char** argv) {
  // Never deleted (see RunServer); static, so that LeakSanitizer still finds it.
  static auto* const stop = new duet::server::lifecycle::StopSignal;
  const duet::server::lifecycle::ModelSource source{
      "fake", LoadFolder, [] {
        return std::vector<std::shared_ptr<const Synthesizer>>{
            MakeSynthesizer(duet::test::FakeDescription())};
      }};
  return duet::server::lifecycle::RunServer(
      argc, argv,
      [&](const auto&) -> absl::StatusOr<duet::server::lifecycle::ModelSource> { return source; },
      *stop, std::make_shared<duet::server::metrics::StreamLogSink>(stderr));
}
