// The server as a process: flags, signals, exit codes, repositories.

#include "tests/integration/server_process.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "model/base/sha256.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::test {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;

TEST(ServerProcessTest, ServesWithoutAnyModelFlagAndStopsOnSigterm) {
  Process server(Flags());
  const json serving = server.WaitForEvent("serving");
  ASSERT_FALSE(serving.is_null());
  EXPECT_TRUE(Call(*Connect(serving), SampleRequest()).status.ok());
  server.Signal(SIGTERM);
  EXPECT_FALSE(server.WaitForEvent("stopped").is_null());
  EXPECT_EQ(server.Wait(), 0);
}

TEST(ServerProcessTest, StopsDuringASelfCheck) {
  for (int i = 0; i < 10; ++i) {
    Process server(Flags({"--self-check-seconds", "0.001"}));
    ASSERT_FALSE(server.WaitForEvent("serving").is_null());
    server.Signal(SIGTERM);
    EXPECT_EQ(server.Wait(), 0);
  }
}

// A call that is under way as long as its caller does not read: ten minutes at 60 Hz are 27 MB,
// far beyond what the connection buffers.
v1::SynthesizeRequest LongRequest() {
  v1::SynthesizeRequest request = SampleRequest(36000);
  request.mutable_leader()->set_frame_rate_hz(60);
  return request;
}

// Such a call, begun: its first message has come.
class LongCall {
 public:
  explicit LongCall(const nlohmann::json& serving)
      : stub_(Connect(serving)), reader_(stub_->Synthesize(&context_, LongRequest())) {
    v1::SynthesizeResponse message;
    EXPECT_TRUE(reader_->Read(&message));
  }
  Reply Finish() { return ReadAll(*reader_); }

 private:
  TimedContext context_;
  std::unique_ptr<v1::MotionSynthesis::Stub> stub_;
  std::unique_ptr<grpc::ClientReader<v1::SynthesizeResponse>> reader_;
};

TEST(ServerProcessTest, SigtermLetsACallFinish) {
  Process server(Flags({"--grace-seconds", "120"}));
  LongCall call(server.WaitForEvent("serving"));
  server.Signal(SIGTERM);
  EXPECT_EQ(server.WaitForEvent("draining")["calls"], 1);
  const Reply reply = call.Finish();
  EXPECT_TRUE(reply.status.ok()) << reply.status.error_message();
  EXPECT_EQ(server.WaitForEvent("stopped")["aborted_calls"], 0);
  EXPECT_EQ(server.Wait(), 0);
}

TEST(ServerProcessTest, ASecondSignalEndsTheGrace) {
  Process server(Flags({"--grace-seconds", "3600"}));
  LongCall call(server.WaitForEvent("serving"));
  server.Signal(SIGTERM);
  EXPECT_EQ(server.WaitForEvent("draining")["calls"], 1);
  server.Signal(SIGTERM);
  EXPECT_EQ(server.WaitForEvent("stopped")["aborted_calls"], 1);
  EXPECT_EQ(server.Wait(), 0);
  EXPECT_FALSE(call.Finish().status.ok());
}

// "name/version+label+label" of each model that is served.
std::vector<std::string> ListModels(v1::MotionSynthesis::Stub& stub) {
  TimedContext context;
  v1::ListModelsResponse list;
  EXPECT_TRUE(stub.ListModels(&context, v1::ListModelsRequest(), &list).ok());
  std::vector<std::string> models;
  for (const v1::Model& model : list.models()) {
    models.push_back(absl::StrCat(model.name(), "/", model.version()));
    for (const std::string& label : model.version_labels()) models.back() += "+" + label;
  }
  return models;
}

void WriteCheckpoint(const TemporaryFolder& folder, const std::string& place,
                     const std::string& manifest = "good") {
  fs::create_directories(folder / place);
  WriteTestFile(folder / "next", manifest);
  fs::rename(folder / "next", folder / (place + "/manifest.json"));
}

