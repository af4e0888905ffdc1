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

using duet::Synthesizer;

absl::StatusOr<std::shared_ptr<const Synthesizer>> LoadFolder(const std::filesystem::path& folder) {
  std::string word;
  std::ifstream(folder / "manifest.json") >> word;
  if (word != "good") return absl::InvalidArgumentError("the manifest is not good");
  duet::ModelDescription description = duet::FakeDescription();
  description.name = folder.parent_path().filename().string();
  description.version = std::stoi(folder.filename().string());
  return std::make_shared<duet::FakeSynthesizer>(description);
}

}  // namespace

int main(int argc, char** argv) {
  duet::StopSignal stop;
  duet::StreamLogSink log(stderr);
  const duet::ModelSource source{LoadFolder,
                                 [] {
                                   return std::vector<std::shared_ptr<const Synthesizer>>{
                                       std::make_shared<duet::FakeSynthesizer>()};
                                 },
                                 [](int) {}};
  return duet::RunServer(argc, argv, source, stop, log);
}
