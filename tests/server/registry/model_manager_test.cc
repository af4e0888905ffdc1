#include "server/registry/model_manager.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::server::registry {
namespace {

using test::FakeSynthesizer;
using test::TemporaryFolder;
using test::WriteTestFile;

namespace fs = std::filesystem;

constexpr auto kNotFound = absl::StatusCode::kNotFound;
constexpr auto kFailedPrecondition = absl::StatusCode::kFailedPrecondition;

const auto kNever = [] { return false; };

// A model whose description is its manifest's text; "bad" does not load.
absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> LoadTestModel(const fs::path& folder) {
  std::string name, description;
  int version = 0;
  std::ifstream(folder / "manifest.json") >> name >> version >> description;
  std::string weights;
  std::ifstream(folder / "weights.safetensors") >> weights;
  if (name == "bad" || weights == "torn")
    return absl::DataLossError("weights: expected 9 bytes, got 7");
  engine::ModelDescription model = test::FakeDescription();
  model.name = name;
  model.version = version;
  model.description = description + weights;
  return std::make_shared<FakeSynthesizer>(model);
}

class Events final : public ModelObserver {
 public:
  void Loaded(const LoadReport& report, bool still_served) override {
    log.push_back(absl::StrCat(report.model.ok() ? "loaded " : "refused ", report.source,
                               !report.model.ok() && still_served ? ", served on" : ""));
  }
  void Unloaded(const std::string& source) override { log.push_back("unloaded " + source); }
  void Forgotten(const std::string& source) override { log.push_back("forgotten " + source); }
  void Scanned(const std::vector<SkippedFolder>&) override {}
  void Reloaded(const absl::StatusOr<ReloadReport>&) override {}
  void Changed() override {}

  // What was heard since the last time.
  std::vector<std::string> Take() { return std::exchange(log, {}); }
  std::vector<std::string> log;
};

class ModelManagerTest : public ::testing::Test {
 protected:
  // Writes <name>/<version> whole; another manifest is another file.
  void Write(const std::string& name, int version, const std::string& text = "first") {
    const fs::path place = folder_ / absl::StrCat(name, "/", version);
    fs::create_directories(place);
    const std::string manifest =
        text == "bad" ? "bad" : absl::StrCat(name, " ", version, " ", text);
    WriteTestFile(folder_ / "next", manifest);
    fs::rename(folder_ / "next", place / "manifest.json");
  }
  // Writes its weights; "torn" ones do not load. The manifest stays. Each time is another one,
  // however fast the test writes.
  void WriteWeights(const std::string& place, const std::string& text) {
    WriteTestFile(folder_ / place / "weights.safetensors", text);
    written_ += std::chrono::seconds(1);
    fs::last_write_time(folder_ / place / "weights.safetensors", written_);
  }
  void Delete(const std::string& place) { fs::remove_all(folder_ / place); }

  ReloadReport Reload() {
    const absl::StatusOr<ReloadReport> report = manager_.Reload(kNever);
    EXPECT_THAT(report, IsOk());
    return report.ok() ? *report : ReloadReport();
  }

  // "name/version text" of what is served, or what was not found.
  std::string Answer(const ModelQuery& query) const {
    const FindResult found = registry_.Find(query);
    if (const auto* not_found = std::get_if<ModelNotFound>(&found)) return not_found->description;
    const engine::ModelDescription& model = std::get<ServedModel>(found).model->description();
    return absl::StrCat(model.name, "/", model.version, " ", model.description);
  }
  // "name/version" of all that is served.
  std::string Served() const {
    return absl::StrJoin(registry_.List(), " ", [](std::string* out, const ServedModel& served) {
      const engine::ModelDescription& model = served.model->description();
      absl::StrAppend(out, model.name, "/", model.version);
    });
  }
  ModelStatus StatusOf(const std::string& name, uint32_t version) const {
    for (ModelStatus& status : manager_.List()) {
      if (status.name == name && status.version == version) return status;
    }
    ADD_FAILURE() << name << "/" << version << " is not listed";
    return {};
  }

  fs::file_time_type written_ = fs::file_time_type::clock::now() - std::chrono::hours(1);
  TemporaryFolder folder_;
  ModelRegistry registry_;
  Events events_;
  ModelManager manager_{registry_, events_};

