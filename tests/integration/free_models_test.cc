// The setting `models`: which embedded models and which checkpoints a server loads.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/lifecycle/run_server.h"
#include "tests/integration/running_server.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::test {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;
using server::registry::ModelSource;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

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

TEST(EmbeddedModelsTest, FreeServesOnlyFreeOnesAndNamesTheOthers) {
  Running server(Options(v1::SERVED_MODELS_FREE));
  ASSERT_THAT(Load(server, ThreeEmbedded()), IsOk());
  ASSERT_THAT(server->Serve(), IsOk());
  EXPECT_THAT(Served(server), ElementsAre("dance/1* free"));
  const std::vector<json> left_out = server.log.Events("models_left_out");
  ASSERT_EQ(left_out.size(), 1u);
  EXPECT_EQ(left_out[0]["sources"], json({"embedded/first/2", "embedded/first/1"}));
}

TEST(EmbeddedModelsTest, FreeWithoutAFreeOneCannotServe) {
  Running server(Options(v1::SERVED_MODELS_FREE));
  ASSERT_THAT(Load(server, Embedding({MakeModel("first", 1, false)})), IsOk());
  EXPECT_THAT(server->Serve(), StatusIs(absl::StatusCode::kFailedPrecondition, kNoneLeft));
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
            std::make_pair(std::string("ok: embedded/dance/1\nleft out, not free for all uses: "
                                       "embedded/first/2, embedded/first/1\n"),
                           0));
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
              Not(HasSubstr("left out")));
}

}  // namespace
}  // namespace duet::test
