#include "client/batch/item_table.h"

#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_split.h"
#include "client/batch/archive.h"
#include "client/batch/durable_file.h"
#include "client/batch/record.h"
#include "client/batch/shard_offsets.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

JobIdentity Identity(Packing packing, const Splits& splits = {}) {
  JobIdentity identity;
  identity.packing = packing;
  ModelChoice model;
  model.name = "one";
  model.version = 2;
  identity.models = {model};
  DescribedModel described;
  described.interaction_classes = {"kick", "hug"};
  described.free_for_all_uses = true;
  identity.description.models = {described};
  identity.description.splits = splits;
  return identity;
}

ordered_json Record(const std::string& name, const std::string& leader_sha256 = "80000000") {
  return {{"item", 0},
          {"id", "0123"},
          {"state", "done"},
          {"name", name},
          {"leader", "walks/a.bvh"},
          {"leader_sha256", leader_sha256},
          {"side", "left"},
          {"labels", {{"hug", 0.5}, {"kick", -1}}},
          {"model", "one@2"},
          {"seed", 18446744073709551615u},
          {"frames", 3},
          {"frame_rate_hz", 30.0},
          {"quality", {{"distance_metres", 1.25}}},
          {"files",
           {{{"path", name + ".glb"}, {"bytes", 5}, {"sha256", "aa"}},
            {{"path", name + ".npy"}, {"bytes", 700}, {"sha256", "bb"}}}}};
}

class ItemTablesTest : public ::testing::Test {
 protected:
  // The table of a split, row by row: column to cell. Cells have no commas in these tests.
  std::vector<std::map<std::string, std::string>> Rows(const std::string& split) {
    std::vector<std::string> lines = absl::StrSplit(
        test::ReadTestFile(folder_.path() / TablePath(split)), '\n', absl::SkipEmpty());
    const std::vector<std::string> header = absl::StrSplit(lines.at(0), ',');
    std::vector<std::map<std::string, std::string>> rows;
    for (size_t i = 1; i < lines.size(); ++i) {
      const std::vector<std::string> cells = absl::StrSplit(lines[i], ',');
      EXPECT_EQ(cells.size(), header.size()) << lines[i];
      rows.emplace_back();
      for (size_t column = 0; column < cells.size(); ++column) {
        rows.back()[header[column]] = cells[column];
      }
    }
    return rows;
  }

  void Write(const JobIdentity& identity, const ShardList& shards,
             const std::vector<ordered_json>& records) {
    WrittenSetFiles files(temporary_.path(), folder_.path());
    ItemTables tables(identity, shards);
    ASSERT_THAT(tables.Open(&files), IsOk());
    for (size_t i = 0; i < records.size(); ++i) {
      ASSERT_THAT(tables.Add(static_cast<int64_t>(i), records[i]), IsOk());
    }
    ASSERT_THAT(tables.Finish(), IsOk());
  }

  test::TemporaryFolder folder_, temporary_;
};

TEST_F(ItemTablesTest, RowHasTheItemsFacts) {
  ordered_json record = Record("a-hug");
  record["files"].erase(0);
  Write(Identity(Packing::kNone), {}, {record});
  auto rows = Rows("train");
  ASSERT_THAT(rows, SizeIs(1));
  const std::map<std::string, std::string> expected = {{"id", "0123"},
                                                       {"name", "a-hug"},
                                                       {"split", "train"},
                                                       {"leader", "walks/a.bvh"},
                                                       {"interaction_class", "hug"},
                                                       {"label_hug", "0.5"},
                                                       {"label_kick", "-1"},
                                                       {"model", "one@2"},
                                                       {"free_for_all_uses", "true"},
                                                       {"seed", "18446744073709551615"},
                                                       {"distance_metres", "1.25"},
                                                       {"lean_degrees", ""},
                                                       {"skeleton", "0"},
                                                       {"shard", ""},
                                                       {"path", "a-hug.npy"},
                                                       {"offset", "0"},
                                                       {"bytes", "700"},
                                                       {"files", "a-hug.npy"}};
  for (const auto& [column, cell] : expected) EXPECT_EQ(rows[0][column], cell) << column;
}

TEST_F(ItemTablesTest, CellsAreQuotedAsCsv) {
  ordered_json record = Record("a");
  record["leader"] = "a, \"b\"\nc";
  Write(Identity(Packing::kNone), {}, {record});
  EXPECT_THAT(test::ReadTestFile(folder_ / "items/train.csv"),
              ::testing::HasSubstr(",\"a, \"\"b\"\"\nc\","));
}

TEST_F(ItemTablesTest, WeightsThatChangeAreInTheirOwnColumn) {
  ordered_json record = Record("a");
  record.erase("labels");
  record["files"].erase(0);
  record["keyframes"] = {{{"frame", 0}, {"labels", ordered_json::object()}}};
  Write(Identity(Packing::kNone), {}, {record});
  // Its JSON has a comma, so only look at the beginning of the cell.
  EXPECT_THAT(test::ReadTestFile(folder_ / "items/train.csv"),
              ::testing::HasSubstr(",none,,,\"[{\"\"frame\"\":0"));
}

TEST_F(ItemTablesTest, EachSplitHasItsTable) {
  ordered_json test = Record("a", "00000000"), train = Record("b");
  for (ordered_json* record : {&test, &train}) (*record)["files"].erase(0);
  Write(Identity(Packing::kNone, {0.25, 0.25}), {}, {test, train});
  EXPECT_THAT(Rows("test"), SizeIs(1));
  EXPECT_THAT(Rows("train"), SizeIs(1));
  EXPECT_THAT(Rows("validation"), SizeIs(0));
}

TEST_F(ItemTablesTest, OffsetsAreWhereTheArchiveHasTheFiles) {
  const std::string deep = "walks/" + std::string(120, 'x');  // has a pax header in a tar
  for (const Packing packing : {Packing::kTar, Packing::kNpz}) {
    const std::vector<ordered_json> records = {Record("a"), Record(deep), Record("b")};
    const std::filesystem::path file = folder_ / ShardName(packing, 0);
    DurableFile durable(temporary_ / "shard");
    ASSERT_THAT(durable.Open(), IsOk());
    const auto archive = MakeArchive(packing, &durable);
    for (const ordered_json& record : records) {
      const std::string name = record["name"];
      ASSERT_THAT(archive->Add(name + ".glb", std::string(5, 'g')), IsOk());
      ASSERT_THAT(archive->Add(name + ".npy", name + std::string(700 - name.size(), 'n')), IsOk());
      ASSERT_THAT(archive->AddRecord(name, Line(record) + "\n"), IsOk());
    }
    ASSERT_THAT(archive->Finish(), IsOk());
    ASSERT_THAT(durable.Finish(file), IsOk());
    const std::string content = test::ReadTestFile(file);

    ShardOffsets offsets(packing);
    for (const ordered_json& record : records) {
      const std::string name = record["name"];
      const uint64_t offset = offsets.Next(0, record, 1);
      ASSERT_LT(offset + 700, content.size());
      EXPECT_EQ(content.substr(offset, name.size() + 1), name + "n");
      EXPECT_EQ(content.substr(offset + 699, 1), "n");
    }
  }
}

}  // namespace
}  // namespace duet::client::batch
