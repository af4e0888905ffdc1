// Whole runs against a connection that a test writes.
#include "client/batch/job.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/batch/job_folder.h"
#include "client/batch/leaders.h"
#include "client/batch/plan.h"
#include "client/batch/recipe.h"
#include "client/batch/survey.h"
#include "duet/batch/v1/batch.pb.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/sha256.h"
#include "model/formats/motion_file.h"
#include "nlohmann/json.hpp"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

using test::ReadTestFile;

constexpr char kRecipe[] = R"(
  reactions { labels { weights { key: "kick" value: 1 } } }
  reactions { labels { weights { key: "hug" value: 0.5 } } }
  samples: 3 filter { retries_per_item: 2 max_distance_metres: 9 }
  output { formats: FORMAT_NPY })";
constexpr int kItems = 12;

// Answers as `answer` says, unless that is empty: the leader, moved by how much its seed tells.
class FakeConnection : public Connection {
 public:
  absl::StatusOr<std::vector<ModelInfo>> ListModels() override {
    return absl::UnimplementedError("");
  }
  absl::StatusOr<ModelDetails> GetModel(const ModelChoice&) override {
    return absl::UnimplementedError("");
  }
  absl::StatusOr<SynthesisResult> Synthesize(const SynthesisRequest& request,
                                             const ChunkCallback&) override {
    const int call = calls++;
    const absl::Status status = answer ? answer(request, call) : absl::OkStatus();
    if (!status.ok()) return status;
    SynthesisResult result;
    result.pair = {request.leader, request.leader};
    const auto by = static_cast<float>(*request.seed % 1000) / 1000 + distance;
    for (motion::Vec3& position : result.pair.follower.poses.all()) position.x += by;
    result.model_name = request.model.name;
    result.model_version = *request.model.version;
    result.request_id = request.request_id;
    result.seed = *request.seed;
    result.candidates = request.candidates;
    result.cleaned_up = made_by.cleaned_up;
    result.engine = made_by.engine;
    result.server_version = made_by.server_version;
    return result;
  }
  std::function<absl::Status(const SynthesisRequest&, int call)> answer;
  float distance = 1;
  MadeBy made_by = {true, "cpu, int16, AVX-512", "1.0.0"};
  std::atomic<int> calls{0};
};

JobOptions WithFewThreads(JobOptions options) {
  options.calls.max_in_flight = std::min(options.calls.max_in_flight, 4);
  return options;
}

class JobTest : public ::testing::Test {
 protected:
  JobTest() {
    const motion::Clip leader = test::SwayingClip(5, 15);
    for (const char* name : {"a.csv", "b.csv"}) {
      EXPECT_THAT(formats::WritePair(folder_ / name, {leader, leader}, motion::SbuSkeleton()),
                  IsOk());
    }
  }

  // A run into <folder>/<out>.
  absl::StatusOr<JobReport> Run(const std::string& out, const JobOptions& options = {},
                                const std::string& manifest = "leader\na.csv\nb.csv\n") {
    absl::StatusOr<Recipe> recipe = ParseRecipe(recipe_, false);
    EXPECT_THAT(recipe, IsOk());
    ModelInfo model;
    model.name = "fake";
    model.version = 3;
    model.interaction_classes = {"kick", "hug"};
    model.joint_names = motion::SbuSkeleton().joint_names;
    model.samples = true;
    JobFolder folder(folder_ / out);
    v1::Job begun;
    absl::Status status = folder.Open(IdentityOf(*recipe, {}), &begun);
    if (!status.ok()) return status;
    const v1::Job identity = IdentityOf(*recipe, {}, {model});
    const auto list = [&] {
      return ReadManifest(std::make_unique<std::istringstream>(manifest), folder_.path(), "m");
    };
    absl::StatusOr<Plan> plan = Plan::Create(*recipe, {model}, list());
    EXPECT_THAT(plan, IsOk());
    const absl::StatusOr<std::unique_ptr<Survey>> survey = Survey::Open(folder, repeats_);
    if (!survey.ok()) return survey.status();
    const absl::StatusOr<PlanCheck> check = CheckPlan(
        {{}, options.limit}, &*plan, [&survey](const Item& item) { return (*survey)->Add(item); });
    if (!check.ok()) return check.status();
    plan = Plan::Create(*recipe, {model}, list());
    EXPECT_THAT(folder.Begin(identity), IsOk());
    Job job({{*recipe, {model}, {motion::SbuSkeleton()}},
             {},
             Client(connection_),
             &folder,
             survey->get(),
             check->items},
            *std::move(plan), WithFewThreads(options));
    return job.Run();
  }

