// duet admin against a server that a test scripts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "client/admin_client.h"
#include "client/cli/program_environment.h"
#include "client/cli/report.h"
#include "nlohmann/json.hpp"
#include "tests/support/matchers.h"

namespace duet::client::cli {
namespace {

using ::testing::Return;

class MockAdminClient : public AdminClient {
 public:
  MOCK_METHOD(absl::StatusOr<ServedModels>, ListModels, (), (override));
  MOCK_METHOD(absl::Status, LoadModel, (const std::string&, uint32_t), (override));
  MOCK_METHOD(absl::Status, UnloadModel, (const std::string&, uint32_t), (override));
  MOCK_METHOD(absl::StatusOr<ReloadResult>, Reload, (), (override));
  MOCK_METHOD(absl::Status, SetLabel, (const std::string&, const std::string&, uint32_t),
              (override));
  MOCK_METHOD(absl::Status, DeleteLabel, (const std::string&, const std::string&), (override));
};

class AdminCommandTest : public ::testing::Test {
 protected:
  AdminCommandTest() {
    ServedModels models;
    models.models.push_back({"sbu", 3, ServedVersion::State::kServed, "", {"canary"}, true, 0.5});
    models.models.push_back({"sbu",
                             2,
                             ServedVersion::State::kFailed,
                             "weights: expected 9 bytes, got 7",
                             {},
                             false,
                             0});
    models.skipped_folders.push_back({"sbu/01", "is no version"});
    ON_CALL(*client_, ListModels).WillByDefault(Return(models));
  }

  // Runs "duet admin ...".
  int Run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "admin");
    ProgramEnvironment environment{nullptr, &out_, &err_};
    environment.connect_admin = [this](const ClientOptions& options) {
      options_ = options;
      return absl::StatusOr<std::unique_ptr<AdminClient>>(std::move(client_));
    };
    return RunProgram(arguments, environment);
  }

  std::unique_ptr<::testing::NiceMock<MockAdminClient>> client_ =
      std::make_unique<::testing::NiceMock<MockAdminClient>>();
  ClientOptions options_;
  std::ostringstream out_;
  std::ostringstream err_;
};

TEST_F(AdminCommandTest, AVersionIsAWholeNumber) {
  for (const char* action : {"load", "unload"}) {
    for (const char* version : {"x", "-1", "0", "1.5", "99999999999"}) {
      err_.str("");
      EXPECT_EQ(Run({action, "sbu", version}), kExitUsage);
      EXPECT_THAT(err_.str(), HasSubstr("version: expected 1 to 4294967295")) << version;
    }
  }
}

TEST_F(AdminCommandTest, ListsModels) {
  EXPECT_EQ(Run({"models"}), kExitDone);
  EXPECT_EQ(out_.str(),
            "sbu/3  served, default, labels: canary\n"
            "sbu/2  failed\n    weights: expected 9 bytes, got 7\n"
            "sbu/01  skipped: is no version\n");
  EXPECT_EQ(options_.server_address, "localhost:50052");
}

TEST_F(AdminCommandTest, ListsModelsAsJson) {
  EXPECT_EQ(Run({"models", "--json", "--admin-server", "lab:7"}), kExitDone);
  const auto json = nlohmann::json::parse(out_.str());
  EXPECT_EQ(json["models"][0]["state"], "served");
  EXPECT_EQ(json["models"][1]["error"], "weights: expected 9 bytes, got 7");
  EXPECT_EQ(json["models"][0]["outdated"], false);
  EXPECT_TRUE(json["problems"].empty());
  EXPECT_EQ(json["skipped_folders"][0]["folder"], "sbu/01");
  EXPECT_EQ(options_.server_address, "lab:7");
}

TEST_F(AdminCommandTest, ShowsOutdatedAndRejectedModels) {
  ServedModels models;
  models.models.push_back({"sbu",
                           3,
                           ServedVersion::State::kServed,
                           "weights: expected 9 bytes, got 7",
                           {},
                           true,
                           0.5,
                           true});
  models.problems = {"access file: empty"};
  EXPECT_CALL(*client_, ListModels).WillOnce(Return(models));
  EXPECT_EQ(Run({"models"}), kExitDone);
  EXPECT_EQ(out_.str(),
            "sbu/3  served (outdated: the files on disk were rejected), default\n"
            "    weights: expected 9 bytes, got 7\n"
            "problem: access file: empty\n");
}

TEST_F(AdminCommandTest, PrintsTheReasonOfAFailure) {
  EXPECT_CALL(*client_, UnloadModel("sbu", 3))
      .WillOnce(Return(absl::FailedPreconditionError("version label \"canary\" points at it")));
  EXPECT_EQ(Run({"unload", "sbu", "3"}), kExitBadInput);
  EXPECT_THAT(err_.str(), HasSubstr("version label \"canary\" points at it"));
}

TEST_F(AdminCommandTest, MissingServiceIsExplainedByItsOwnFlag) {
  EXPECT_CALL(*client_, ListModels).WillOnce(Return(absl::UnavailableError("refused")));
  EXPECT_EQ(Run({"models"}), kExitRetry);
  EXPECT_EQ(
      err_.str(),
      "duet: refused (UNAVAILABLE)\nThe admin service is off unless the server's configuration "
      "sets admin_listen. Name its address with --admin-server HOST:PORT.\n");
}

TEST_F(AdminCommandTest, MovesAndDeletesLabels) {
  EXPECT_CALL(*client_, SetLabel("sbu", "canary", 4));
  EXPECT_EQ(Run({"label", "sbu", "canary", "4"}), kExitDone);
  client_ = std::make_unique<::testing::NiceMock<MockAdminClient>>();
  EXPECT_CALL(*client_, DeleteLabel("sbu", "canary"));
  ON_CALL(*client_, ListModels).WillByDefault(Return(ServedModels()));
  EXPECT_EQ(Run({"label", "sbu", "canary", "--delete"}), kExitDone);
}

TEST_F(AdminCommandTest, IncompleteReloadIsReported) {
  EXPECT_CALL(*client_, Reload())
      .WillOnce(Return(ReloadResult{{"sbu/4"}, {"sbu/5"}, {"sbu/1"}, 2, {"no label"}}));
  EXPECT_EQ(Run({"reload"}), kExitRetry);
  EXPECT_EQ(out_.str(),
            "loaded: sbu/4\nrefused: sbu/5\nunloaded: sbu/1\nunchanged: 2\nproblem: no label\n");
}

TEST_F(AdminCommandTest, ActionAndItsArgumentsAreRequired) {
  EXPECT_EQ(Run({}), kExitUsage);
  EXPECT_EQ(Run({"load", "sbu"}), kExitUsage);
  EXPECT_EQ(Run({"load", "sbu", "three"}), kExitUsage);
  EXPECT_EQ(Run({"label", "sbu", "canary"}), kExitUsage);
  EXPECT_EQ(Run({"label", "sbu", "canary", "3", "--delete"}), kExitUsage);
}

}  // namespace
}  // namespace duet::client::cli
