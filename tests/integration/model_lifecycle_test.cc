// Models that come, change and go while calls are answered: in process, and over the wire by the
// admin service.

#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "duet/admin/v1/admin.grpc.pb.h"
#include "tests/integration/running_server.h"
#include "tests/server/support/gated_model.h"
#include "tests/server/support/http_get.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/server/support/timed_context.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::test {
namespace {

namespace fs = std::filesystem;
namespace admin = ::duet::admin::v1;

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Lets somebody through once it is open.
class Gate {
 public:
  // Says that somebody is here, and waits.
  void Pass() {
    server::common::MutexLock lock(mutex_);
    reached_ = true;
    changed_.NotifyAll();
    while (!open_) changed_.Wait(mutex_);
  }
  void WaitUntilReached() {
    server::common::MutexLock lock(mutex_);
    while (!reached_) changed_.Wait(mutex_);
  }
  void Open() {
    server::common::MutexLock lock(mutex_);
    open_ = true;
    changed_.NotifyAll();
  }

 private:
  server::common::Mutex mutex_;
  server::common::CondVar changed_;
  bool reached_ DUET_GUARDED_BY(mutex_) = false;
  bool open_ DUET_GUARDED_BY(mutex_) = false;
};

// A server over a repository of made-up checkpoints: a manifest is a word, "good", "bad", "gated"
// (its loading waits at the gate) or "held" (its evaluations wait at held_model's).
class ModelLifecycleTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Write("fake/1", "good");
    v1::ServerConfig options = TestOptions();
    options.set_model_repository(folder_.path().string());
    options.set_admin_listen("127.0.0.1:0");
    server_.emplace(options);
    const server::registry::ModelSource source = {
        "fake", [this](const fs::path& folder) { return LoadTestModel(folder); }, {}};
    ASSERT_THAT((*server_)->Load(source, [] { return false; }), IsOk());
    stub_ = admin::Admin::NewStub(grpc::CreateChannel(
        absl::StrCat("127.0.0.1:", (*server_)->admin_port()), grpc::InsecureChannelCredentials()));
  }

  absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> LoadTestModel(const fs::path& folder) {
    std::string word;
    std::ifstream(folder / "manifest.json") >> word;
    if (word == "bad") return absl::DataLossError("weights: expected 9 bytes, got 7");
    std::string weights;
    std::ifstream(folder / "weights.safetensors") >> weights;
    if (weights == "torn") return absl::DataLossError("weights: expected 9 bytes, got 4");
    if (word == "gated") gate_.Pass();
    engine::ModelDescription description = FakeDescription();
    description.name = folder.parent_path().filename().string();
    description.version = std::stoi(folder.filename().string());
    auto model = std::make_shared<FakeSynthesizer>(description);
    if (word == "held") {
      // After the check of its answers.
      model->on_batch = [this, checked = std::make_shared<std::atomic<bool>>(false)](const auto&) {
        if (checked->exchange(true)) held_.Pass();
      };
    }
    return model;
  }

  // Puts a checkpoint in place whole.
  void Write(const std::string& place, const std::string& manifest) {
    fs::create_directories(folder_ / place);
    WriteTestFile(folder_ / "next", manifest);
    fs::rename(folder_ / "next", folder_ / (place + "/manifest.json"));
  }

  server::lifecycle::DuetServer& server() { return **server_; }
  v1::MotionSynthesis::Stub& synthesis() { return *server_->stub; }
  std::string Metrics() { return HttpGet(server().metrics_port(), "/metrics"); }

  // Admin calls.
  grpc::Status LoadModel(const std::string& name, uint32_t version) {
    TimedContext context;
    admin::LoadModelRequest request;
    request.set_name(name);
    request.set_version(version);
    admin::LoadModelResponse response;
    return stub_->LoadModel(&context, request, &response);
  }
  grpc::Status UnloadModel(const std::string& name, uint32_t version) {
    TimedContext context;
    admin::UnloadModelRequest request;
    request.set_name(name);
    request.set_version(version);
    admin::UnloadModelResponse response;
    return stub_->UnloadModel(&context, request, &response);
  }
  grpc::Status Reload(admin::ReloadResponse* response) {
    TimedContext context;
    return stub_->Reload(&context, admin::ReloadRequest(), response);
  }
  grpc::Status SetLabel(const std::string& name, const std::string& label, uint32_t version) {
    TimedContext context;
    admin::SetLabelRequest request;
    request.set_name(name);
    request.set_label(label);
    request.set_version(version);
    admin::SetLabelResponse response;
    return stub_->SetLabel(&context, request, &response);
  }
  grpc::Status DeleteLabel(const std::string& name, const std::string& label) {
    TimedContext context;
    admin::DeleteLabelRequest request;
    request.set_name(name);
    request.set_label(label);
    admin::DeleteLabelResponse response;
    return stub_->DeleteLabel(&context, request, &response);
  }
  // "name/version STATE" and labels.
  std::vector<std::string> ListModels() {
    TimedContext context;
    admin::ListModelsResponse response;
    EXPECT_TRUE(stub_->ListModels(&context, admin::ListModelsRequest(), &response).ok());
    std::vector<std::string> models;
    for (const admin::ModelVersion& model : response.models()) {
      models.push_back(absl::StrCat(
          model.name(), "/", model.version(), " ", admin::ModelState_Name(model.state()).substr(12),
          model.error().empty() ? "" : ": ", model.error(), model.outdated() ? " (outdated)" : ""));
      for (const std::string& label : model.version_labels()) models.back() += "+" + label;
    }
    return models;
  }

  v1::SynthesizeRequest RequestTo(uint32_t version) {
    v1::SynthesizeRequest request = SampleRequest(40);
    request.mutable_model()->set_name("fake");
    request.mutable_model()->set_version(version);
    return request;
  }

  TemporaryFolder folder_;
  Gate gate_;
  Gate held_;
  std::optional<Running> server_;
  std::unique_ptr<admin::Admin::Stub> stub_;
};