TEST(ServerProcessTest, SighupReadsTheRepositoryAgain) {
  TemporaryFolder folder;
  WriteCheckpoint(folder, "sbu/1");
  Process server(Flags({"--model-repository", folder.path().string()}));
  const auto stub = Connect(server.WaitForEvent("serving"));
  WriteCheckpoint(folder, "sbu/2");
  WriteCheckpoint(folder, "sbu/1", "bad");
  server.Signal(SIGHUP);
  const json refused = server.WaitForEvent("model_refused");
  EXPECT_EQ(refused["source"], "sbu/1");
  EXPECT_EQ(refused["still_served"], true);
  const json reloaded = server.WaitForEvent("reloaded");
  EXPECT_EQ(reloaded["loaded"], json({"sbu/2"}));
  EXPECT_EQ(reloaded["refused"], json({"sbu/1"}));
  EXPECT_THAT(ListModels(*stub), ElementsAre("sbu/2", "sbu/1"));
  server.Signal(SIGTERM);
  EXPECT_EQ(server.Wait(), 0);
}

TEST(ServerProcessTest, SighupReadsLabelsFromTheConfigurationFile) {
  TemporaryFolder folder;
  TemporaryFolder settings;
  const std::string file = (settings / "duet.txtpb").string();
  const auto write = [&](const std::string& stable, const std::string& more) {
    WriteTestFile(file,
                  absl::StrCat("model_repository: \"", folder.path().string(),
                               "\"\nversion_labels { model: \"sbu\" label: \"stable\" version: ",
                               stable, " }\n", more));
  };
  WriteCheckpoint(folder, "sbu/1");
  WriteCheckpoint(folder, "sbu/2");
  write("1", "version_labels { model: \"sbu\" label: \"old\" version: 1 }");
  Process server(Flags({"--config", file}));
  const auto stub = Connect(server.WaitForEvent("serving"));
  EXPECT_THAT(ListModels(*stub), ElementsAre("sbu/2", "sbu/1+old+stable"));
  write("2", "");
  server.Signal(SIGHUP);
  EXPECT_FALSE(server.WaitForEvent("reloaded").is_null());
  EXPECT_THAT(ListModels(*stub), ElementsAre("sbu/2+stable", "sbu/1"));
  write("1", "max_call: 7");
  server.Signal(SIGHUP);
  EXPECT_THAT(server.WaitForEvent("reload_problem").value("message", ""),
              AllOf(HasSubstr("configuration: "), HasSubstr("duet.txtpb: line 3:9:"),
                    HasSubstr("max_call")));
  EXPECT_FALSE(server.WaitForEvent("reloaded").is_null());
  EXPECT_THAT(ListModels(*stub), ElementsAre("sbu/2+stable", "sbu/1")) << "as it was";
}

// What a service manager hears.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path)
      : descriptor_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(bind(descriptor_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  }
  ~NotifySocket() { close(descriptor_); }
  std::string Receive() {
    char text[4096];
    const ssize_t length = recv(descriptor_, text, sizeof(text), 0);
    return length < 0 ? "" : std::string(text, static_cast<std::size_t>(length));
  }

 private:
  const int descriptor_;
};

TEST(ServerProcessTest, ReportsItsStateToSystemd) {
  TemporaryFolder folder;
  NotifySocket socket((folder / "notify").string());
  setenv("NOTIFY_SOCKET", (folder / "notify").c_str(), 1);
  Process server(Flags());
  unsetenv("NOTIFY_SOCKET");
  EXPECT_EQ(socket.Receive(), "READY=1\nSTATUS=serving 1 models");
  server.Signal(SIGHUP);
  EXPECT_THAT(socket.Receive(), MatchesRegex("RELOADING=1\nMONOTONIC_USEC=[0-9]+"));
  EXPECT_EQ(socket.Receive(), "READY=1\nSTATUS=serving 1 models");
  server.Signal(SIGTERM);
  EXPECT_EQ(socket.Receive(), "STOPPING=1");
  EXPECT_EQ(server.Wait(), 0);
}