  std::string Read(const std::string& path) { return ReadTestFile(folder_ / path); }
  std::vector<std::string> Lines(const std::string& path) {
    std::vector<std::string> lines;
    std::istringstream in(Read(path));
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
  void ExpectSameAsUndisturbed(const std::string& out) {
    connection_ = std::make_shared<FakeConnection>();
    ASSERT_THAT(Run("undisturbed"), IsOk());
    for (const char* file : {"dataset.json", "failed.jsonl", "index.jsonl", "rejected.jsonl"}) {
      EXPECT_EQ(Read(out + "/" + file), Read(std::string("undisturbed/") + file)) << file;
    }
    ExpectFilesMatchTheIndex(out);
  }
  void ExpectFilesMatchTheIndex(const std::string& out) {
    for (const std::string& line : Lines(out + "/index.jsonl")) {
      for (const auto& file : nlohmann::json::parse(line)["files"]) {
        const std::string path = file["path"];
        EXPECT_EQ(base::Sha256Hex(Read(out + "/" + path)), file["sha256"]) << path;
      }
    }
  }
  FakeConnection& connection() { return *connection_; }

  test::TemporaryFolder folder_;
  std::string recipe_ = kRecipe;
  Repeats repeats_;
  std::shared_ptr<FakeConnection> connection_ = std::make_shared<FakeConnection>();
};

TEST_F(JobTest, AnswersThatAreMadeInAnotherWayAreRefusedByName) {
  JobOptions some;
  some.limit = 5;
  ASSERT_THAT(Run("set", some), IsOk());
  const auto record = nlohmann::json::parse(Lines("set/index.jsonl")[0]);
  EXPECT_EQ(record["cleaned_up"], true);
  EXPECT_EQ(record["engine"], "cpu, int16, AVX-512");
  EXPECT_EQ(record["server_version"], "1.0.0");
  const auto model = nlohmann::json::parse(Read("set/dataset.json"))["models"][0];
  EXPECT_EQ(model["cleaned_up"], true);
  EXPECT_EQ(model["engine"], "cpu, int16, AVX-512");
  const MadeBy first = connection().made_by;
  const std::string refusal = "model fake@3: an answer was made in another way";
  const std::vector<std::pair<MadeBy, std::string>> others = {
      {{false, first.engine, first.server_version}, "expected clean_up on, engine"},
      {{true, "cpu, f32, AVX-512", first.server_version}, "engine \"cpu, f32, AVX-512\""},
      {{true, first.engine, "1.1.0"}, "server_version \"1.1.0\""}};
  for (const auto& [made_by, named] : others) {
    connection().made_by = made_by;
    const auto report = Run("set");
    ASSERT_THAT(report, IsOk());
    EXPECT_THAT(report->stopped, StatusIs(absl::StatusCode::kFailedPrecondition,
                                          AllOf(HasSubstr(refusal), HasSubstr(named))));
    EXPECT_EQ(report->set.done, 5);
  }
  connection().made_by = first;
  EXPECT_THAT(Run("set"), IsOk());
  ExpectSameAsUndisturbed("set");
}

TEST_F(JobTest, ContinuesAfterAJournalTruncatedAnywhere) {
  ASSERT_THAT(Run("set"), IsOk());
  const std::filesystem::path journal = folder_ / "set/.duet-batch/journal";
  const auto whole = std::filesystem::file_size(journal);
  for (const auto size : {whole - 1, whole / 2, whole / 3, uintmax_t{0}}) {
    std::filesystem::resize_file(journal, size);
    ASSERT_THAT(Run("set"), IsOk());
    ExpectSameAsUndisturbed("set");
  }
}

TEST_F(JobTest, FullServerIsRetriedWithoutLoss) {
  connection().answer = [](const SynthesisRequest&, int call) {
    if (call % 2 == 1) return absl::OkStatus();
    absl::Status full = absl::ResourceExhaustedError("full");
    // google.rpc.RetryInfo {retry_delay {nanos: 1000}}
    full.SetPayload("type.googleapis.com/google.rpc.RetryInfo", absl::Cord("\x0a\x03\x10\xe8\x07"));
    return full;
  };
  const auto report = Run("set");
  ASSERT_THAT(report, IsOk());
  EXPECT_TRUE(report->complete());
  ExpectSameAsUndisturbed("set");
}

TEST_F(JobTest, AServerThatStaysAwayEndsTheRun) {
  connection().answer = [](const SynthesisRequest&, int) { return absl::UnavailableError("away"); };
  JobOptions options;
  options.calls.first_backoff = options.patience = std::chrono::milliseconds(1);
  const auto report = Run("set", options);
  ASSERT_THAT(report, IsOk());
  EXPECT_THAT(report->stopped, StatusIs(absl::StatusCode::kUnavailable, HasSubstr("no server")));
  EXPECT_EQ(report->set.done, 0);
  connection().answer = nullptr;
  ASSERT_THAT(Run("set"), IsOk());
  ExpectSameAsUndisturbed("set");
}

TEST_F(JobTest, TemporaryFailuresAreRetriedInThisRunAndTheNext) {
  connection().answer = [](const SynthesisRequest& request, int) {
    return request.weights[0].interaction_class == "hug" ? absl::InternalError("hiccup")
                                                         : absl::OkStatus();
  };
  const auto report = Run("set");
  ASSERT_THAT(report, IsOk());
  EXPECT_EQ(report->unfinished, kItems / 2);
  EXPECT_FALSE(report->complete());
  EXPECT_EQ(connection().calls, kItems / 2 + 3 * kItems / 2);
  EXPECT_THAT(report->first_unfinished, HasSubstr("hug0p5-s"));
  EXPECT_THAT(report->first_unfinished, EndsWith(": hiccup"));
  connection().answer = nullptr;
  ASSERT_THAT(Run("set"), IsOk());
  ExpectSameAsUndisturbed("set");
}

TEST_F(JobTest, RejectedItemsFailPermanentlyUnlessRetryIsRequested) {
  connection().answer = [](const SynthesisRequest& request, int) {
    return request.weights[0].interaction_class == "hug" ? absl::InvalidArgumentError("no hugs")
                                                         : absl::OkStatus();
  };
  auto report = Run("set");
  ASSERT_THAT(report, IsOk());
  EXPECT_EQ(report->set.failed, kItems / 2);
  EXPECT_TRUE(report->complete());
  connection().answer = nullptr;
  EXPECT_EQ(Run("set")->set.failed, kItems / 2);
  repeats_.failed = true;
  EXPECT_EQ(Run("set")->set.failed, 0);
  ExpectSameAsUndisturbed("set");
}

TEST_F(JobTest, RejectedCredentialsEndTheRunAndSettleNothing) {
  connection().answer = [](const SynthesisRequest&, int) {
    return absl::UnauthenticatedError("who?");
  };
  const auto report = Run("set");
  ASSERT_THAT(report, IsOk());
  EXPECT_THAT(report->stopped, StatusIs(absl::StatusCode::kUnauthenticated, HasSubstr("who?")));
  EXPECT_EQ(report->set.failed, 0);
}

TEST_F(JobTest, RejectedAnswersAreRetriedWithOtherSeedsAndListed) {
  connection().distance = 20;  // beyond the filter, whatever the seed
  const auto report = Run("set");
  ASSERT_THAT(report, IsOk());
  EXPECT_EQ(report->set.rejected, kItems);
  EXPECT_EQ(connection().calls, 3 * kItems);
  const auto lines = Lines("set/rejected.jsonl");
  ASSERT_THAT(lines, SizeIs(kItems));
  EXPECT_THAT(lines[0], HasSubstr("expected at most 9"));
  EXPECT_THAT(Lines("set/index.jsonl"), SizeIs(0));
  // Each is settled once, by its last answer.
  std::ifstream journal(JobFolder(folder_ / "set").journal());
  int rejected = 0;
  for (std::string line; std::getline(journal, line);) {
    rejected += line.find("\"rejected\"") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(rejected, kItems);
}

TEST_F(JobTest, ChangedLinesAndOrdersAreRejectedAndAddedLinesAreMade) {
  const std::string header = "leader\tlabels\tseed\n";
  ASSERT_THAT(Run("set", {}, header + "a.csv\tkick=1\t1\nb.csv\t\t\n"), IsOk());
  const int calls = connection().calls;
  const std::pair<const char*, const char*> cases[] = {
      {"b.csv\t\t\na.csv\tkick=1\t1\n",
       "item 0: expected a-2-kick-s0 of a.csv as the set was begun with, got b-2-"},
      {"a.csv\tkick=0.5\t1\n", "as the set was begun with, got a-2-kick0p5"},
      {"a.csv\tkick=1\t2\n", "got a-2-kick-s0 of a.csv, asked in another way"}};
  for (const auto& [lines, message] : cases) {
    EXPECT_THAT(Run("set", {}, header + lines),
                StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr(message)));
  }
  EXPECT_THAT(Run("set", {}, header + "a.csv\tkick=1\t1\nb.csv\t\t\na.csv\t\t\n"), IsOk());
  EXPECT_EQ(connection().calls, calls + kItems / 2);
}

TEST_F(JobTest, UnreadableLeaderFailsOnlyItsItems) {
  const auto report = Run("set", {}, "leader\na.csv\nnone.csv\n");
  ASSERT_THAT(report, IsOk());
  EXPECT_EQ(report->set.done, kItems / 2);
  EXPECT_EQ(report->set.failed, kItems / 2);
  const auto failed = Lines("set/failed.jsonl");
  ASSERT_THAT(failed, SizeIs(kItems / 2));
  const auto record = nlohmann::json::parse(failed[0]);
  EXPECT_EQ(record["name"], "none-3-kick-s0");
  EXPECT_EQ(record["error"]["code"], "NOT_FOUND");
  EXPECT_EQ(report->set.failed_leaders, 1);
  EXPECT_THAT(report->set.first_failure, EndsWith("none.csv: no such file"));
}

TEST_F(JobTest, ChangedLeaderIsRejected) {
  JobOptions first;
  first.limit = 2;
  ASSERT_THAT(Run("set", first), IsOk());
  const std::string before = Read("a.csv");
  test::WriteTestFile(folder_ / "a.csv", before + "\n");
  EXPECT_THAT(Run("set"),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("leader a.csv: expected")));
  EXPECT_EQ(connection().calls, 2);
  // One that nothing was made of yet may be mended.
  test::WriteTestFile(folder_ / "a.csv", before);
  ASSERT_THAT(Run("set"), IsOk());
  ExpectSameAsUndisturbed("set");
}

TEST_F(JobTest, ALeaderThatChangesDuringTheRunEndsIt) {
  const std::string before = Read("a.csv");
  connection().answer = [this, &before](const SynthesisRequest&, int call) {
    if (call == 0) test::WriteTestFile(folder_ / "a.csv", before + "\n");
    return absl::OkStatus();
  };
  JobOptions options;
  options.calls.max_in_flight = 1;
  // The last line comes when the first one's leader is long forgotten.
  const auto report = Run("set", options, "leader\na.csv\nb.csv\nb.csv\na.csv\n");
  ASSERT_THAT(report, IsOk());
  EXPECT_THAT(report->stopped,
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("leader a.csv: expected")));
  ExpectFilesMatchTheIndex("set");
}

}  // namespace
}  // namespace duet::client::batch
