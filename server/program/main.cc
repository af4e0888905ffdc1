// duet-server: the only file of the server that names an engine.

#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "duet/v1/server_config.pb.h"
#include "model/base/program_output.h"
#include "model/cpu_engine/cpu_synthesizer.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "server/lifecycle/process_end.h"
#include "server/lifecycle/run_server.h"

namespace {

using duet::cpu_engine::CpuEngineOptions;
using duet::cpu_engine::kernels::Precision;
using duet::engine::Synthesizer;
using duet::server::lifecycle::ModelSource;
using duet::v1::ServerConfig;

using Loaded = absl::StatusOr<std::unique_ptr<Synthesizer>>;
using AllLoaded = absl::StatusOr<std::vector<std::unique_ptr<Synthesizer>>>;

absl::StatusOr<std::shared_ptr<const Synthesizer>> Shared(Loaded model) {
  if (!model.ok()) return model.status();
  return *std::move(model);
}

absl::StatusOr<std::vector<std::shared_ptr<const Synthesizer>>> Shared(AllLoaded models) {
  if (!models.ok()) return models.status();
  return std::vector<std::shared_ptr<const Synthesizer>>(std::make_move_iterator(models->begin()),
                                                         std::make_move_iterator(models->end()));
}

absl::StatusOr<ModelSource> OpenEngine(const ServerConfig& settings) {
  CpuEngineOptions engine;
  if (settings.precision() == duet::v1::PRECISION_F32) {
    engine.precision = Precision::kFloat32;
  } else if (settings.precision() == duet::v1::PRECISION_INT16) {
    engine.precision = Precision::kInt16;
  }
  return ModelSource{
      absl::StrCat("cpu, ", engine.precision == Precision::kInt16 ? "int16" : "f32", ", ",
                   duet::cpu_engine::kernels::InstructionSet()),
      [engine](const std::filesystem::path& folder) {
        return Shared(duet::cpu_engine::LoadCpuSynthesizer(folder, engine));
      },
      [engine] { return Shared(duet::cpu_engine::LoadEmbeddedSynthesizers(engine)); }};
}

}  // namespace

int main(int argc, char** argv) {
  duet::server::lifecycle::LimitFreeMemory();
  // Never deleted (see RunServer); static, so that LeakSanitizer still finds it when the process
  // ends.
  static auto* const stop = new duet::server::lifecycle::StopSignal;
  const int code = duet::server::lifecycle::RunServer(
      argc, argv, OpenEngine, *stop,
      std::make_shared<duet::server::metrics::StreamLogSink>(stderr));
  return duet::base::FinishOutput("duet-server", code);
}
