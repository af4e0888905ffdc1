#include "server/registry/model_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::registry {
namespace {

using test::FakeDescription;
using test::FakeSynthesizer;

constexpr auto kNotFound = absl::StatusCode::kNotFound;

std::shared_ptr<const engine::Synthesizer> Model(const std::string& name, int version) {
  engine::ModelDescription description = FakeDescription();
  description.name = name;
  description.version = version;
  return std::make_shared<FakeSynthesizer>(description);
}

// "name/version" of what answers a query, or "field: description" of what was not found.
std::string Answer(const ModelRegistry& registry, const ModelQuery& query) {
  const FindResult found = registry.Find(query);
  if (const auto* not_found = std::get_if<ModelNotFound>(&found)) {
    return not_found->field + ": " + not_found->description;
  }
  const engine::ModelDescription& model = std::get<ServedModel>(found).model->description();
  return model.name + "/" + std::to_string(model.version);
}

TEST(ModelRegistryTest, ReturnsTheNewestVersionByDefault) {
  ModelRegistry registry;
  EXPECT_THAT(Answer(registry, {}), HasSubstr("expected a served model (none)"));
  for (const int version : {2, 10, 9}) registry.Serve(Model("duet", version));
  EXPECT_EQ(Answer(registry, {"duet", {}, {}}), "duet/10");
  EXPECT_EQ(Answer(registry, {"duet", 2, {}}), "duet/2");
  EXPECT_EQ(Answer(registry, {"", 9, {}}), "duet/9");
}

TEST(ModelRegistryTest, FirstNameIsTheDefaultUntilOneIsSet) {
  ModelRegistry registry;
  registry.Serve(Model("b", 1));
  registry.Serve(Model("a", 1));
  EXPECT_EQ(Answer(registry, {}), "a/1");
  ASSERT_THAT(registry.SetDefault("b"), IsOk());
  EXPECT_THAT(registry.SetDefault("z"),
              StatusIs(kNotFound, HasSubstr("expected a served model (a, b), got \"z\"")));
  EXPECT_EQ(Answer(registry, {}), "b/1");
}

TEST(ModelRegistryTest, DeletesALabel) {
  ModelRegistry registry;
  registry.Serve(Model("a", 1));
  ASSERT_THAT(registry.SetLabel("a", "stable", 1), IsOk());
  EXPECT_THAT(registry.DeleteLabel("a", "canary"),
              StatusIs(kNotFound, HasSubstr("(stable), got \"canary\"")));
  EXPECT_THAT(registry.DeleteLabel("b", "stable"), StatusIs(kNotFound, HasSubstr("model \"b\"")));
  EXPECT_THAT(registry.DeleteLabel("a", "stable"), IsOk());
  EXPECT_THAT(registry.List()[0].version_labels, IsEmpty());
}

TEST(ModelRegistryTest, RemovesWhatNothingNeeds) {
  constexpr auto kFailedPrecondition = absl::StatusCode::kFailedPrecondition;
  ModelRegistry registry;
  for (const int version : {1, 2}) registry.Serve(Model("a", version));
  registry.Serve(Model("b", 1));
  ASSERT_THAT(registry.SetLabel("a", "stable", 1), IsOk());
  EXPECT_THAT(registry.Remove("a", 1), StatusIs(kFailedPrecondition, HasSubstr("\"stable\"")));
  EXPECT_THAT(registry.Remove("a", 3), StatusIs(kNotFound, HasSubstr("version 3")));
  EXPECT_THAT(registry.Remove("c", 1), StatusIs(kNotFound, HasSubstr("model \"c\"")));
  EXPECT_THAT(registry.Remove("b", 1), IsOk());
  EXPECT_THAT(Answer(registry, {"b", {}, {}}), HasSubstr("expected a served model (a)"));
  EXPECT_THAT(registry.Remove("a", 2), IsOk());
  EXPECT_EQ(Answer(registry, {}), "a/1");
  ASSERT_THAT(registry.DeleteLabel("a", "stable"), IsOk());
  EXPECT_THAT(registry.Remove("a", 1), StatusIs(kFailedPrecondition, HasSubstr("last")));
}

TEST(ModelRegistryTest, NotFoundNamesTheFieldAndTheServedValues) {
  ModelRegistry registry;
  registry.Serve(Model("a", 1));
  registry.Serve(Model("a", 3));
  registry.Serve(Model("b", 1));
  ASSERT_THAT(registry.SetLabel("a", "stable", 1), IsOk());
  EXPECT_EQ(Answer(registry, {"z", {}, {}}),
            "model.name: expected a served model (a, b), got \"z\"");
  EXPECT_EQ(Answer(registry, {"a", 2, {}}),
            "model.version: expected a served version of model a (3, 1), got 2");
  EXPECT_EQ(Answer(registry, {"a", {}, "canary"}),
            "model.version_label: expected a label of model a (stable), got \"canary\"");
}

TEST(ModelRegistryTest, ListsByNameNewestFirst) {
  ModelRegistry registry;
  registry.Serve(Model("b", 1));
  registry.Serve(Model("a", 1));
  registry.Serve(Model("a", 2));
  ASSERT_THAT(registry.SetLabel("a", "stable", 1), IsOk());
  ASSERT_THAT(registry.SetLabel("a", "old", 1), IsOk());
  std::vector<std::string> models;
  for (const ServedModel& served : registry.List()) {
    const engine::ModelDescription& model = served.model->description();
    models.push_back(absl::StrCat(model.name, "/", model.version, served.is_default ? "*" : "", " ",
                                  absl::StrJoin(served.version_labels, "+")));
  }
  EXPECT_THAT(models, ElementsAre("a/2* ", "a/1 old+stable", "b/1 "));
}

}  // namespace
}  // namespace duet::server::registry
