#include "model/torch_plugin/torch_plugin.h"

#include <dlfcn.h>

#include <cstdlib>
#include <string>

#include "absl/strings/str_cat.h"
#include "model/torch_plugin/build_id.h"

namespace duet::torch_plugin {
namespace {

std::filesystem::path LibraryPath() {
  // Read once at start, before other threads exist.
  if (const char* path = std::getenv("DUET_TORCH_ENGINE"); path != nullptr) return path;  // NOLINT
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  return program.parent_path().parent_path() / "lib" / "duet" / "libduet_torch_engine.so";
}

}  // namespace

absl::StatusOr<TorchEngine> Open() {
  const std::string path = LibraryPath().string();
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return absl::NotFoundError(dlerror());
  const auto* exported = static_cast<const Exported*>(dlsym(library, kSymbol));
  if (exported == nullptr) return absl::NotFoundError(dlerror());
  if (std::string(exported->build) != kBuildId) {
    return absl::FailedPreconditionError(absl::StrCat(path, ": expected this program's build, ",
                                                      kBuildId, ", got ", exported->build));
  }
  return exported->engine;
}

}  // namespace duet::torch_plugin
