// Converts FBX to glTF: duet-fbx IN.fbx OUT.glb. A foreign file can make assimp crash, loop or fill
// the memory; the process limits its own resources before it reads one.
#include <sys/resource.h>

#include <exception>
#include <iostream>
#include <new>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "contrib/formats/fbx/fbx_conversion.h"
#include "model/base/file.h"
#include "model/motion/motion_limits.h"

namespace duet::contrib::formats::fbx {
namespace {

constexpr int kWrongUse = 2, kRefused = 3;
constexpr rlim_t kMostMemory = rlim_t{4} << 30;  // bytes
constexpr rlim_t kMostProcessorSeconds = 60;

// AddressSanitizer reserves terabytes of addresses.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kIsSanitized = true;
#elif defined(__has_feature)
constexpr bool kIsSanitized = __has_feature(address_sanitizer);
#else
constexpr bool kIsSanitized = false;
#endif

bool Limit(decltype(RLIMIT_AS) resource, rlim_t most) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return false;
  if (limit.rlim_max == RLIM_INFINITY || limit.rlim_max > most) limit.rlim_max = most;
  limit.rlim_cur = limit.rlim_max;
  return setrlimit(resource, &limit) == 0;
}

bool Confine() {
  return (kIsSanitized || Limit(RLIMIT_AS, kMostMemory)) &&
         Limit(RLIMIT_CPU, kMostProcessorSeconds) && Limit(RLIMIT_CORE, 0);
}

absl::StatusOr<std::string> Convert(const std::string& content) {
  try {  // assimp, and memory that the limit refuses
    return ConvertFbx(content);
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("expected a file that fits into 4 GiB, got a larger one");
  } catch (const std::exception& failure) {
    return absl::InvalidArgumentError(
        absl::StrCat("expected FBX, got a file whose conversion fails: ", failure.what()));
  }
}

// The process's status.
int Run(const std::string& in, const std::string& out) {
  if (!Confine()) {
    std::cerr << "duet-fbx: expected to limit its resources, got an error\n";
    return kWrongUse;
  }
  const absl::StatusOr<std::string> content =
      base::ReadFile(in, motion::kMaxMotionFileBytes, "an FBX file");
  if (!content.ok()) {
    std::cerr << content.status().message() << "\n";
    return kRefused;
  }
  const absl::StatusOr<std::string> glb = Convert(*content);
  const absl::Status status = glb.ok() ? base::WriteFile(out, *glb) : glb.status();
  if (status.ok()) return 0;
  std::cerr << (glb.ok() ? "" : in + ": ") << status.message() << "\n";
  return kRefused;
}

}  // namespace
}  // namespace duet::contrib::formats::fbx

int main(int argc, char** argv) {
  if (argc == 3) return duet::contrib::formats::fbx::Run(argv[1], argv[2]);
  std::cerr << "Usage: duet-fbx IN.fbx OUT.glb\n";
  return 2;
}
