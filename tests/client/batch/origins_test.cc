#include "client/batch/origins.h"

#include <nlohmann/json.hpp>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::batch {
namespace {

const MadeBy kFirst = {true, "cpu, bf16, AVX-512", "1.0.0"};

TEST(Makers, AcceptAnswersOfAModelThatWereMadeAlike) {
  Makers makers;
  EXPECT_THAT(makers.Check("sbu@2", kFirst), IsOk());
  EXPECT_THAT(makers.Check("sbu@2", kFirst), IsOk());
  // The server's default for clean-up depends on the model.
  EXPECT_THAT(makers.Check("sbu@1", {false, kFirst.engine, kFirst.server_version}), IsOk());
}

TEST(Makers, NameEveryDifference) {
  Makers makers;
  EXPECT_THAT(makers.Check("sbu@2", kFirst), IsOk());
  EXPECT_THAT(makers.Check("sbu@2", {false, "cpu, f32, AVX-512", "1.1.0"}),
              StatusIs(absl::StatusCode::kFailedPrecondition,
                       "model sbu@2: an answer was made in another way than the set's first one: "
                       "clean_up: expected on, got off; engine: expected \"cpu, bf16, AVX-512\", "
                       "got \"cpu, f32, AVX-512\"; server_version: expected \"1.0.0\", got "
                       "\"1.1.0\""));
  EXPECT_THAT(makers.Check("sbu@2", kFirst), IsOk());
}

TEST(Makers, RecordsHoldWhatAnAnswerWasMadeBy) {
  v1::IndexEntry record;
  record.set_model("sbu@2");
  EXPECT_EQ(MadeByOf(record), std::nullopt) << "of an item without an answer";
  Makers makers;
  EXPECT_THAT(makers.CheckRecord(record), IsOk());
  nlohmann::ordered_json json;
  AddMadeBy(kFirst, &json);
  EXPECT_EQ(json.dump(), R"({"cleaned_up":true,"engine":"cpu, bf16, AVX-512",)"
                         R"("server_version":"1.0.0"})");
  record.set_cleaned_up(true);
  record.set_engine(kFirst.engine);
  record.set_server_version(kFirst.server_version);
  EXPECT_THAT(makers.CheckRecord(record), IsOk());
  record.set_cleaned_up(false);
  EXPECT_THAT(makers.CheckRecord(record),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("clean_up: expected on")));
}

}  // namespace
}  // namespace duet::client::batch
