// duet admin against a server that a test scripts.

#include <google/protobuf/text_format.h>

#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/command.h"
#include "duet/admin/v1/admin.grpc.pb.h"
#include "gmock/gmock.h"
#include "grpcpp/security/server_credentials.h"
#include "grpcpp/server.h"
#include "grpcpp/server_builder.h"
#include "gtest/gtest.h"
#include "nlohmann/json.hpp"
#include "tests/support/matchers.h"

namespace duet::client::cli {
namespace {

namespace v1 = ::duet::admin::v1;

// An admin service with the answers of a test. It writes down the other requests.
class FakeAdmin final : public v1::Admin::Service {
 public:
  v1::ListModelsResponse models;
  v1::ReloadResponse reloaded;
  grpc::Status status;  // of every request but ListModels
  std::vector<std::string> requests;

  grpc::Status ListModels(grpc::ServerContext*, const v1::ListModelsRequest*,
                          v1::ListModelsResponse* response) override {
    *response = models;
    return grpc::Status::OK;
  }
  grpc::Status LoadModel(grpc::ServerContext*, const v1::LoadModelRequest* request,
                         v1::LoadModelResponse*) override {
    return Note("load", *request);
  }
  grpc::Status UnloadModel(grpc::ServerContext*, const v1::UnloadModelRequest* request,
                           v1::UnloadModelResponse*) override {
    return Note("unload", *request);
  }
  grpc::Status Reload(grpc::ServerContext*, const v1::ReloadRequest* request,
                      v1::ReloadResponse* response) override {
    *response = reloaded;
    return Note("reload", *request);
  }
  grpc::Status SetLabel(grpc::ServerContext*, const v1::SetLabelRequest* request,
                        v1::SetLabelResponse*) override {
    return Note("set", *request);
  }
  grpc::Status DeleteLabel(grpc::ServerContext*, const v1::DeleteLabelRequest* request,
                           v1::DeleteLabelResponse*) override {
    return Note("delete", *request);
  }

 private:
  grpc::Status Note(const char* what, const google::protobuf::Message& request) {
    requests.push_back(absl::StrCat(what, " ", request.ShortDebugString()));
    return status;
  }
};

class AdminCommandTest : public ::testing::Test {
 protected:
  AdminCommandTest() {
    ParseText(R"(models { name: "sbu" version: 3 state: MODEL_STATE_SERVED version_labels: "canary"
                          is_default: true outdated: true error: "weights: expected the SHA-256" }
                 models { name: "sbu" version: 2 state: MODEL_STATE_FAILED
                          error: "weights: expected 9 bytes, got 7" }
                 skipped_folders { folder: "sbu/01" reason: "is no version" }
                 problems: "access file: empty")",
              &admin_.models);
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(&admin_);
    server_ = builder.BuildAndStart();
  }

  static void ParseText(const char* text, google::protobuf::Message* message) {
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, message)) << text;
  }

  // Runs "duet admin ...".
  int Run(std::vector<std::string> arguments) {
    out_.str("");
    err_.str("");
    arguments.insert(arguments.begin(),
                     {"admin", "--admin-server", absl::StrCat("127.0.0.1:", port_)});
    return RunProgram(arguments, {nullptr, &out_, &err_});
  }

  FakeAdmin admin_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
  std::ostringstream out_;
  std::ostringstream err_;
};

TEST_F(AdminCommandTest, ListsModelsAsTextAndJson) {
  EXPECT_EQ(Run({"models"}), kExitDone);
  EXPECT_EQ(out_.str(),
            "sbu/3  served (outdated: the files on disk were rejected), default, labels: canary\n"
            "    weights: expected the SHA-256\n"
            "sbu/2  failed\n    weights: expected 9 bytes, got 7\n"
            "sbu/01  skipped: is no version\n"
            "problem: access file: empty\n");
  EXPECT_EQ(Run({"models", "--json"}), kExitDone);
  const auto json = nlohmann::json::parse(out_.str());
  EXPECT_EQ(json["models"][0]["state"], "MODEL_STATE_SERVED");
  EXPECT_EQ(json["models"][0]["version"], 3);
  EXPECT_EQ(json["models"][1]["is_default"], false);
  EXPECT_EQ(json["models"][0]["outdated"], true);
  EXPECT_EQ(json["models"][1]["error"], "weights: expected 9 bytes, got 7");
  EXPECT_EQ(json["problems"][0], "access file: empty");
  EXPECT_EQ(json["skipped_folders"][0]["folder"], "sbu/01");
}

TEST_F(AdminCommandTest, PrintsTheReasonOfAFailure) {
  admin_.status = {grpc::StatusCode::FAILED_PRECONDITION, "version label \"canary\" points at it"};
  EXPECT_EQ(Run({"unload", "sbu", "3"}), kExitBadInput);
  EXPECT_THAT(err_.str(), HasSubstr("version label \"canary\" points at it"));
}

TEST_F(AdminCommandTest, MissingServiceIsExplainedByItsOwnFlag) {
  server_->Shutdown();
  EXPECT_EQ(Run({"models", "--timeout", "5"}), kExitRetry);
  EXPECT_THAT(err_.str(),
              HasSubstr("(UNAVAILABLE)\nThe admin service is off unless the server's configuration "
                        "sets admin_listen. Name its address with --admin-server HOST:PORT.\n"));
}

TEST_F(AdminCommandTest, EachActionIsARequest) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"load", "sbu", "4"}, "load name: \"sbu\" version: 4"},
      {{"unload", "sbu", "4"}, "unload name: \"sbu\" version: 4"},
      {{"label", "sbu", "canary", "4"}, "set name: \"sbu\" label: \"canary\" version: 4"},
      {{"label", "sbu", "canary", "--delete"}, "delete name: \"sbu\" label: \"canary\""},
      {{"reload"}, "reload "}};
  for (const auto& [arguments, request] : cases) {
    EXPECT_EQ(Run(arguments), kExitDone) << err_.str();
    EXPECT_EQ(admin_.requests.back(), request);
  }
}

TEST_F(AdminCommandTest, InvalidArgumentsAreRejected) {
  for (const char* version : {"x", "-1", "0", "1.5", "99999999999"}) {
    EXPECT_EQ(Run({"load", "sbu", version}), kExitUsage);
    EXPECT_THAT(err_.str(), HasSubstr("version: Value ")) << version;
  }
  const std::vector<std::string> cases[] = {
      {}, {"load", "sbu"}, {"label", "sbu", "canary"}, {"label", "sbu", "canary", "3", "--delete"}};
  for (const auto& arguments : cases) EXPECT_EQ(Run(arguments), kExitUsage);
}

TEST_F(AdminCommandTest, IncompleteReloadIsReported) {
  ParseText(R"(loaded: "sbu/4" refused: "sbu/5" unloaded: "sbu/1" unchanged_count: 2
               problems: "no label")",
            &admin_.reloaded);
  EXPECT_EQ(Run({"reload"}), kExitRetry);
  EXPECT_EQ(out_.str(),
            "loaded: sbu/4\nrefused: sbu/5\nunloaded: sbu/1\nunchanged: 2\nproblem: no label\n");
}

}  // namespace
}  // namespace duet::client::cli