TEST(ServerProcessTest, CheckConfigLoadsEverythingAndLeaves) {
  TemporaryFolder folder;
  WriteCheckpoint(folder, "sbu/1");
  const std::string repository = folder.path().string();
  {
    Process server(Flags({"--check-config", "--model-repository", repository}));
    EXPECT_EQ(server.Rest(), "ok: sbu/1\n");
    EXPECT_EQ(server.Wait(), 0);
  }
  WriteCheckpoint(folder, "sbu/2", "bad");
  WriteCheckpoint(folder, "sbu/latest");
  Process server(Flags(
      {"--check-config", "--model-repository", repository, "--version-label", "sub:stable=1"}));
  EXPECT_THAT(
      server.Rest(),
      AllOf(HasSubstr("wrong: sbu/latest: skipped: expected a version"),
            HasSubstr("wrong: sbu/2: the manifest is not good\n"), HasSubstr("ok: sbu/1\n"),
            HasSubstr("wrong: version_labels[0].model: expected one of: sbu, got \"sub\"")));
  EXPECT_EQ(server.Wait(), 1);
}

// What a start writes for these flags, and its exit code; the same of --check-config.
std::pair<std::string, int> Start(std::vector<std::string> flags) {
  Process server(std::move(flags));
  std::string output = server.Rest();
  return {output, server.Wait()};
}
std::pair<std::string, int> Check(std::vector<std::string> flags) {
  flags.emplace_back("--check-config");
  return Start(std::move(flags));
}

TEST(ServerProcessTest, CheckConfigAndTheStartReportTheSameMistakesAllAtOnce) {
  TemporaryFolder folder;
  WriteTestFile(folder / "access", "# nobody\n");
  const std::vector<std::string> flags = {"--listen",         "127.0.0.1:7",
                                          "--metrics-listen", "127.0.0.1:7",
                                          "--admin-listen",   "nowhere.invalid:9",
                                          "--access-file",    (folder / "access").string(),
                                          "--client-key",     "X",
                                          "--workers",        "two",
                                          "--max-calls",      "0"};
  const auto all =
      AllOf(HasSubstr(": --workers: expected a whole number of 0 or more, got \"two\"\n"),
            HasSubstr(": max_calls: expected 1 to 100000, got 0 (command line)\n"),
            HasSubstr(": client_key: expected lower-case letters"),
            HasSubstr(": metrics_listen: expected another port than listen, got 127.0.0.1:7"),
            HasSubstr(": expected at least one caller, got none; "),
            HasSubstr(": admin_listen: expected a host name that resolves, or an IP address, got "
                      "\"nowhere.invalid\""));
  const auto [checked, check_code] = Check(flags);
  EXPECT_THAT(checked, AllOf(all, HasSubstr("ok: embedded/"))) << "models are loaded as well";
  EXPECT_EQ(check_code, 2);
  const auto [started, start_code] = Start(flags);
  EXPECT_THAT(started, all);
  EXPECT_EQ(start_code, 2);
}

TEST(ServerProcessTest, WhatSettingsNameIsCheckedBeforeTheStartAndLogged) {
  TemporaryFolder folder;
  WriteTestFile(folder / "access", "a synthesise cert:a.example\n");
  const std::vector<std::string> flags =
      Flags({"--access-file", (folder / "access").string(), "--admin-listen", "203.0.113.5:1"});
  const auto [checked, check_code] = Check(flags);
  EXPECT_THAT(checked, AllOf(HasSubstr("expected no cert: without tls_client_ca_file"),
                             HasSubstr("admin_listen: expected an address of this machine and")));
  EXPECT_EQ(check_code, 1);
  Process server(flags);
  EXPECT_THAT(server.WaitForEvent("cannot_serve").value("message", ""),
              HasSubstr("expected no cert: without tls_client_ca_file"));
  EXPECT_THAT(server.WaitForEvent("cannot_serve").value("message", ""),
              AllOf(HasSubstr("admin_listen: expected an address of this machine"),
                    HasSubstr("got 203.0.113.5:1 (")));
  EXPECT_EQ(server.Wait(), 1);
}

TEST(ServerProcessTest, CheckConfigMayRunBesideTheServerThatItIsFor) {
  Process server(Flags());
  const std::string address =
      absl::StrCat("127.0.0.1:", server.WaitForEvent("serving")["port"].get<int>());
  const std::vector<std::string> flags = {"--listen", address, "--metrics-listen", "off"};
  EXPECT_EQ(Check(flags), std::make_pair(std::string("ok: embedded/fake/1\n"), 0));
  const auto [started, code] = Start(flags);
  EXPECT_THAT(started, AllOf(HasSubstr("listen: expected a free port, got " + address),
                             HasSubstr("which is in use")));
  EXPECT_EQ(code, 1);
}