using StatusCode = grpc::StatusCode;

TEST_F(ModelLifecycleTest, ABadModelIsRefusedAndWhatIsServedStays) {
  ASSERT_THAT(server().Serve(), IsOk());
  Write("fake/1", "bad");
  Write("fake/2", "bad");
  admin::ReloadResponse reloaded;
  ASSERT_TRUE(Reload(&reloaded).ok());
  EXPECT_THAT(reloaded.refused(), ElementsAre("fake/2", "fake/1"));
  EXPECT_THAT(ListModels(),
              ElementsAre("fake/2 FAILED: weights: expected 9 bytes, got 7",
                          "fake/1 SERVED: weights: expected 9 bytes, got 7 (outdated)"));
  EXPECT_TRUE(Call(synthesis(), SampleRequest(40)).status.ok());
  EXPECT_THAT(Metrics(), AllOf(HasSubstr(R"(duet_model_state{checkpoint="fake/1"} 1)"),
                               HasSubstr(R"(duet_model_state{checkpoint="fake/2"} 0)"),
                               HasSubstr(R"(duet_model_loads_total{result="refused"} 2)"),
                               HasSubstr(R"(duet_reloads_total{result="failed"} 1)")));
}

TEST_F(ModelLifecycleTest, AFolderThatIsNoCheckpointShowsEverywhere) {
  ASSERT_THAT(server().Serve(), IsOk());
  fs::create_directories(folder_ / "fake/02");
  admin::ReloadResponse reloaded;
  ASSERT_TRUE(Reload(&reloaded).ok());
  ASSERT_TRUE(Reload(&reloaded).ok());
  TimedContext context;
  admin::ListModelsResponse list;
  ASSERT_TRUE(stub_->ListModels(&context, admin::ListModelsRequest(), &list).ok());
  ASSERT_EQ(list.skipped_folders_size(), 1);
  EXPECT_EQ(list.skipped_folders(0).folder(), "fake/02");
  EXPECT_THAT(list.skipped_folders(0).reason(), HasSubstr("expected a version"));
  EXPECT_THAT(Metrics(), HasSubstr("duet_model_folders_skipped 1"));
  EXPECT_EQ(server_->log.Events("folder_skipped").size(), 1u) << "once, however often it is seen";
}

TEST_F(ModelLifecycleTest, ACallFinishesOnAModelThatIsUnloadedUnderIt) {
  ASSERT_THAT(server().Serve(), IsOk());
  Write("fake/2", "held");
  ASSERT_TRUE(LoadModel("fake", 2).ok());
  Reply reply;
  std::thread caller([&] { reply = Call(synthesis(), RequestTo(2)); });
  held_.WaitUntilReached();
  EXPECT_TRUE(UnloadModel("fake", 2).ok());
  EXPECT_EQ(Decode(Call(synthesis(), RequestTo(2)).status).reason, "MODEL_NOT_FOUND");
  held_.Open();
  caller.join();
  EXPECT_TRUE(reply.status.ok()) << reply.status.error_message();
  EXPECT_EQ(reply.messages.front().header().model_version(), 2u);
  EXPECT_THAT(ListModels(), ElementsAre("fake/2 UNLOADED", "fake/1 SERVED"));
}

