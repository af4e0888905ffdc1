#include <gmock/gmock.h>

#include "model/checkpoint/checkpoint.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

using test::ReadTestFile;
using test::TemporaryFolder;
using test::TinyCheckpoint;
using test::TinyManifest;

Manifest Trained() {
  Manifest manifest = TinyManifest();
  manifest.model.name = "studio";
  manifest.model.version = 3;
  manifest.model.touching_classes = {"hug"};
  manifest.git_revision = "abc1234";
  manifest.created = "2026-01-02T03:04:05Z";
  manifest.training = {{"data", "studio pairs"}, {"sequences", "20"},  {"seconds", "61"},
                       {"people", "ann bo"},     {"levelled", "true"}, {"losses.bone", "0.01"}};
  manifest.metrics = {{"validation.afd", 0.51239}};
  return manifest;
}

TEST(ModelCardTest, ShowsTheContentOfTheManifest) {
  const std::string card = ModelCard(Trained());
  EXPECT_THAT(card, AllOf(HasSubstr("# studio, version 3\n"),
                          HasSubstr("| classes | kick, hug; bodies may touch in hug |"),
                          HasSubstr("3 joints about torso, in 2 parts: trunk, legs"),
                          HasSubstr("studio pairs: 20 sequences of two people, 61 s in total; "
                                    "people: ann bo; levelled"),
                          HasSubstr("2026-01-02T03:04:05Z, by the code of revision abc1234")));
  EXPECT_THAT(card, AllOf(HasSubstr("| validation.afd | 0.5124 |"),
                          HasSubstr("| losses.bone | 0.01 |"), Not(HasSubstr("| sequences |")),
                          HasSubstr("Terms: those of the data set studio pairs"),
                          Not(HasSubstr("No sequences were held out"))));
}

TEST(ModelCardTest, QuotesTheTermsOfTheManifest) {
  Manifest manifest = Trained();
  manifest.model.terms = "For members of the studio.";
  EXPECT_THAT(ModelCard(manifest), AllOf(HasSubstr("## Terms\n\nFor members of the studio.\n"),
                                         Not(HasSubstr("complete this sentence"))));
}

TEST(ModelCardTest, StatesThatAModelIsFreeForAllUses) {
  Manifest manifest = Trained();
  manifest.model.free_for_all_uses = true;
  const std::string free =
      "## Terms\n\nAnybody may use and pass on the weights and their output for any purpose.";
  EXPECT_THAT(ModelCard(manifest), HasSubstr(free + "\n"));
  manifest.model.terms = "Captured by the studio.";
  EXPECT_THAT(ModelCard(manifest), HasSubstr(free + " Captured by the studio.\n"));
}

TEST(ModelCardTest, StatesWhatIsUnknown) {
  Manifest manifest = Trained();
  manifest.training.erase("people");
  manifest.metrics.clear();
  manifest.git_revision.clear();
  EXPECT_THAT(ModelCard(manifest),
              AllOf(HasSubstr("people: not named"), HasSubstr("revision unknown"),
                    HasSubstr("No sequences were held out from training")));
}

TEST(ModelCardTest, IsWrittenBesideTheManifest) {
  const TemporaryFolder folder;
  ASSERT_THAT(WriteCheckpoint(folder / "1", TinyCheckpoint()), IsOk());
  const absl::StatusOr<Checkpoint> read = ReadCheckpoint(folder / "1");
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(ReadTestFile(folder / "1" / kModelCardFile), ModelCard(read->manifest));
}

TEST(CheckManifestTest, ReportsWhatWriteCheckpointWouldReject) {
  Manifest manifest = Trained();
  manifest.created.clear();
  EXPECT_THAT(CheckManifest(manifest), IsOk());
  manifest.model.classes = {"kick", "kick"};
  EXPECT_THAT(CheckManifest(manifest),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("repeated")));
}

TEST(ToPlainNameTest, TurnsAnyTextIntoAName) {
  EXPECT_EQ(ToPlainName("studio-2.b_c"), "studio-2.b_c");
  EXPECT_EQ(ToPlainName("My studio/2"), "My_studio_2");
  EXPECT_EQ(ToPlainName(".hidden"), "_.hidden");
  EXPECT_EQ(ToPlainName(""), "_");
  EXPECT_EQ(ToPlainName(std::string(100, 'x')), std::string(64, 'x'));
}

}  // namespace
}  // namespace duet::checkpoint
