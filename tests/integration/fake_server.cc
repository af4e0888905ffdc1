// duet-server with a fake engine, for tests of the process as a whole. A checkpoint folder whose
// manifest.json begins with "good" loads; anything else is refused.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "server/lifecycle/run_server.h"
#include "tests/support/fake_synthesizer.h"

namespace {

using duet::engine::Synthesizer;

absl::StatusOr<std::shared_ptr<const Synthesizer>> LoadFolder(const std::filesystem::path& folder) {
  std::string word;
  std::ifstream(folder / "manifest.json") >> word;
  if (word != "good") return absl::InvalidArgumentError("the manifest is not good");
  duet::engine::ModelDescription description = duet::test::FakeDescription();
  description.name = folder.parent_path().filename().string();
  description.version = std::stoi(folder.filename().string());
  return std::make_shared<duet::test::FakeSynthesizer>(description);
}

}  // namespace

int main(int argc, char** argv) {
  duet::server::lifecycle::StopSignal stop;
  const duet::server::lifecycle::ModelSource source{
      "fake", LoadFolder, [] {
        return std::vector<std::shared_ptr<const Synthesizer>>{
            std::make_shared<duet::test::FakeSynthesizer>()};
      }};
  return duet::server::lifecycle::RunServer(
      argc, argv,
      [&](const auto&) -> absl::StatusOr<duet::server::lifecycle::ModelSource> { return source; },
      stop, std::make_shared<duet::server::metrics::StreamLogSink>(stderr));
}
