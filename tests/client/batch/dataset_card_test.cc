#include "client/batch/dataset_card.h"

#include <optional>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

class DatasetCardTest : public ::testing::Test {
 protected:
  void AddModel(const std::string& name, std::optional<bool> free, const std::string& terms) {
    ModelChoice choice;
    choice.name = name;
    choice.version = 1;
    identity_.models.push_back(choice);
    DescribedModel model;
    model.free_for_all_uses = free;
    model.terms = terms;
    model.interaction_classes = {"kick"};
    identity_.description.models.push_back(model);
  }
  static nlohmann::ordered_json Done(const std::string& split) {
    return {{"frames", 2}, {"frame_rate_hz", 30}, {"split", split}};
  }
  std::string Card() const { return DatasetCard(identity_, counts_, done_); }

  JobIdentity identity_;
  SetCounts counts_;
  DoneItems done_;
};

TEST_F(DatasetCardTest, OneModelThatIsNotFreeDecidesTheLicense) {
  AddModel("salsa", true, "Anybody may use it.");
  EXPECT_THAT(Card(), HasSubstr("\nlicense: other\nlicense_name: free-for-all-uses\n"));
  AddModel("sbu", false, "For research.\nOnly.");
  EXPECT_THAT(Card(), HasSubstr("\nlicense_name: terms-of-the-models\n"));
  EXPECT_THAT(Card(), HasSubstr("- `salsa@1`: **free for all uses.** Anybody may use it.\n"));
  EXPECT_THAT(Card(), HasSubstr("- `sbu@1`: **not free for all uses.** For research. Only.\n"));
}

TEST_F(DatasetCardTest, ModelWithoutAStatementIsNotFree) {
  AddModel("old", std::nullopt, "");
  EXPECT_THAT(Card(), HasSubstr("license_name: terms-of-the-models"));
  EXPECT_THAT(Card(), HasSubstr("`old@1`: **not free for all uses.** The model states no terms."));
}

TEST_F(DatasetCardTest, ConfigurationNamesTheTablesOfSplitsWithItems) {
  AddModel("one", true, "");
  identity_.description.splits = {0.1, 0.1};
  EXPECT_THAT(Card(), Not(HasSubstr("configs:")));
  done_.Add(Done("train"));
  done_.Add(Done("test"));
  EXPECT_THAT(Card(), HasSubstr("configs:\n- config_name: default\n  data_files:\n"
                                "  - split: train\n    path: items/train.csv\n"
                                "  - split: test\n    path: items/test.csv\n"
                                "dataset_info:\n  features:\n  - name: \"id\"\n"
                                "    dtype: string\n"));
  EXPECT_THAT(Card(), HasSubstr("| validation | 0 | [items/validation.csv]"));
}

TEST_F(DatasetCardTest, CodeReadsTheFirstSplitWithItems) {
  AddModel("one", true, "");
  identity_.description.formats = {Format::kNpy};
  identity_.description.splits = {0, 0.5};
  EXPECT_THAT(Card(), Not(HasSubstr("```python")));
  done_.Add(Done("test"));
  EXPECT_THAT(Card(), HasSubstr("pandas.read_csv(\"items/test.csv\")"));
}

TEST_F(DatasetCardTest, NamesInTheFrontMatterAreQuoted) {
  AddModel("a: \"b\"", true, "");
  EXPECT_THAT(Card(), StartsWith("---\npretty_name: \"Reactions by a: \\\"b\\\"@1\"\n"));
}

TEST_F(DatasetCardTest, OnlyACardWithTheMarkIsReplaced) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(HasForeignCard(folder.path()));
  test::WriteTestFile(folder / "README.md", Card());
  EXPECT_FALSE(HasForeignCard(folder.path()));
  test::WriteTestFile(folder / "README.md", "# My walks\n");
  EXPECT_TRUE(HasForeignCard(folder.path()));
}

}  // namespace
}  // namespace duet::client::batch
