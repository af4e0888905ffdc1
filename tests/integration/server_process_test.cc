// The server as a process: flags, signals, exit codes, repositories.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/server/support/timed_context.h"
#include "tests/support/temporary_folder.h"

namespace duet::test {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;
using ::testing::HasSubstr;

// A running fake server and what it writes.
class Process {
 public:
  explicit Process(std::vector<std::string> flags) {
    int ends[2];
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    std::string program = DUET_FAKE_SERVER;
    std::vector<char*> argv = {program.data()};
    for (std::string& flag : flags) argv.push_back(flag.data());
    argv.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&pid_, program.c_str(), &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    output_ = fdopen(ends[0], "r");
  }
  ~Process() {
    if (!exited_) {
      kill(pid_, SIGKILL);
      Wait();
    }
    std::fclose(output_);
  }

  // Reads on until an event was logged; null when the process ended without it.
  json WaitForEvent(const std::string& event) {
    for (std::string line; ReadLine(&line);) {
      const json parsed = json::parse(line, nullptr, /*allow_exceptions=*/false);
      if (!parsed.is_object()) ++lines_without_json_;
      if (parsed.is_object() && parsed.value("event", "") == event) return parsed;
    }
    return nullptr;
  }
  // All output that has not been read yet.
  std::string Rest() {
    std::string rest;
    for (std::string line; ReadLine(&line);) rest += line;
    return rest;
  }
  // From now on the process waits once it is a page ahead of the test's reading.
  void ShrinkPipe() { EXPECT_GE(fcntl(fileno(output_), F_SETPIPE_SZ, 4096), 0); }
  pid_t pid() const { return pid_; }
  // Among those that WaitForEvent read.
  int lines_without_json() const { return lines_without_json_; }
  void Signal(int signal) { kill(pid_, signal); }
  // The exit code, or minus the signal that killed it.
  int Wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    exited_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  bool ReadLine(std::string* line) {
    char* text = nullptr;
    std::size_t capacity = 0;
    const ssize_t length = getline(&text, &capacity, output_);
    if (length > 0) line->assign(text, static_cast<std::size_t>(length));
    std::free(text);
    return length > 0;
  }

  pid_t pid_ = -1;
  bool exited_ = false;
  int lines_without_json_ = 0;
  std::FILE* output_ = nullptr;
};

std::vector<std::string> Flags(std::vector<std::string> more = {}) {
  std::vector<std::string> flags = {"--listen", "127.0.0.1:0", "--metrics-listen", "off"};
  flags.insert(flags.end(), more.begin(), more.end());
  return flags;
}

// Takes in no more than a small window of a reply before it is read: a long call whose reader waits
// stays under way, however fast the server is.
std::unique_ptr<v1::MotionSynthesis::Stub> Connect(const json& serving) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 65536);
  return v1::MotionSynthesis::NewStub(
      grpc::CreateCustomChannel(absl::StrCat("127.0.0.1:", serving["port"].get<int>()),
                                grpc::InsecureChannelCredentials(), arguments));
}

TEST(ServerProcessTest, ServesWithoutAnyModelFlagAndStopsOnSigterm) {
  Process server(Flags());
  const json serving = server.WaitForEvent("serving");
  ASSERT_FALSE(serving.is_null());
  EXPECT_TRUE(Call(*Connect(serving), SampleRequest()).status.ok());
  server.Signal(SIGTERM);
  EXPECT_FALSE(server.WaitForEvent("stopped").is_null());
  EXPECT_EQ(server.Wait(), 0);
}

TEST(ServerProcessTest, StopsOnSigintAsWell) {
  Process server(Flags());
  ASSERT_FALSE(server.WaitForEvent("serving").is_null());
  server.Signal(SIGINT);
  EXPECT_EQ(server.Wait(), 0);
}

// A call that is under way as long as its caller does not read: ten minutes at 60 Hz are 27 MB,
// far beyond what the connection buffers.
v1::SynthesizeRequest LongRequest() {
  v1::SynthesizeRequest request = SampleRequest(36000);
  request.mutable_leader()->set_frame_rate_hz(60);
  return request;
}