TEST(ServerProcessTest, AnAccessFileThatIsTruncatedLeavesTheOldOneAndShowsEverywhere) {
  TemporaryFolder folder;
  const std::string line = absl::StrCat("studio synthesise sha256:", base::Sha256Hex("good"), "\n");
  WriteTestFile(folder / "access", line);
  Process server({"--listen", "127.0.0.1:0", "--metrics-listen", "127.0.0.1:0", "--access-file",
                  (folder / "access").string()});
  const json serving = server.WaitForEvent("serving");
  const auto get = [&](const char* page) { return HttpGet(serving["metrics_port"], page); };
  const auto code = [stub = Connect(serving)] {
    TimedContext context;
    context.AddMetadata("authorization", "Bearer good");
    return Call(*stub, SampleRequest(), context).status.error_code();
  };
  WriteTestFile(folder / "access", "");
  EXPECT_THAT(server.WaitForEvent("secrets_refused").value("message", ""),
              HasSubstr("expected at least one caller, got none"));
  EXPECT_EQ(code(), grpc::StatusCode::OK);
  EXPECT_THAT(get("/metrics"), HasSubstr("duet_secrets_last_reload_successful{kind=\"access\"} 0"));
  for (int i = 0; i < 2; ++i) {
    server.Signal(SIGHUP);
    EXPECT_THAT(server.WaitForEvent("reload_problem").value("message", ""),
                HasSubstr("expected at least one caller, got none"))
        << "each time";
  }
  WriteTestFile(folder / "access", line);
  EXPECT_EQ(server.WaitForEvent("secrets_reloaded").value("kind", ""), "access");
  EXPECT_THAT(get("/metrics"), HasSubstr("duet_secrets_last_reload_successful{kind=\"access\"} 1"));
  EXPECT_EQ(code(), grpc::StatusCode::OK);
}

// Whether no signal waits for the process and all of its threads sleep, so that what a signal began
// is done.
bool HasHandledSignals(pid_t pid) {
  const fs::path folder = absl::StrCat("/proc/", pid);
  std::ifstream status(folder / "status");
  for (std::string word, mask; status >> word;) {
    if (word == "ShdPnd:" && status >> mask &&
        absl::string_view(mask).find_first_not_of('0') != absl::string_view::npos)
      return false;
  }
  for (const fs::directory_entry& thread : fs::directory_iterator(folder / "task")) {
    std::ifstream stat(thread.path() / "stat");
    std::string line;
    // "PID (NAME) STATE ..."
    if (!std::getline(stat, line) || line.substr(line.rfind(')') + 2, 1) != "S") return false;
  }
  return true;
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
  while (!HasHandledSignals(server.pid()))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  close(manifest);
  EXPECT_EQ(server.Wait(), 0);
  EXPECT_THAT(server.Rest(), Not(HasSubstr("model_loaded")));
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

TEST(ServerProcessTest, ALogWhoseReaderIsGoneHoldsUpNoCall) {
  Process server({"--listen", "127.0.0.1:0", "--metrics-listen", "127.0.0.1:0"});
  const json serving = server.WaitForEvent("serving");
  server.StopReading();
  const auto stub = Connect(serving);
  const std::string nothing_lost = "duet_log_lines_dropped_total 0\n";
  do {
    ASSERT_TRUE(Call(*stub, SampleRequest()).status.ok());
  } while (absl::StrContains(HttpGet(serving["metrics_port"], "/metrics"), nothing_lost));
  server.Signal(SIGTERM);
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
  // A sanitized server takes 110 MB by itself, so a bound of 200 MB still excludes the message.
  EXPECT_LT(PeakBytes(server.pid()), (kSanitized ? 200 : 100) * kMegabyte)
      << "the message has 160 MB";
  EXPECT_TRUE(Call(*stub, SampleRequest()).status.ok()) << "others are answered";
}

}  // namespace
}  // namespace duet::test
