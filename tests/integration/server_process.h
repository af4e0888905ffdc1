#ifndef DUET_TESTS_INTEGRATION_SERVER_PROCESS_H_
#define DUET_TESTS_INTEGRATION_SERVER_PROCESS_H_

#include <fcntl.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "duet/v1/synthesis.grpc.pb.h"

namespace duet::test {

// A program built with a sanitizer is slower and takes more memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

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
    if (output_ != nullptr) std::fclose(output_);
  }

  // Reads on until an event was logged; null when the process ended without it.
  nlohmann::json WaitForEvent(const std::string& event) {
    for (std::string line; ReadLine(&line);) {
      const auto parsed = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
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
  bool ReadLine(std::string* line) {
    char* text = nullptr;
    std::size_t capacity = 0;
    const ssize_t length = getline(&text, &capacity, output_);
    if (length > 0) line->assign(text, static_cast<std::size_t>(length));
    std::free(text);
    return length > 0;
  }
  // From now on the process waits once it is a page ahead of the test's reading.
  void ShrinkPipe() { EXPECT_GE(fcntl(fileno(output_), F_SETPIPE_SZ, 4096), 0); }
  // What the process writes from now on has no reader.
  void StopReading() { std::fclose(std::exchange(output_, nullptr)); }
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
  pid_t pid_ = -1;
  bool exited_ = false;
  int lines_without_json_ = 0;
  std::FILE* output_ = nullptr;
};

inline std::vector<std::string> Flags(std::vector<std::string> more = {}) {
  std::vector<std::string> flags = {"--listen", "127.0.0.1:0", "--metrics-listen", "off"};
  flags.insert(flags.end(), more.begin(), more.end());
  return flags;
}

// Takes in no more than a small window of a reply before it is read: a long call whose reader waits
// stays under way, however fast the server is.
inline std::unique_ptr<v1::MotionSynthesis::Stub> Connect(const nlohmann::json& serving) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 65536);
  return v1::MotionSynthesis::NewStub(
      grpc::CreateCustomChannel(absl::StrCat("127.0.0.1:", serving["port"].get<int>()),
                                grpc::InsecureChannelCredentials(), arguments));
}

}  // namespace duet::test

#endif  // DUET_TESTS_INTEGRATION_SERVER_PROCESS_H_
