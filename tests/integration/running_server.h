#ifndef DUET_TESTS_INTEGRATION_RUNNING_SERVER_H_
#define DUET_TESTS_INTEGRATION_RUNNING_SERVER_H_

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "duet/v1/synthesis.grpc.pb.h"
#include "server/common/mutex.h"
#include "server/config/settings.h"
#include "server/lifecycle/duet_server.h"
#include "tests/server/support/raw_call.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/status_matchers.h"

namespace duet::test {

// The defaults, on free ports that only this machine reaches.
inline v1::ServerConfig TestOptions() {
  v1::ServerConfig options = server::config::ReadSettings(v1::ServerConfig(), /*cores=*/1).values;
  options.set_listen("127.0.0.1:0");
  options.set_metrics_listen("127.0.0.1:0");
  return options;
}

// Keeps what is logged.
//
// Threads: safe to call concurrently.
class EventSink final : public server::metrics::LogSink {
 public:
  bool Write(std::string_view line) override {
    server::common::MutexLock lock(mutex_);
    lines_.push_back(nlohmann::json::parse(line));
    return true;
  }
  // The lines of one event, in order.
  std::vector<nlohmann::json> Events(const std::string& event) const {
    server::common::MutexLock lock(mutex_);
    std::vector<nlohmann::json> events;
    for (const nlohmann::json& line : lines_) {
      if (line["event"] == event) events.push_back(line);
    }
    return events;
  }

 private:
  mutable server::common::Mutex mutex_;
  std::vector<nlohmann::json> lines_ DUET_GUARDED_BY(mutex_);
};

// A server, a channel to it and its log.
class Running {
 public:
  explicit Running(const v1::ServerConfig& options = TestOptions(),
                   std::function<absl::Status()> self_check = nullptr) {
    absl::StatusOr<std::unique_ptr<server::lifecycle::DuetServer>> server =
        server::lifecycle::DuetServer::Start(options, log, std::move(self_check));
    EXPECT_THAT(server, IsOk());
    server_ = *std::move(server);
    channel = grpc::CreateChannel(absl::StrCat("127.0.0.1:", server_->port()),
                                  grpc::InsecureChannelCredentials());
    stub = v1::MotionSynthesis::NewStub(channel);
  }
  server::lifecycle::DuetServer* operator->() { return server_.get(); }
  server::lifecycle::DuetServer& operator*() { return *server_; }
  void Load(
      std::shared_ptr<const engine::Synthesizer> model = std::make_shared<FakeSynthesizer>()) {
    server_->Add({"fake/1", std::move(model), 0.5});
  }
  grpc::Status List() {
    TimedContext context;
    v1::ListModelsResponse response;
    return stub->ListModels(&context, v1::ListModelsRequest(), &response);
  }

  EventSink log;
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::MotionSynthesis::Stub> stub;

 private:
  std::unique_ptr<server::lifecycle::DuetServer> server_;
};

}  // namespace duet::test

#endif  // DUET_TESTS_INTEGRATION_RUNNING_SERVER_H_
