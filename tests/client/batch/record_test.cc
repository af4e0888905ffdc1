#include "client/batch/record.h"

#include <nlohmann/json.hpp>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;
using ::testing::_;

constexpr auto kDataLoss = absl::StatusCode::kDataLoss;

ordered_json Done() {
  return ordered_json::parse(R"({
    "item": 0, "id": "01", "state": "done", "name": "kick/a", "side": "left", "model": "sbu@2",
    "labels": {"kick": 1}, "frames": 2, "frame_rate_hz": 15,
    "quality": {"distance_metres": 1},
    "files": [{"path": "kick/a.npy", "bytes": 12, "sha256": "ab"}], "extra": {"note": "x"}})");
}

TEST(ParseRecord, ReadsAWrittenRecord) {
  ordered_json written = Done();
  written["a field of a later version"] = {1, 2};
  const auto record = ParseRecord(Line(written));
  ASSERT_THAT(record, IsOk());
  EXPECT_EQ(record->state(), kDone);
  EXPECT_EQ(record->name(), "kick/a");
  EXPECT_EQ(record->labels().at("kick"), 1);
  EXPECT_EQ(record->files(0).bytes(), 12u);
  EXPECT_EQ(record->extra().at("note"), "x");
}

TEST(ParseRecord, RejectsInvalidRecords) {
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  for (const std::string& text : {std::string(), std::string("{\"state\": "), std::string("[]"),
                                  "{\"state\": " + deep + "}"}) {
    EXPECT_THAT(ParseRecord(text), StatusIs(kDataLoss, HasSubstr("is not a record")));
  }
}

TEST(ParseRecord, NamesAMissingField) {
  for (const char* field :
       {"state", "name", "id", "side", "model", "frames", "frame_rate_hz", "quality", "files"}) {
    ordered_json record = Done();
    record.erase(field);
    EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr(field)));
    record[field] = true;
    EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, _)) << field;
  }
  ordered_json record = Done();
  record["quality"]["distance_metres"] = "far";
  EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr("distance_metres")));
  record = Done();
  record["files"][0]["bytes"] = -1;
  EXPECT_THAT(ParseRecord(Line(record)), StatusIs(kDataLoss, HasSubstr("bytes")));
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
