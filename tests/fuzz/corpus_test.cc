// Runs every fuzz target over the inputs that are kept: the corpora that fuzzing begins with, and
// what fuzzing once found. No fuzzer is needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "model/base/random.h"
#include "tests/fuzz/batch_targets.h"
#include "tests/fuzz/checkpoint_targets.h"
#include "tests/fuzz/motion_targets.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/promises.h"
#include "tests/fuzz/server_targets.h"
#include "tests/support/temporary_folder.h"

namespace duet::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr int kMutations = 150;  // of each target; all together take some seconds

// How many mutations of each target are run: DUET_FUZZ_MUTATIONS, for a search without a fuzzer.
int MutationCount() {
  const char* count = std::getenv("DUET_FUZZ_MUTATIONS");
  int mutations = kMutations;
  EXPECT_TRUE(count == nullptr || absl::SimpleAtoi(count, &mutations)) << count;
  return mutations;
}

struct Target {
  const char* name;  // of its folders and its fuzzer
  Broken (*run)(absl::string_view input);
};

constexpr Target kTargets[] = {
    {"access_file", AccessFile},
    {"batch_job", BatchJob},
    {"batch_journal", BatchJournal},
    {"batch_manifest", BatchManifest},
    {"bvh", Bvh},
    {"call_metadata", CallMetadata},
    {"checkpoint", Checkpoint},
    {"csv", Csv},
    {"dataset_index", DatasetIndex},
    {"dataset_layout", DatasetLayout},
    {"gltf", Gltf},
    {"joint_map", JointMap},
    {"json_motion", JsonMotion},
    {"npy", Npy},
    {"recipe_json", RecipeJson},
    {"recipe_text", RecipeText},
    {"safetensors", Safetensors},
    {"sbu_text", SbuText},
    {"server_config_text", ServerConfigText},
    {"synthesis_fields", SynthesisFields},
    {"synthesis_request", SynthesisRequest},
};

fs::path FuzzFolder() {
  const char* source = std::getenv("DUET_SOURCE_DIR");
  EXPECT_NE(source, nullptr) << "DUET_SOURCE_DIR is not set";
  return fs::path(source == nullptr ? "." : source) / "tests/fuzz";
}

// The files of a folder, by name; none where it is absent.
std::vector<fs::path> FilesOf(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder, absent)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::set<std::string> NamesOf(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::path& file : FilesOf(folder)) names.insert(file.filename().string());
  return names;
}

class CorpusTest : public ::testing::TestWithParam<Target> {};

TEST_P(CorpusTest, EveryKeptInputLeavesThePromisesWhole) {
  for (const char* kind : {"corpus", "regressions"}) {
    for (const fs::path& file : FilesOf(FuzzFolder() / kind / GetParam().name)) {
      EXPECT_EQ(GetParam().run(test::ReadTestFile(file)), "") << file;
    }
  }
}

// A fuzzer in miniature: finds what a change of a reader breaks at once.
TEST_P(CorpusTest, MutatedInputsLeaveThePromisesWhole) {
  std::vector<std::string> corpus;
  for (const fs::path& file : FilesOf(FuzzFolder() / "corpus" / GetParam().name)) {
    corpus.push_back(test::ReadTestFile(file));
  }
  ASSERT_FALSE(corpus.empty());
  base::Random random(1);
  const auto any = [&]() -> const std::string& {
    return corpus[static_cast<std::size_t>(random.Below(static_cast<int64_t>(corpus.size())))];
  };
  for (int i = 0, end = MutationCount(); i < end; ++i) {
    const std::string& input = any();
    const std::string mutated = Mutated(input, any(), random);
    ASSERT_EQ(GetParam().run(mutated), "") << "mutation " << i << ": " << absl::CHexEscape(mutated);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryTarget, CorpusTest, ::testing::ValuesIn(kTargets),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(CorpusFoldersTest, EveryFolderIsATargets) {
  std::set<std::string> targets;
  for (const Target& target : kTargets) targets.insert(target.name);
  EXPECT_EQ(NamesOf(FuzzFolder() / "corpus"), targets);
  for (const char* kind : {"regressions", "dictionaries"}) {
    for (const std::string& name : NamesOf(FuzzFolder() / kind)) {
      EXPECT_EQ(targets.count(fs::path(name).stem().string()), 1u) << kind << "/" << name;
    }
  }
}

TEST(MutatedTest, TheSameNumbersGiveTheSameInput) {
  base::Random one(7), same(7);
  std::set<std::string> mutated;
  for (int i = 0; i < 100; ++i) {
    const std::string input = Mutated("frames: 12, rate: 30", "other", one);
    EXPECT_EQ(input, Mutated("frames: 12, rate: 30", "other", same));
    mutated.insert(input);
  }
  EXPECT_GT(mutated.size(), 90u);
}

}  // namespace
}  // namespace duet::fuzz
