// duet-server: the only file of the server that knows which engine computes the motion.

#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "model/torch_engine/torch_synthesizer.h"
#include "server/lifecycle/run_server.h"

namespace {

using duet::engine::Synthesizer;

absl::StatusOr<std::shared_ptr<const Synthesizer>> LoadFolder(const std::filesystem::path& folder) {
  absl::StatusOr<std::unique_ptr<Synthesizer>> model =
      duet::torch_engine::LoadTorchSynthesizer(folder);
  if (!model.ok()) return model.status();
  return *std::move(model);
}

absl::StatusOr<std::vector<std::shared_ptr<const Synthesizer>>> LoadEmbedded() {
  absl::StatusOr<std::vector<std::unique_ptr<Synthesizer>>> models =
      duet::torch_engine::LoadEmbeddedSynthesizers();
  if (!models.ok()) return models.status();
  return std::vector<std::shared_ptr<const Synthesizer>>(std::make_move_iterator(models->begin()),
                                                         std::make_move_iterator(models->end()));
}

}  // namespace

int main(int argc, char** argv) {
  duet::server::lifecycle::StopSignal stop;
  const duet::server::lifecycle::ModelSource source{LoadFolder, LoadEmbedded,
                                                    duet::torch_engine::SetTorchThreads};
  return duet::server::lifecycle::RunServer(
      argc, argv, source, stop, std::make_shared<duet::server::metrics::StreamLogSink>(stderr));
}
