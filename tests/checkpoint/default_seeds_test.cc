#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "model/checkpoint/manifest.h"
#include "tests/support/matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

TEST(DefaultSeeds, AreReadAndWritten) {
  Manifest manifest = test::CompleteManifest();
  EXPECT_THAT(ParseManifest(SerializeManifest(manifest))->model.default_seeds, IsEmpty());
  manifest.model.default_seeds = {3, 18446744073709551615u};
  EXPECT_THAT(ParseManifest(SerializeManifest(manifest))->model.default_seeds,
              ElementsAre(3, 18446744073709551615u));
}

TEST(DefaultSeeds, MustBeWholeNumbers) {
  for (const nlohmann::json& seed :
       {nlohmann::json(-1), nlohmann::json(0.5), nlohmann::json("1")}) {
    nlohmann::json root = nlohmann::json::parse(SerializeManifest(test::CompleteManifest()));
    root["default_seeds"] = {7, seed};
    EXPECT_THAT(ParseManifest(root.dump()),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         HasSubstr("default_seeds[1]: expected a whole number from 0, got")));
  }
}

}  // namespace
}  // namespace duet::checkpoint
