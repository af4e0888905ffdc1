#include "client/batch/record.h"

#include <nlohmann/json.hpp>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

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
  for (const char* field : {"labels", "keyframes"}) {
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

}  // namespace
}  // namespace duet::client::batch
