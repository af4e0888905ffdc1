#include "tests/support/data_folder.h"

#include <cstdlib>
#include <system_error>

namespace duet::test {

namespace fs = std::filesystem;

std::optional<fs::path> FindData(const std::string& relative_path) {
  fs::path folder;
  if (const char* data = std::getenv("DUET_DATA_DIR"); data != nullptr && *data != '\0') {
    folder = data;
  } else if (const char* source = std::getenv("DUET_SOURCE_DIR"); source != nullptr) {
    folder = fs::path(source) / "../shared/data";
  }
  std::error_code ignored;
  const fs::path path = folder / relative_path;
  if (folder.empty() || !fs::exists(path, ignored)) return std::nullopt;
  return path;
}

}  // namespace duet::test
