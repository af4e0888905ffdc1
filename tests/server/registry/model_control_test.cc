#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "server/registry/model_manager.h"
#include "tests/server/support/fakes.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::server::registry {
namespace {

using test::FakeSynthesizer;
using test::TemporaryFolder;
using test::WriteTestFile;

namespace fs = std::filesystem;

class Events final : public ModelObserver {
 public:
  void Loaded(const LoadReport&, bool) override {}
  void Unloaded(const std::string&) override {}
  void Forgotten(const std::string&) override {}
  void Scanned(const std::vector<SkippedFolder>&) override {}
  void Reloaded(const absl::StatusOr<ReloadReport>& report) override {
    reloaded.push_back(report.ok() ? "ok" : std::string(report.status().message()));
  }
  void Changed() override { ++changed; }

  // Read after what changes them is done.
  std::vector<std::string> reloaded;
  int changed = 0;
};

class ModelControlTest : public ::testing::Test {
 protected:
  // Checkpoints of the fake model's name; loading one waits until the gate is open.
  void SetUp() override {
    manager_.UseRepository(folder_.path(),
                           [this](const fs::path& place)
                               -> absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> {
                             gate_.Pass();
                             engine::ModelDescription description = test::FakeDescription();
                             description.version = std::stoi(place.filename().string());
                             return std::make_shared<FakeSynthesizer>(description);
                           });
  }
  void Write(const std::string& version) {
    fs::create_directories(folder_ / ("fake/" + version));
    WriteTestFile(folder_ / ("fake/" + version + "/manifest.json"), "{}");
  }

  // Reloads, and returns the report when it is there.
  static absl::StatusOr<ReloadReport> Reload(ModelControl& control) {
    std::promise<absl::StatusOr<ReloadReport>> reloaded;
    control.Reload([&](const auto& report) { reloaded.set_value(report); });
    return reloaded.get_future().get();
  }

  TemporaryFolder folder_;
  test::Gate gate_;
  Events events_;
  ModelRegistry registry_;
  ModelManager manager_{registry_, events_};
};

TEST_F(ModelControlTest, ReloadsWhileEverythingElseGoesOn) {
  Write("1");
  ModelControl control(manager_, events_);
  std::promise<absl::StatusOr<ReloadReport>> reloaded;
  control.Reload([&](const auto& report) { reloaded.set_value(report); });
  gate_.WaitUntilReached();
  ASSERT_EQ(control.List().size(), 1u);
  EXPECT_EQ(control.List()[0].state, ModelState::kLoading);
  EXPECT_THAT(registry_.SetLabel("fake", "stable", 1),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("not served")));
  gate_.Open();
  const absl::StatusOr<ReloadReport> report = reloaded.get_future().get();
  ASSERT_THAT(report, IsOk());
  EXPECT_THAT(report->loaded, ElementsAre("fake/1"));
  EXPECT_EQ(control.List()[0].state, ModelState::kServed);
  EXPECT_THAT(registry_.SetLabel("fake", "stable", 1), IsOk());
  EXPECT_THAT(registry_.DeleteLabel("fake", "stable"), IsOk());
  EXPECT_THAT(events_.reloaded, ElementsAre("ok"));
  EXPECT_EQ(events_.changed, 1);
}

TEST_F(ModelControlTest, ReloadsSettingsBeforeTheRepository) {
  Write("1");
  gate_.Open();
  manager_.SetLabels({{"fak", "stable", 1}});
  ModelControl control(manager_, events_);
  std::vector<std::string> order;
  control.AddReloadable({"tokens", [&] {
                           order.push_back("tokens");
                           return absl::InvalidArgumentError("line 3");
                         }});
  control.AddReloadable({"certificates", [&] {
                           order.push_back("certificates");
                           return absl::OkStatus();
                         }});
  const absl::StatusOr<ReloadReport> report = Reload(control);
  ASSERT_THAT(report, IsOk());
  EXPECT_THAT(order, ElementsAre("tokens", "certificates"));
  EXPECT_THAT(
      report->problems,
      ElementsAre("tokens: line 3",
                  HasSubstr("version_labels[0].model: expected one of: fake, got \"fak\"")));
  EXPECT_THAT(report->loaded, ElementsAre("fake/1")) << "what failed holds up nothing";
}

TEST_F(ModelControlTest, RejectedFileIsAProblemUntilItIsFixed) {
  Write("1");
  gate_.Open();
  ModelControl control(manager_, events_);
  absl::Status tokens = absl::InvalidArgumentError("line 3");
  absl::Status certificates;
  control.AddReloadable({"tokens", [&] { return tokens; }});
  control.AddReloadable(
      {"certificates", [] { return absl::OkStatus(); }, [&] { return certificates; }});
  EXPECT_THAT(control.problems(), IsEmpty()) << "not reloaded yet";
  const auto reload = [&control] { return Reload(control)->problems; };
  EXPECT_THAT(reload(), ElementsAre("tokens: line 3"));
  EXPECT_THAT(control.problems(), ElementsAre("tokens: line 3"));
  certificates = absl::InvalidArgumentError("expired");
  EXPECT_THAT(control.problems(), ElementsAre("tokens: line 3", "certificates: expired"));
  tokens = absl::OkStatus();
  EXPECT_THAT(reload(), ElementsAre("certificates: expired")) << "though reading it again succeeds";
  EXPECT_THAT(control.problems(), ElementsAre("certificates: expired"));
}

TEST_F(ModelControlTest, LoadsAndUnloadsOneAfterTheOther) {
  Write("1");
  Write("2");
  gate_.Open();
  ModelControl control(manager_, events_);
  std::promise<std::vector<absl::Status>> all;
  std::vector<absl::Status> statuses;
  const auto done = [&](const absl::Status& status) {
    statuses.push_back(status);
    if (statuses.size() == 3) all.set_value(statuses);
  };
  control.Load("fake", 1, done);
  control.Load("fake", 2, done);
  control.Unload("fake", 1, done);
  EXPECT_THAT(all.get_future().get(), ElementsAre(IsOk(), IsOk(), IsOk()));
  ASSERT_EQ(registry_.List().size(), 1u);
  EXPECT_EQ(registry_.List()[0].model->description().version, 2);
}

TEST_F(ModelControlTest, StopCancelsWorkThatHasNotStarted) {
  Write("1");
  Write("2");
  std::promise<absl::Status> first;
  std::promise<absl::Status> second;
  std::promise<absl::Status> third;
  {
    ModelControl control(manager_, events_);
    control.Reload([&](const auto& report) { first.set_value(report.status()); });
    gate_.WaitUntilReached();
    control.Load("fake", 2, [&](const absl::Status& status) { second.set_value(status); });
    control.Stop();
    EXPECT_THAT(second.get_future().get(),
                StatusIs(absl::StatusCode::kCancelled, HasSubstr("stopping")));
    control.Unload("fake", 2, [&](const absl::Status& status) { third.set_value(status); });
    EXPECT_THAT(third.get_future().get(),
                StatusIs(absl::StatusCode::kCancelled, HasSubstr("stopping")));
    gate_.Open();
  }
  EXPECT_THAT(first.get_future().get(), StatusIs(absl::StatusCode::kCancelled, HasSubstr("stop")))
      << "after the checkpoint under way";
  ASSERT_EQ(registry_.List().size(), 1u);
  EXPECT_EQ(registry_.List()[0].model->description().version, 2);
}

}  // namespace
}  // namespace duet::server::registry
