// Reads FBX from standard input and writes it as glTF to standard output, for Duet's programs
// (model/formats/fbx/fbx_program.h). This process ends if assimp crashes, loops or wants too much
// memory; the process that waits for it does not.
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "model/formats/fbx/fbx_exit.h"
#include "model/formats/fbx/program/scene_conversion.h"
#include "model/formats/fbx/program/scene_reader.h"
#include "model/motion/coordinates.h"
#include "model/motion/motion_limits.h"
#include "model/retargeting/affine.h"
#include "model/retargeting/rest_rig.h"

namespace duet::formats::fbx::program {
namespace {

constexpr rlim_t kMostMemory = rlim_t{4} << 30;  // bytes
constexpr rlim_t kMostOutput = rlim_t{1} << 30;  // bytes
constexpr unsigned kMostSeconds = 120;
constexpr char kUsage[] =
    "Usage: duet-fbx [--mesh METRES_PER_UNIT UP_AXIS] < FILE.fbx > STATEMENTS_AND_GLB\n";

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
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY || limit.rlim_max > most ? most : limit.rlim_max;
  limit.rlim_max = limit.rlim_cur;
  return setrlimit(resource, &limit) == 0;
}

// A foreign file decides what happens from here on: no more memory and time than this, and no file
// may be opened.
bool Confine() {
  // Signals that the other process blocks or ignores are blocked or ignored here too.
  sigset_t none;
  sigemptyset(&none);
  if (sigprocmask(SIG_SETMASK, &none, nullptr) != 0) return false;
  if (signal(SIGALRM, SIG_DFL) == SIG_ERR || signal(SIGXCPU, SIG_DFL) == SIG_ERR) return false;
  alarm(kMostSeconds);
  if (!kIsSanitized && !Limit(RLIMIT_AS, kMostMemory)) return false;
  return Limit(RLIMIT_CPU, kMostProcessorSeconds) && Limit(RLIMIT_FSIZE, kMostOutput) &&
         Limit(RLIMIT_CORE, 0) && Limit(RLIMIT_NOFILE, STDERR_FILENO + 1);
}

absl::StatusOr<std::string> ReadInput() {
  std::string content, block(std::size_t{1} << 16, '\0');
  for (;;) {
    const ssize_t count = read(STDIN_FILENO, block.data(), block.size());
    if (count == 0) return content;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return absl::UnknownError("standard input: expected a file, got an error");
    content.append(block, 0, static_cast<std::size_t>(count));
    if (content.size() > motion::kMaxMotionFileBytes) {
      return absl::InvalidArgumentError(
          absl::StrCat("expected at most ", motion::kMaxMotionFileBytes >> 20, " MiB, got more"));
    }
  }
}

bool WriteOutput(absl::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

absl::StatusOr<std::string> Convert(const ConversionOptions& options) {
  const absl::StatusOr<std::string> content = ReadInput();
  if (!content.ok()) return content.status();
  SceneReader reader;
  const absl::StatusOr<const aiScene*> scene = reader.Read(*content);
  if (!scene.ok()) return scene.status();
  return ConvertScene(**scene, options);
}

// Absent for arguments that are none.
std::optional<ConversionOptions> ParseArguments(int argc, char** argv) {
  ConversionOptions options;
  if (argc == 1) return options;
  double metres = 0;
  const std::optional<motion::UpAxis> up = argc == 4 ? motion::ParseUpAxis(argv[3]) : std::nullopt;
  if (argc != 4 || absl::string_view(argv[1]) != "--mesh" || !absl::SimpleAtod(argv[2], &metres) ||
      !(metres > 0) || !up.has_value()) {
    return std::nullopt;
  }
  options.with_meshes = true;
  options.to_world =
      retargeting::FromParts({{}, retargeting::ToWorldAxes(*up), {metres, metres, metres}});
  return options;
}

// The process's status.
int Run(int argc, char** argv) {
  const std::optional<ConversionOptions> options = ParseArguments(argc, argv);
  if (!options.has_value()) {
    std::cerr << kUsage;
    return kWrongUse;
  }
  if (!Confine()) {
    std::cerr << "duet-fbx: expected to limit its resources, got an error\n";
    return kWrongUse;
  }
  absl::StatusOr<std::string> output = absl::InternalError("");
  try {  // assimp, and memory that the limit refuses
    output = Convert(*options);
  } catch (const std::bad_alloc&) {
    output = absl::ResourceExhaustedError("expected a file that fits into 4 GiB, got a larger one");
  } catch (const std::exception& failure) {
    output = absl::InvalidArgumentError(
        absl::StrCat("expected FBX, got a file whose conversion fails: ", failure.what()));
  }
  if (output.ok()) return WriteOutput(*output) ? kConverted : kWrongUse;
  return WriteOutput(output.status().message()) ? kRefused : kWrongUse;
}

}  // namespace
}  // namespace duet::formats::fbx::program

#if defined(__SANITIZE_ADDRESS__) || defined(__clang__)
// Read by AddressSanitizer: it cannot look for leaks without opening files, and the process ends.
extern "C" const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }
#endif

int main(int argc, char** argv) { return duet::formats::fbx::program::Run(argc, argv); }
