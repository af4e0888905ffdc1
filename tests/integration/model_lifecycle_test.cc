// Models that come, change and go while calls are answered: in process, and over the wire by the
// admin service.

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
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
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "duet/admin/v1/admin.grpc.pb.h"
#include "server/lifecycle/run_server.h"
#include "tests/integration/running_server.h"
#include "tests/server/support/fakes.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::test {
namespace {

namespace fs = std::filesystem;
namespace admin = ::duet::admin::v1;

using nlohmann::json;
using server::registry::ModelSource;

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
    const ModelSource source = {
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
  template <typename Request, typename Response>
  grpc::Status Ask(grpc::Status (admin::Admin::Stub::*method)(grpc::ClientContext*, const Request&,
                                                              Response*),
                   const std::string& fields, Response* response = nullptr) {
    TimedContext context;
    Request request;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(fields, &request)) << fields;
    Response unused;
    return (*stub_.*method)(&context, request, response == nullptr ? &unused : response);
  }
  static std::string Version(const std::string& name, uint32_t version) {
    return absl::StrCat("name: '", name, "' version: ", version);
  }
  grpc::Status LoadModel(const std::string& name, uint32_t version) {
    return Ask(&admin::Admin::Stub::LoadModel, Version(name, version));
  }
  grpc::Status UnloadModel(const std::string& name, uint32_t version) {
    return Ask(&admin::Admin::Stub::UnloadModel, Version(name, version));
  }
  grpc::Status Reload(admin::ReloadResponse* response) {
    return Ask(&admin::Admin::Stub::Reload, "", response);
  }
  grpc::Status SetLabel(const std::string& name, const std::string& label, uint32_t version) {
    return Ask(&admin::Admin::Stub::SetLabel,
               absl::StrCat(Version(name, version), " label: '", label, "'"));
  }
  grpc::Status DeleteLabel(const std::string& name, const std::string& label) {
    return Ask(&admin::Admin::Stub::DeleteLabel,
               absl::StrCat("name: '", name, "' label: '", label, "'"));
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

// The setting `models`: which embedded models and which checkpoints a server loads.

using Model = std::shared_ptr<const engine::Synthesizer>;

constexpr char kRefused[] =
    "free_for_all_uses: expected true because of the setting models, got false";
constexpr char kNoneLeft[] =
    "no model could be loaded; models: expected at least one that is free for all uses, got none";

Model MakeModel(const std::string& name, int version, bool is_free) {
  engine::ModelDescription description = FakeDescription();
  description.name = name;
  description.version = version;
  description.free_for_all_uses = is_free;
  return std::make_shared<FakeSynthesizer>(description);
}

// The manifest of a made-up checkpoint is a word: "free" or "research".
absl::StatusOr<Model> LoadFolder(const fs::path& folder) {
  std::string word;
  std::ifstream(folder / "manifest.json") >> word;
  return MakeModel(folder.parent_path().filename(), std::stoi(folder.filename()), word == "free");
}

ModelSource Embedding(std::vector<Model> models) {
  return {"fake", LoadFolder, [models = std::move(models)] { return models; }};
}

ModelSource ThreeEmbedded() {
  return Embedding(
      {MakeModel("first", 2, false), MakeModel("first", 1, false), MakeModel("dance", 1, true)});
}

v1::ServerConfig Options(v1::ServedModels models, const std::string& repository = "") {
  v1::ServerConfig options = TestOptions();
  options.set_models(models);
  if (!repository.empty()) options.set_model_repository(repository);
  return options;
}

absl::Status Load(Running& server, const ModelSource& source) {
  return server->Load(source, [] { return false; });
}

// "name/version" of each model that the server reports, with "*" if it is the default and "free" if
// it is free for all uses.
std::vector<std::string> Served(Running& server) {
  TimedContext context;
  v1::ListModelsResponse list;
  EXPECT_TRUE(server.stub->ListModels(&context, v1::ListModelsRequest(), &list).ok());
  std::vector<std::string> models;
  for (const v1::Model& model : list.models()) {
    models.push_back(absl::StrCat(model.name(), "/", model.version(), model.is_default() ? "*" : "",
                                  model.free_for_all_uses() ? " free" : ""));
  }
  return models;
}

TEST(EmbeddedModelsTest, FreeServesOnlyFreeOnes) {
  Running server(Options(v1::SERVED_MODELS_FREE));
  ASSERT_THAT(Load(server, ThreeEmbedded()), IsOk());
  ASSERT_THAT(server->Serve(), IsOk());
  EXPECT_THAT(Served(server), ElementsAre("dance/1* free"));
  Running none_left(Options(v1::SERVED_MODELS_FREE));
  ASSERT_THAT(Load(none_left, Embedding({MakeModel("first", 1, false)})), IsOk());
  EXPECT_THAT(none_left->Serve(), StatusIs(absl::StatusCode::kFailedPrecondition, kNoneLeft));
}

// Servers over a repository.
class FreeRepositoryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Write("dance/1", "free");
    Write("sbu/1", "research");
  }

