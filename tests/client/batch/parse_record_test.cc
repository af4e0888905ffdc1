#include "client/batch/parse_record.h"

#include <nlohmann/json.hpp>
#include <string>

#include "client/batch/index.h"
#include "client/batch/record.h"
#include "client/batch/verify.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;
using test::WriteTestFile;

constexpr auto kDataLoss = absl::StatusCode::kDataLoss;

ordered_json Done() {
  return ordered_json::parse(R"({
    "item": 0, "id": "01", "state": "done", "name": "kick/a", "side": "left", "model": "sbu@2",
    "labels": {"kick": 1}, "frames": 2, "frame_rate_hz": 15,
    "quality": {"distance_metres": 1, "recognised_class": "kick", "class_probability": 0.5},
    "files": [{"path": "kick/a.npy", "bytes": 12, "sha256": "ab"}], "extra": {"note": "x"}})");
}

TEST(ParseRecord, ReadsAWrittenRecord) {
  const auto record = ParseRecord(Line(Done()));
  ASSERT_THAT(record, IsOk());
  EXPECT_EQ(*record, Done());
}

TEST(ParseRecord, RejectsInvalidRecords) {
  EXPECT_THAT(ParseRecord(""), StatusIs(kDataLoss, HasSubstr("is not a record")));
  EXPECT_THAT(ParseRecord("{\"state\": "), StatusIs(kDataLoss, HasSubstr("is not a record")));
  EXPECT_THAT(ParseRecord("[]"), StatusIs(kDataLoss, HasSubstr("is not a record")));
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  EXPECT_THAT(ParseRecord("{\"state\": " + deep + "}"),
              StatusIs(kDataLoss, HasSubstr("is not a record")));
}

// A field of the right record that is gone or of another type: the readers would throw.
TEST(ParseRecord, NamesTheMissingOrMistypedField) {
  for (const char* field :
       {"state", "name", "id", "side", "model", "frames", "frame_rate_hz", "quality", "files"}) {
    ordered_json record = Done();
    record.erase(field);
    EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr(field)));
    record[field] = true;
    EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr(field)));
  }
  for (const char* field : {"labels", "keyframes", "shard"}) {
    ordered_json record = Done();
    record[field] = true;
    EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr(field)));
  }
  ordered_json record = Done();
  record["quality"]["distance_metres"] = "far";
  EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr("quality")));
  record = Done();
  record["quality"]["recognised_class"] = 1;
  EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr("quality")));
  record = Done();
  record["files"][0]["bytes"] = -1;
  EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr("files")));
  record["files"] = ordered_json::array();
  EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr("files")));
}

TEST(ParseRecord, EachStateHasItsFields) {
  EXPECT_THAT(ParseRecord(R"({"state": "failed", "name": "a"})"), IsOk());
  ordered_json record = Done();
  record["state"] = "rejected";
  EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr("reasons")));
  record["reasons"] = {"leans"};
  EXPECT_THAT(ParseRecord(Line(record)), IsOk());
  record["state"] = "other";
  EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr("state")));
}

TEST(Verify, ReportsAnIndexAndRefusesASummaryOfOtherTypes) {
  const test::TemporaryFolder folder;
  WriteTestFile(folder / "index.jsonl", R"({"files": [{"path": 1, "sha256": 2}]})"
                                        "\n");
  WriteTestFile(folder / "summary.json", R"({"planned": 1, "whole_plan": true, "missing": 0})");
  auto report = Verify(folder.path());
  ASSERT_THAT(report, IsOk());
  EXPECT_THAT(report->problems, ElementsAre(HasSubstr("index.jsonl:1: is no entry")));
  WriteTestFile(folder / "index.jsonl", Line(Done()) + "\n");
  report = Verify(folder.path());
  ASSERT_THAT(report, IsOk());
  EXPECT_EQ(report->problem_count, 1);  // the file is not there
  WriteTestFile(folder / "summary.json", R"({"planned": "1", "whole_plan": true, "missing": 0})");
  EXPECT_THAT(ReadPlanned(folder.path()), StatusIs(kDataLoss, HasSubstr("is not a summary")));
}

}  // namespace
}  // namespace duet::client::batch
