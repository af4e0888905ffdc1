// The server as a process, one of whose threads never returns.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "tests/integration/server_process.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::test {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;

// A call that asks the fake engine to block a thread for ever (fake_server.cc); nobody waits for
// its answer.
class BlockingCall {
 public:
  BlockingCall(const json& serving, const std::string& interaction_class)
      : stub_(Connect(serving)) {
    v1::SynthesizeRequest request = SampleRequest();
    request.mutable_label_vector()->clear_weights();
    v1::ClassWeight* weight = request.mutable_label_vector()->add_weights();
    weight->set_interaction_class(interaction_class);
    weight->set_weight(-2);
    reader_ = stub_->Synthesize(&context_, request);
  }
  ~BlockingCall() {
    context_.TryCancel();
    reader_->Finish();
  }

 private:
  TimedContext context_;
  std::unique_ptr<v1::MotionSynthesis::Stub> stub_;
  std::unique_ptr<grpc::ClientReader<v1::SynthesizeResponse>> reader_;
};

// The fake model keeps every worker; further windows wait.
TEST(StuckThreadTest, WorkersThatNeverReturnEndTheProcess) {
  Process server(
      Flags({"--workers", "1", "--self-check-seconds", "0.1", "--watchdog-seconds", "15"}));
  const json serving = server.WaitForEvent("serving");
  const BlockingCall call(serving, "kick");
  // A second call that came before would be in the same batch, and no window would wait.
  ASSERT_FALSE(server.WaitForEvent("blocking").is_null());
  const BlockingCall behind(serving, "kick");
  EXPECT_THAT(server.WaitForEvent("self_check_failed").value("message", ""),
              HasSubstr("no worker finishes a batch"));
  EXPECT_EQ(server.WaitForEvent("stuck")["exit_code"], 3);
  EXPECT_EQ(server.Wait(), 3);
}

// gRPC's own threads hang, and soon one that holds a lock of the server.
TEST(StuckThreadTest, CallbacksThatNeverReturnTurnReadinessAndEndTheProcess) {
  Process server({"--listen", "127.0.0.1:0", "--metrics-listen", "127.0.0.1:0",
                  "--self-check-seconds", "0.1", "--watchdog-seconds", "15"});
  const json serving = server.WaitForEvent("serving");
  const int metrics_port = serving["metrics_port"];
  EXPECT_THAT(HttpGet(metrics_port, "/readyz"), StartsWith("HTTP/1.1 200"));
  const BlockingCall first(serving, "push");
  std::vector<std::unique_ptr<BlockingCall>> calls;
  // Each blocks one more of gRPC's threads.
  for (std::string page; !absl::StartsWith(page, "HTTP/1.1 503");) {
    page = HttpGet(metrics_port, "/readyz");
    ASSERT_FALSE(page.empty()) << "the process ended";
    if (calls.size() < 64) calls.push_back(std::make_unique<BlockingCall>(serving, "push"));
  }
  EXPECT_THAT(server.WaitForEvent("self_check_failed").value("message", ""),
              HasSubstr("does not answer"));
  EXPECT_EQ(server.Wait(), 3);
}

TEST(StuckThreadTest, SigtermEndsTheProcessThoughAWorkerNeverReturns) {
  Process server(Flags({"--watchdog-seconds", "0", "--grace-seconds", "0.1"}));
  const BlockingCall call(server.WaitForEvent("serving"), "kick");
  ASSERT_FALSE(server.WaitForEvent("blocking").is_null());
  server.Signal(SIGTERM);
  EXPECT_EQ(server.WaitForEvent("stopped")["aborted_calls"], 1);
  EXPECT_EQ(server.WaitForEvent("stopped_late")["exit_code"], 4);
  EXPECT_EQ(server.Wait(), 4);
}

// The main thread blocks as soon as it heeds the signal, and holds a lock.
TEST(StuckThreadTest, ASecondSignalIsHeardThoughTheMainThreadHangs) {
  Process server(Flags({"--watchdog-seconds", "0", "--grace-seconds", "3600"}));
  const json serving = server.WaitForEvent("serving");
  // After it logged this, the main thread lists the models once more. A call before that would
  // block it there instead of while it drains. It handles a reload only afterwards.
  server.Signal(SIGHUP);
  ASSERT_FALSE(server.WaitForEvent("reloaded").is_null());
  const BlockingCall call(serving, "hug");
  ASSERT_FALSE(server.WaitForEvent("call").is_null());
  server.Signal(SIGTERM);
  ASSERT_FALSE(server.WaitForEvent("blocking").is_null());
  server.Signal(SIGTERM);
  EXPECT_FALSE(server.WaitForEvent("stopped_late").is_null());
  EXPECT_EQ(server.Wait(), 4);
}

TEST(StuckThreadTest, SigtermEndsTheProcessThoughLoadingNeverReturns) {
  TemporaryFolder folder;
  fs::create_directories(folder / "a/1");
  ASSERT_EQ(mkfifo((folder / "a/1/manifest.json").c_str(), 0600), 0);
  Process server(Flags({"--model-repository", folder.path().string()}));
  // Held open and never written.
  const int manifest = open((folder / "a/1/manifest.json").c_str(), O_WRONLY);
  ASSERT_GE(manifest, 0);
  server.Signal(SIGTERM);
  EXPECT_FALSE(server.WaitForEvent("stopped_late").is_null());
  EXPECT_EQ(server.Wait(), 4);
  close(manifest);
}

}  // namespace
}  // namespace duet::test