TEST_F(ModelLifecycleTest, CallsGoOnWhileAModelLoads) {
  ASSERT_THAT(server().Serve(), IsOk());
  Write("fake/2", "gated");
  grpc::Status loaded;
  std::thread operator_call([&] { loaded = LoadModel("fake", 2); });
  gate_.WaitUntilReached();
  EXPECT_TRUE(Call(synthesis(), RequestTo(1)).status.ok());
  EXPECT_THAT(ListModels(), ElementsAre("fake/2 LOADING", "fake/1 SERVED"));
  EXPECT_TRUE(SetLabel("fake", "stable", 1).ok()) << "labels do not wait";
  gate_.Open();
  operator_call.join();
  EXPECT_TRUE(loaded.ok());
  EXPECT_TRUE(Call(synthesis(), RequestTo(2)).status.ok());
}

TEST_F(ModelLifecycleTest, AServerThatStopsWhileAModelLoadsGivesUpTheRest) {
  ASSERT_THAT(server().Serve(), IsOk());
  Write("fake/3", "gated");
  Write("fake/2", "good");
  grpc::Status first;
  std::thread reload([&] {
    admin::ReloadResponse response;
    first = Reload(&response);
  });
  gate_.WaitUntilReached();
  server().Drain([](double) { return true; });
  EXPECT_EQ(LoadModel("fake", 2).error_code(), StatusCode::UNAVAILABLE);
  EXPECT_EQ(server_->log.Events("stopped").size(), 1u) << "the drain does not wait for it";
  gate_.Open();
  reload.join();
  EXPECT_EQ(first.error_code(), StatusCode::UNAVAILABLE);
  EXPECT_THAT(ListModels(), ElementsAre("fake/3 SERVED", "fake/1 SERVED"));
}

TEST_F(ModelLifecycleTest, AServerThatIsDestroyedWhileAModelLoadsWaitsForThatOne) {
  ASSERT_THAT(server().Serve(), IsOk());
  Write("fake/2", "gated");
  std::promise<absl::Status> done;
  server().control().Load("fake", 2, [&](const absl::Status& status) { done.set_value(status); });
  gate_.WaitUntilReached();
  std::thread opener([this] { gate_.Open(); });
  server_.reset();
  opener.join();
  EXPECT_THAT(done.get_future().get(), IsOk());
}

TEST_F(ModelLifecycleTest, HealthTellsOfEachModel) {
  ASSERT_THAT(server().Serve(), IsOk());
  constexpr char kOther[] = "duet.v1.MotionSynthesis/other";
  EXPECT_EQ(Health(server_->channel, "duet.v1.MotionSynthesis/fake"), "SERVING");
  EXPECT_EQ(Health(server_->channel, kOther), "service name unknown");
  const std::string request =
      "\x0a" + std::string(1, static_cast<char>(sizeof(kOther) - 1)) + kOther;
  RawCall watch(server_->channel, "/grpc.health.v1.Health/Watch", request);
  EXPECT_EQ(watch.Read().value_or(""), "\x08\x03") << "unknown";
  Write("other/1", "good");
  ASSERT_TRUE(LoadModel("other", 1).ok());
  EXPECT_EQ(watch.Read().value_or(""), "\x08\x01");
  ASSERT_TRUE(UnloadModel("other", 1).ok());
  EXPECT_EQ(watch.Read().value_or(""), "\x08\x02");
  EXPECT_EQ(Health(server_->channel, kOther), "NOT_SERVING");
  EXPECT_EQ(Health(server_->channel, ""), "SERVING") << "the whole server goes on";
}

TEST_F(ModelLifecycleTest, EachRefusalHasItsCodeAndSaysWhy) {
  EXPECT_EQ(Decode(LoadModel("fake", 1)).reason, "SERVER_LOADING");
  ASSERT_THAT(server().Serve(), IsOk());
  Write("fake/2", "bad");
  const auto refused = [](const grpc::Status& status, StatusCode code, const std::string& why) {
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    EXPECT_THAT(status.error_message(), HasSubstr(why));
  };
  refused(LoadModel("fake", 2), StatusCode::FAILED_PRECONDITION,
          "weights: expected 9 bytes, got 7");
  refused(LoadModel("fake", 3), StatusCode::NOT_FOUND, "version 3 of model \"fake\"");
  refused(LoadModel("", 0), StatusCode::INVALID_ARGUMENT,
          "name: expected a model's name, got none");
  EXPECT_THAT(Decode(LoadModel("", 0)).Fields(), ElementsAre("name", "version"));
  refused(UnloadModel("fake", 1), StatusCode::FAILED_PRECONDITION, "is the last");
  refused(UnloadModel("fake", 9), StatusCode::NOT_FOUND, "version 9");
  refused(SetLabel("fake", "stable", 9), StatusCode::NOT_FOUND, "version 9");
  refused(SetLabel("fake", "no blanks", 1), StatusCode::INVALID_ARGUMENT, "\"no blanks\"");
  refused(SetLabel("fake", std::string(64, 'a'), 1), StatusCode::INVALID_ARGUMENT, "1 to 63");
  refused(DeleteLabel("fake", "stable"), StatusCode::NOT_FOUND, "\"stable\"");
  fs::remove_all(folder_.path());
  admin::ReloadResponse response;
  refused(Reload(&response), StatusCode::NOT_FOUND, "cannot read");
}