 private:
  void SetUp() override { manager_.UseRepository(folder_.path(), LoadTestModel); }
};

TEST_F(ModelManagerTest, ServesEveryVersionOfEveryModelAndSkipsUnchangedOnes) {
  Write("a", 1);
  Write("a", 2);
  Write("b", 7);
  EXPECT_THAT(Reload().loaded, ElementsAre("a/2", "a/1", "b/7"));
  EXPECT_EQ(Served(), "a/2 a/1 b/7");
  events_.Take();
  WriteTestFile(folder_ / "a/1/NOTES.md", "better");  // no file of the checkpoint
  WriteTestFile(folder_ / "a/1/.nfs1", "");
  EXPECT_EQ(Reload().unchanged, 3);
  EXPECT_THAT(events_.Take(), IsEmpty());
  WriteTestFile(folder_ / "a/1/more", "");
  EXPECT_THAT(Reload().loaded, ElementsAre("a/1"));
}

TEST_F(ModelManagerTest, ReplacesAVersionThatHasChanged) {
  Write("a", 1, "old");
  Reload();
  FindResult held = registry_.Find({});
  Write("a", 1, "new");
  EXPECT_THAT(Reload().loaded, ElementsAre("a/1"));
  EXPECT_EQ(Answer({}), "a/1 new");
  EXPECT_EQ(std::get<ServedModel>(held).model->description().description, "old")
      << "whoever found the old one keeps it";
}

TEST_F(ModelManagerTest, TruncatedWeightsMakeAServedVersionOutdatedUntilTheyAreFixed) {
  Write("a", 1);
  WriteWeights("a/1", "+old");
  Reload();
  events_.Take();
  WriteWeights("a/1", "torn");
  EXPECT_THAT(Reload().refused, ElementsAre("a/1"));
  EXPECT_EQ(Answer({}), "a/1 first+old");
  EXPECT_TRUE(StatusOf("a", 1).outdated);
  EXPECT_EQ(StatusOf("a", 1).error, "weights: expected 9 bytes, got 7");
  WriteWeights("a/1", "+old");
  EXPECT_THAT(Reload().loaded, ElementsAre("a/1")) << "loaded again, though they are the old ones";
  EXPECT_FALSE(StatusOf("a", 1).outdated);
  EXPECT_EQ(StatusOf("a", 1).error, "");
  EXPECT_THAT(events_.Take(), ElementsAre("refused a/1, served on", "loaded a/1"));
}

// Files that change while they are read: nobody knows which content was loaded.
TEST_F(ModelManagerTest, FilesThatChangeDuringALoadAreLoadedAgain) {
  Write("a", 1);
  WriteWeights("a/1", "+old");
  bool first = true;
  manager_.UseRepository(folder_.path(), [&](const fs::path& place) {
    if (std::exchange(first, false)) {
      WriteWeights("a/1", "+new");
      auto loaded = LoadTestModel(place);
      WriteWeights("a/1", "+old");
      return loaded;
    }
    return LoadTestModel(place);
  });
  Reload();
  EXPECT_EQ(Answer({}), "a/1 first+new");
  EXPECT_THAT(Reload().loaded, ElementsAre("a/1"));
  EXPECT_EQ(Answer({}), "a/1 first+old");
}

TEST_F(ModelManagerTest, ReportsConfiguredNamesThatNoModelHas) {
  Write("first", 1);
  Write("second", 1);
  manager_.SetLabels({{"first", "stable", 1}, {"firs", "canary", 1}});
  Reload();
  EXPECT_THAT(manager_.UnknownNames(),
              ElementsAre("version_labels[1].model: expected one of: first, second, got \"firs\""));
}

TEST_F(ModelManagerTest, TriesAgainWhatDidNotLoadUntilItsFolderIsGone) {
  Write("a", 1);
  Write("a", 2, "bad");
  EXPECT_THAT(Reload().refused, ElementsAre("a/2"));
  EXPECT_EQ(StatusOf("a", 2).state, ModelState::kFailed);
  EXPECT_THAT(Reload().refused, ElementsAre("a/2"));
  Delete("a/2");
  Reload();
  EXPECT_THAT(events_.Take(),
              ElementsAre("refused a/2", "loaded a/1", "refused a/2", "forgotten a/2"));
}

TEST_F(ModelManagerTest, UnloadsARemovedVersionAfterItsSuccessorIsServed) {
  Write("a", 1);
  Reload();
  events_.Take();
  Delete("a/1");
  Write("a", 2);
  EXPECT_THAT(Reload().unloaded, ElementsAre("a/1"));
  EXPECT_THAT(events_.Take(), ElementsAre("loaded a/2", "unloaded a/1")) << "in this order";
  EXPECT_EQ(manager_.List().size(), 1u);
}

TEST_F(ModelManagerTest, TheDefaultModelAndLabelledVersionsStayServedWithoutTheirFolders) {
  manager_.SetLabels({{"b", "stable", 1}});
  for (const char* name : {"a", "b", "c"}) Write(name, 1);
  Reload();
  ASSERT_THAT(registry_.SetDefault("a"), IsOk());
  Delete("a");
  Delete("b");
  EXPECT_THAT(Reload().problems, ElementsAre(AllOf(HasSubstr("a/1 stays"), HasSubstr("last")),
                                             AllOf(HasSubstr("b/1 stays"), HasSubstr("stable"))));
  EXPECT_EQ(Served(), "a/1 b/1 c/1");
}

TEST_F(ModelManagerTest, MovesALabelBeforeItUnloadsWhatThatLeaves) {
  manager_.SetLabels({{"a", "stable", 1}, {"a", "old", 2}});
  for (const int version : {1, 2, 3}) Write("a", version);
  Reload();
  manager_.SetLabels({{"a", "stable", 3}});
  Delete("a/1");
  EXPECT_THAT(Reload().unloaded, ElementsAre("a/1"));
  EXPECT_THAT(Answer({"a", {}, "stable"}), HasSubstr("a/3"));
  EXPECT_THAT(Answer({"a", {}, "old"}),
              HasSubstr("expected a label of model a (stable), got \"old\""));
}

TEST_F(ModelManagerTest, LabelMovedByTheOperatorStays) {
  manager_.SetLabels({{"a", "stable", 1}});
  for (const int version : {1, 2}) Write("a", version);
  Reload();
  ASSERT_THAT(registry_.SetLabel("a", "stable", 2), IsOk());
  ASSERT_THAT(registry_.SetLabel("a", "mine", 2), IsOk());
  Reload();
  EXPECT_THAT(Answer({"a", {}, "stable"}), HasSubstr("a/2"));
  EXPECT_THAT(Answer({"a", {}, "mine"}), HasSubstr("a/2"));
}

TEST_F(ModelManagerTest, LabelOfAFailedVersionIsRetried) {
  manager_.SetLabels({{"a", "canary", 2}});
  Write("a", 1);
  Write("a", 2, "bad");
  EXPECT_THAT(Reload().refused_labels, ElementsAre(HasSubstr("\"canary\" points at version 2")));
  Write("a", 2, "good");
  EXPECT_THAT(Reload().refused_labels, IsEmpty());
  EXPECT_EQ(Answer({"a", {}, "canary"}), "a/2 good");
}

TEST_F(ModelManagerTest, LoadReportsMissingAndBrokenVersionsAndLoadsAgainWhatHasNotChanged) {
  Write("a", 1);
  Write("a", 2, "bad");
  Reload();
  const std::weak_ptr<const engine::Synthesizer> before =
      std::get<ServedModel>(registry_.Find({})).model;
  EXPECT_THAT(manager_.Load("a", 1), IsOk());
  EXPECT_TRUE(before.expired());
  EXPECT_THAT(manager_.Load("../a", 1), StatusIs(kNotFound, HasSubstr("../a")));
  EXPECT_THAT(manager_.Load("a", 2),
              StatusIs(kFailedPrecondition, HasSubstr("weights: expected 9 bytes, got 7")));
}

TEST_F(ModelManagerTest, UnloadedVersionStaysUnloadedUntilItIsLoadedByName) {
  for (const int version : {1, 2}) Write("a", version);
  Reload();
  events_.Take();
  EXPECT_THAT(manager_.Unload("a", 2), IsOk());
  EXPECT_THAT(events_.Take(), ElementsAre("unloaded a/2"));
  EXPECT_EQ(StatusOf("a", 2).state, ModelState::kUnloaded);
  Reload();
  EXPECT_EQ(Served(), "a/1");
  EXPECT_THAT(manager_.Load("a", 2), IsOk());
  Reload();
  EXPECT_EQ(Served(), "a/2 a/1");
}

TEST(ModelManagerWithoutRepositoryTest, ServesWhatItIsGivenAndHasLabels) {
  ModelRegistry registry;
  Events events;
  ModelManager manager(registry, events);
  manager.Add({"embedded/fake/1", std::make_shared<FakeSynthesizer>(), 0.5});
  manager.Add({"embedded", absl::DataLossError("torn"), 0.5});
  EXPECT_THAT(events.Take(), ElementsAre("loaded embedded/fake/1", "refused embedded"));
  manager.SetLabels({{"fake", "stable", 1}, {"fake", "canary", 2}});
  const absl::StatusOr<ReloadReport> report = manager.Reload(kNever);
  ASSERT_THAT(report, IsOk());
  EXPECT_THAT(report->refused_labels, ElementsAre(HasSubstr("canary")));
  EXPECT_THAT(registry.List()[0].version_labels, ElementsAre("stable"));
  EXPECT_THAT(manager.Load("fake", 1), StatusIs(kFailedPrecondition, HasSubstr("repository")));
  EXPECT_THAT(manager.Unload("fake", 1), StatusIs(kFailedPrecondition, HasSubstr("repository")));
}

}  // namespace
}  // namespace duet::server::registry