  void Write(const std::string& place, const std::string& manifest) {
    fs::create_directories(folder_ / place);
    WriteTestFile(folder_ / "next", manifest);
    fs::rename(folder_ / "next", folder_ / (place + "/manifest.json"));
  }
  std::string repository() const { return folder_.path().string(); }

  static server::registry::ReloadReport Reload(Running& server) {
    std::promise<absl::StatusOr<server::registry::ReloadReport>> done;
    server->control().Reload([&done](const auto& report) { done.set_value(report); });
    absl::StatusOr<server::registry::ReloadReport> report = done.get_future().get();
    EXPECT_THAT(report, IsOk());
    return *report;
  }
  // What the admin service calls.
  static absl::Status LoadVersion(Running& server, const std::string& name, uint32_t version) {
    std::promise<absl::Status> done;
    server->control().Load(name, version, [&done](absl::Status status) { done.set_value(status); });
    return done.get_future().get();
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(FreeRepositoryTest, FreeRefusesOtherCheckpointsAtAReloadAndByRequest) {
  Running server(Options(v1::SERVED_MODELS_FREE, repository()));
  ASSERT_THAT(Load(server, ThreeEmbedded()), IsOk());
  ASSERT_THAT(server->Serve(), IsOk());
  Write("dance/1", "research");
  Write("dance/2", "free");
  Write("sbu/2", "research");
  const server::registry::ReloadReport report = Reload(server);
  EXPECT_THAT(report.loaded, ElementsAre("dance/2"));
  EXPECT_THAT(report.refused, ElementsAre("dance/1", "sbu/2", "sbu/1"));
  EXPECT_THAT(LoadVersion(server, "sbu", 2),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr(kRefused)));
  EXPECT_THAT(Served(server), ElementsAre("dance/2* free", "dance/1 free"))
      << "the free checkpoint that dance/1 was stays";
}

// What --check-config writes, and its exit code.
std::pair<std::string, int> Check(const v1::ServerConfig& options, const ModelSource& source) {
  std::ostringstream out;
  const int code = server::lifecycle::CheckConfig({options, source, {}, {}}, out);
  return {out.str(), code};
}

TEST_F(FreeRepositoryTest, CheckConfigReportsWhatTheStartLoads) {
  EXPECT_EQ(Check(Options(v1::SERVED_MODELS_FREE), ThreeEmbedded()),
            std::make_pair(std::string("ok: embedded/dance/1\n"), 0));
  const auto [of_repository, refused] =
      Check(Options(v1::SERVED_MODELS_FREE, repository()), ThreeEmbedded());
  EXPECT_THAT(of_repository, AllOf(HasSubstr("ok: dance/1\n"),
                                   HasSubstr(absl::StrCat("wrong: sbu/1: ", kRefused))));
  EXPECT_EQ(refused, 1);
  const auto [none_left, failed] =
      Check(Options(v1::SERVED_MODELS_FREE), Embedding({MakeModel("first", 1, false)}));
  EXPECT_THAT(none_left, HasSubstr(absl::StrCat("wrong: ", kNoneLeft)));
  EXPECT_EQ(failed, 1);
  EXPECT_THAT(Check(Options(v1::SERVED_MODELS_ALL), ThreeEmbedded()).first,
              HasSubstr("ok: embedded/first/2\n"));
}

}  // namespace
}  // namespace duet::test