TEST(ServerProcessTest, SigtermLetsACallFinish) {
  Process server(Flags({"--grace-seconds", "120"}));
  const auto stub = Connect(server.WaitForEvent("serving"));
  TimedContext context;
  const auto reader = stub->Synthesize(&context, LongRequest());
  v1::SynthesizeResponse message;
  ASSERT_TRUE(reader->Read(&message));
  server.Signal(SIGTERM);
  EXPECT_EQ(server.WaitForEvent("draining")["calls"], 1);
  const Reply reply = ReadAll(*reader);
  EXPECT_TRUE(reply.status.ok()) << reply.status.error_message();
  EXPECT_EQ(server.WaitForEvent("stopped")["aborted_calls"], 0);
  EXPECT_EQ(server.Wait(), 0);
}

TEST(ServerProcessTest, ASecondSignalEndsTheGrace) {
  Process server(Flags({"--grace-seconds", "3600"}));
  const auto stub = Connect(server.WaitForEvent("serving"));
  TimedContext context;
  const auto reader = stub->Synthesize(&context, LongRequest());
  v1::SynthesizeResponse message;
  ASSERT_TRUE(reader->Read(&message));
  server.Signal(SIGTERM);
  EXPECT_EQ(server.WaitForEvent("draining")["calls"], 1);
  server.Signal(SIGTERM);
  EXPECT_EQ(server.WaitForEvent("stopped")["aborted_calls"], 1);
  EXPECT_EQ(server.Wait(), 0);
  EXPECT_FALSE(ReadAll(*reader).status.ok());
}

TEST(ServerProcessTest, ServesARepositoryPastABadCheckpoint) {
  TemporaryFolder folder;
  for (const auto& [place, manifest] :
       {std::pair{"sbu/1", "good"}, std::pair{"sbu/2", "bad"}, std::pair{"k3hi/7", "good"}}) {
    fs::create_directories(folder / place);
    WriteTestFile(folder / place / "manifest.json", manifest);
  }
  Process server(Flags({"--model-repository", folder.path().string(), "--default-model", "sbu",
                        "--version-label", "sbu:stable=1"}));
  EXPECT_EQ(server.WaitForEvent("model_refused")["source"], "sbu/2");
  const auto stub = Connect(server.WaitForEvent("serving"));
  TimedContext context;
  v1::ListModelsResponse list;
  ASSERT_TRUE(stub->ListModels(&context, v1::ListModelsRequest(), &list).ok());
  ASSERT_EQ(list.models_size(), 2);
  EXPECT_EQ(list.models(0).name(), "k3hi");
  EXPECT_EQ(list.models(1).name(), "sbu");
  EXPECT_TRUE(list.models(1).is_default());
  EXPECT_EQ(list.models(1).version_labels(0), "stable");
  server.Signal(SIGTERM);
  EXPECT_EQ(server.Wait(), 0);
}

TEST(ServerProcessTest, FailsWithoutAnythingToServe) {
  TemporaryFolder folder;
  Process server(Flags({"--model-repository", folder.path().string()}));
  EXPECT_THAT(server.WaitForEvent("cannot_serve").value("message", ""),
              HasSubstr("no model could be loaded"));
  EXPECT_EQ(server.Wait(), 1);
}

TEST(ServerProcessTest, FailsOnARepositoryThatIsNotThere) {
  Process server(Flags({"--model-repository", "/nonexistent/models"}));
  EXPECT_THAT(server.WaitForEvent("cannot_serve").value("message", ""),
              HasSubstr("/nonexistent/models"));
  EXPECT_EQ(server.Wait(), 1);
}

TEST(ServerProcessTest, FailsOnAPortInUse) {
  Process first(Flags());
  const int port = first.WaitForEvent("serving")["port"];
  Process second({"--listen", absl::StrCat("127.0.0.1:", port), "--metrics-listen", "off"});
  EXPECT_THAT(second.WaitForEvent("cannot_serve").value("message", ""),
              HasSubstr(absl::StrCat("127.0.0.1:", port)));
  EXPECT_EQ(second.Wait(), 1);
}

