#include "model/torch_plugin/torch_plugin.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::torch_plugin {
namespace {

// The path of the library, which the build passes to this test.
TEST(TorchPluginTest, OpensTheLibraryAndLoadsModels) {
  setenv("DUET_TORCH_ENGINE", DUET_TORCH_ENGINE_PATH, 1);
  const auto torch = Open();
  ASSERT_THAT(torch, IsOk());
  ASSERT_THAT(torch->set_threads(1), IsOk());
  const auto models = torch->load_embedded();
  ASSERT_THAT(models, IsOk());
  ASSERT_FALSE(models->empty());
  const engine::Synthesizer& model = *models->front();
  engine::SynthesisWindow window;
  window.leader = motion::Poses(4, model.description().skeleton.joint_count());
  window.labels.assign(4 * model.description().classes.size(), 0);
  const engine::SynthesisWindow* const one = &window;
  EXPECT_THAT(model.Synthesize({&one, 1}).front(), IsOk());
  EXPECT_THAT(torch->load_folder("/no/such/folder"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("no/such")));
}

TEST(TorchPluginTest, MissingLibraryIsNamed) {
  setenv("DUET_TORCH_ENGINE", "/no/such/library.so", 1);
  EXPECT_THAT(Open(), StatusIs(absl::StatusCode::kNotFound, HasSubstr("/no/such/library.so")));
}

TEST(TorchPluginTest, InvalidLibraryIsNamed) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "engine.so";
  std::ofstream(file) << "not a library";
  setenv("DUET_TORCH_ENGINE", file.c_str(), 1);
  EXPECT_THAT(Open(), StatusIs(absl::StatusCode::kNotFound, HasSubstr(file.string())));
}

TEST(TorchPluginTest, LibraryOfAnotherBuildIsRejected) {
  setenv("DUET_TORCH_ENGINE", DUET_OTHER_BUILD_PATH, 1);
  EXPECT_THAT(Open(), StatusIs(absl::StatusCode::kFailedPrecondition,
                               HasSubstr("expected this program's build")));
}

}  // namespace
}  // namespace duet::torch_plugin
