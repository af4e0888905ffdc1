// The symbol that libduet_torch_engine.so exports.
#include "model/torch_engine/torch_synthesizer.h"
#include "model/torch_plugin/build_id.h"
#include "model/torch_plugin/torch_plugin.h"

extern "C" {

__attribute__((visibility("default"))) extern const duet::torch_plugin::Exported duet_torch_engine;
const duet::torch_plugin::Exported duet_torch_engine = {
    duet::torch_plugin::kBuildId,
    {duet::torch_engine::SetTorchThreads,
     [](const std::filesystem::path& folder) {
       return duet::torch_engine::LoadTorchSynthesizer(folder);
     },
     [] { return duet::torch_engine::LoadEmbeddedSynthesizers(); }}};

}  // extern "C"