TEST_F(ModelLifecycleTest, EachAdminCallLeavesALine) {
  ASSERT_THAT(server().Serve(), IsOk());
  ASSERT_TRUE(SetLabel("fake", "stable", 1).ok());
  ASSERT_FALSE(UnloadModel("fake", 1).ok());
  ASSERT_TRUE(LoadModel("fake", 1).ok());
  admin::ReloadResponse reloaded;
  ASSERT_TRUE(Reload(&reloaded).ok());
  ASSERT_FALSE(ListModels().empty());
  ASSERT_TRUE(DeleteLabel("fake", "stable").ok());
  ASSERT_FALSE(LoadModel("", 0).ok()) << "malformed";
  const std::vector<json> lines = server_->log.Events("admin_action");
  std::vector<std::string> actions;
  for (const json& line : lines) actions.push_back(line["action"]);
  EXPECT_THAT(actions, ElementsAre("SetLabel", "UnloadModel", "LoadModel", "Reload", "ListModels",
                                   "DeleteLabel", "LoadModel"));
  ASSERT_EQ(lines.size(), 7u);
  EXPECT_EQ(lines[6]["code"], "INVALID_ARGUMENT");
  EXPECT_EQ(lines[0]["arguments"], json({{"name", "fake"}, {"label", "stable"}, {"version", "1"}}));
  EXPECT_EQ(lines[0]["code"], "OK");
  EXPECT_THAT(lines[0]["peer"].get<std::string>(), HasSubstr("127.0.0.1"));
  EXPECT_EQ(lines[1]["code"], "FAILED_PRECONDITION");
  EXPECT_THAT(lines[1]["message"].get<std::string>(), HasSubstr("stable"));
  EXPECT_THAT(Metrics(), HasSubstr(R"(grpc_service="duet.admin.v1.Admin")"));
}

TEST(AdminListenerTest, IsClosedUnlessItIsConfigured) {
  Running server;
  server.Load();
  ASSERT_THAT(server->Serve(), IsOk());
  EXPECT_EQ(server->admin_port(), 0);
  const auto stub = admin::Admin::NewStub(server.channel);
  TimedContext context;
  admin::ListModelsResponse response;
  EXPECT_EQ(stub->ListModels(&context, admin::ListModelsRequest(), &response).error_code(),
            StatusCode::UNIMPLEMENTED)
      << "nor does the service's own listener have it";
}

TEST(AdminListenerTest, APortInUseIsNamed) {
  Running first;
  EventSink log;
  v1::ServerConfig options = TestOptions();
  options.set_admin_listen(absl::StrCat("127.0.0.1:", first->port()));
  EXPECT_THAT(server::lifecycle::DuetServer::Start(options, log),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr(options.admin_listen())));
}

TEST(AdminOfEmbeddedModelsTest, HasLabelsAndNothingToLoad) {
  v1::ServerConfig options = TestOptions();
  options.set_admin_listen("127.0.0.1:0");
  Running server(options);
  server.Load();
  ASSERT_THAT(server->Serve(), IsOk());
  const auto stub = admin::Admin::NewStub(grpc::CreateChannel(
      absl::StrCat("127.0.0.1:", server->admin_port()), grpc::InsecureChannelCredentials()));
  {
    TimedContext context;
    admin::LoadModelRequest request;
    request.set_name("fake");
    request.set_version(1);
    admin::LoadModelResponse response;
    const grpc::Status status = stub->LoadModel(&context, request, &response);
    EXPECT_EQ(status.error_code(), StatusCode::FAILED_PRECONDITION);
    EXPECT_THAT(status.error_message(), HasSubstr("model_repository"));
  }
  TimedContext context;
  admin::ReloadResponse response;
  EXPECT_TRUE(stub->Reload(&context, admin::ReloadRequest(), &response).ok());
}

}  // namespace
}  // namespace duet::test