TEST(ServerProcessTest, SigtermWhileLoadingStopsAfterTheCheckpointUnderWay) {
  TemporaryFolder folder;
  fs::create_directories(folder / "a/1");
  fs::create_directories(folder / "b/1");
  // Reading it waits until this test has opened and closed it.
  ASSERT_EQ(mkfifo((folder / "a/1/manifest.json").c_str(), 0600), 0);
  WriteTestFile(folder / "b/1/manifest.json", "good");
  Process server(Flags({"--model-repository", folder.path().string()}));
  const int manifest = open((folder / "a/1/manifest.json").c_str(), O_WRONLY);
  ASSERT_GE(manifest, 0);
  server.Signal(SIGTERM);
  close(manifest);
  EXPECT_EQ(server.Wait(), 0);
  EXPECT_THAT(server.Rest(), testing::Not(HasSubstr("model_loaded")));
}

// The most memory that a process has held, in bytes.
long PeakBytes(pid_t pid) {
  std::ifstream status(absl::StrCat("/proc/", pid, "/status"));
  for (std::string word; status >> word;) {
    long kilobytes = 0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024;
  }
  return 0;
}

TEST(ServerProcessTest, EveryLineOfOutputIsJson) {
  Process server(Flags());
  const json serving = server.WaitForEvent("serving");
  TimedContext context;
  context.set_compression_algorithm(GRPC_COMPRESS_GZIP);  // gRPC logs its refusal
  EXPECT_FALSE(Call(*Connect(serving), SampleRequest(), context).status.ok());
  v1::SynthesizeRequest request;
  request.mutable_model()->set_name("\xff\xfe");  // Protobuf logs what it cannot read
  EXPECT_FALSE(Call(*Connect(serving), request).status.ok());
  EXPECT_EQ(server.WaitForEvent("library").value("library", ""), "grpc");
  EXPECT_EQ(server.WaitForEvent("library").value("library", ""), "protobuf");
  server.Signal(SIGTERM);
  EXPECT_EQ(server.Wait(), 0);
  EXPECT_EQ(server.lines_without_json(), 0);
}

TEST(ServerProcessTest, ALogThatNobodyReadsHoldsUpNoCall) {
  Process server(Flags());
  const auto stub = Connect(server.WaitForEvent("serving"));
  server.ShrinkPipe();  // to a dozen of the lines below
  constexpr int kCalls = 400;
  for (int i = 0; i < kCalls; ++i) {
    TimedContext context;
    v1::ListModelsResponse response;
    ASSERT_TRUE(stub->ListModels(&context, v1::ListModelsRequest(), &response).ok()) << i;
  }
  server.Signal(SIGTERM);
  // The lines that waited all come, the last one too.
  for (int i = 0; i < kCalls; ++i) ASSERT_FALSE(server.WaitForEvent("call").is_null()) << i;
  EXPECT_FALSE(server.WaitForEvent("stopped").is_null());
  EXPECT_EQ(server.Wait(), 0);
}

TEST(ServerProcessTest, AGiantMessageIsRefusedInLittleMemory) {
  constexpr long kMegabyte = 1 << 20;
  Process server(Flags({"--max-request-bytes", "1048576", "--max-transport-bytes", "16777216"}));
  const auto stub = Connect(server.WaitForEvent("serving"));
  v1::SynthesizeRequest request;
  request.mutable_leader()->mutable_positions()->Resize(static_cast<int>(40 * kMegabyte), 0);
  EXPECT_EQ(Call(*stub, request).status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_GT(PeakBytes(server.pid()), kMegabyte);
  EXPECT_LT(PeakBytes(server.pid()), 100 * kMegabyte) << "the message has 160 MB";
  EXPECT_TRUE(Call(*stub, SampleRequest()).status.ok()) << "others are answered";
}

TEST(ServerProcessTest, AWrongFlagIsNamedAndIsAUsageError) {
  Process server({"--workers", "0"});
  EXPECT_THAT(server.Rest(), HasSubstr("duet-server: workers: is 0, wanted 1 to 1024"));
  EXPECT_EQ(server.Wait(), 2);
}

TEST(ServerProcessTest, HelpIsPrinted) {
  Process server({"--help"});
  EXPECT_THAT(server.Rest(), HasSubstr("--model-repository"));
  EXPECT_EQ(server.Wait(), 0);
}

}  // namespace
}  // namespace duet::test
