#include "model/formats/fbx/fbx_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "model/base/printable.h"
#include "model/formats/fbx/fbx_exit.h"
#include "model/motion/motion_limits.h"
#include "nlohmann/json.hpp"

namespace duet::formats::fbx {
namespace {

namespace fs = std::filesystem;

constexpr char kProgramName[] = "duet-fbx", kProgramVariable[] = "DUET_FBX_PROGRAM";
constexpr std::size_t kLongestMessage = 400;
constexpr std::size_t kMostOutput = std::size_t{1} << 30;
// Binary FBX begins with "Kaydara FBX Binary", FBX as text with a comment or FBXHeaderExtension.
constexpr std::size_t kHeaderBytes = 4096;

// A file in memory that ends with this object.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("duet-fbx", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }

  bool Write(absl::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = write(descriptor_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return lseek(descriptor_, 0, SEEK_SET) == 0;
  }

  std::optional<std::string> Read() const {
    struct stat status {};
    if (fstat(descriptor_, &status) != 0 || status.st_size < 0) return std::nullopt;
    std::string bytes(std::min(static_cast<std::size_t>(status.st_size), kMostOutput), '\0');
    std::size_t at = 0;
    while (at < bytes.size()) {
      const ssize_t count =
          pread(descriptor_, &bytes[at], bytes.size() - at, static_cast<off_t>(at));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return std::nullopt;
      at += static_cast<std::size_t>(count);
    }
    return bytes;
  }

 private:
  int descriptor_;
};

bool IsExecutable(const fs::path& file) { return access(file.c_str(), X_OK) == 0; }

// Runs the program; returns its status as waitpid does.
absl::StatusOr<int> RunProgram(const fs::path& program, std::vector<std::string> arguments,
                               const MemoryFile& input, const MemoryFile& output) {
  std::string name = program.string();
  std::vector<char*> argv = {name.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.descriptor(), STDOUT_FILENO);
  // assimp's and the sanitizers' messages mean nothing to a user.
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int error = posix_spawn(&process, name.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  while (error == 0 && waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return absl::UnknownError("expected its end, got none");
  }
  if (error == 0) return status;
  return absl::UnknownError(std::error_code(error, std::generic_category()).message());
}

absl::Status Missing(absl::string_view source, const fs::path& program) {
  return absl::FailedPreconditionError(absl::StrCat(
      source, ": FBX: expected the program ", program.string(),
      ", got none; install the package duet-fbx, or build Duet with libassimp-dev (CMake option "
      "DUET_FBX), or export .glb or .bvh instead"));
}

absl::Status Failed(absl::string_view source, int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU || signal == SIGALRM || signal == SIGKILL) {
      return absl::InvalidArgumentError(
          absl::StrCat(source, ": expected FBX that is read within ", kMostProcessorSeconds,
                       " s of processor time, got a file that takes longer"));
    }
    return absl::InvalidArgumentError(absl::StrCat(
        source, ": expected FBX, got a file on which assimp fails (signal ", signal, ")"));
  }
  return absl::InvalidArgumentError(
      absl::StrCat(source, ": expected FBX, got a file on which duet-fbx fails (status ",
                   WEXITSTATUS(status), ")"));
}

std::optional<double> Positive(const nlohmann::json& statements, const char* name) {
  const auto found = statements.find(name);
  if (found == statements.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  return value > 0 ? std::optional<double>(value) : std::nullopt;
}

absl::StatusOr<FbxScene> ParseOutput(std::string output, absl::string_view source) {
  const std::size_t end = output.find('\n');
  const nlohmann::json statements = nlohmann::json::parse(output.substr(0, end), nullptr, false);
  if (end == std::string::npos || !statements.is_object()) {
    return absl::InternalError(
        absl::StrCat(source, ": duet-fbx: expected statements and a glTF, got ",
                     base::Printable(output, 40), "; are both programs of one version?"));
  }
  FbxScene scene;
  scene.unit_scale_factor = Positive(statements, "unit_scale_factor");
  scene.frame_rate_hz = Positive(statements, "frame_rate_hz");
  scene.up_axis = motion::ParseUpAxis(statements.value("up_axis", ""));
  output.erase(0, end + 1);
  scene.glb = std::move(output);
  return scene;
}

}  // namespace

fs::path FbxProgram() {
  if (const char* const given = std::getenv(kProgramVariable)) return given;
  std::error_code unknown;
  const fs::path beside = fs::read_symlink("/proc/self/exe", unknown).parent_path() / kProgramName;
  if (IsExecutable(beside)) return beside;
  const char* const path = std::getenv("PATH");
  for (absl::string_view folder : absl::StrSplit(path == nullptr ? "" : path, ':')) {
    const fs::path file = fs::path(std::string(folder)) / kProgramName;
    if (!folder.empty() && IsExecutable(file)) return file;
  }
  return beside;
}

absl::StatusOr<FbxScene> ConvertFbx(absl::string_view content, absl::string_view source,
                                    const std::optional<FbxMeshes>& meshes) {
  if (!absl::StrContains(content.substr(0, kHeaderBytes), "FBX")) {
    return absl::InvalidArgumentError(
        absl::StrCat(source, ": expected FBX, binary or text, got another kind of file"));
  }
  const fs::path program = FbxProgram();
  if (!IsExecutable(program)) return Missing(source, program);
  const MemoryFile input, output;
  if (!input.Write(content)) {
    return absl::ResourceExhaustedError(
        absl::StrCat(source, ": expected memory for ", content.size(), " bytes, got none"));
  }
  std::vector<std::string> arguments;
  if (meshes.has_value()) {
    arguments = {"--mesh", absl::StrCat(meshes->metres_per_unit),
                 std::string(UpAxisName(meshes->up_axis))};
  }
  const absl::StatusOr<int> status = RunProgram(program, std::move(arguments), input, output);
  if (!status.ok()) {
    return absl::InternalError(
        absl::StrCat(source, ": ", program.string(), ": ", status.status().message()));
  }
  const bool exited = WIFEXITED(*status);
  if (!exited || (WEXITSTATUS(*status) != kConverted && WEXITSTATUS(*status) != kRefused)) {
    return Failed(source, *status);
  }
  std::optional<std::string> bytes = output.Read();
  if (!bytes.has_value()) {
    return absl::InternalError(absl::StrCat(source, ": duet-fbx: its output cannot be read"));
  }
  if (WEXITSTATUS(*status) == kConverted) return ParseOutput(*std::move(bytes), source);
  return absl::InvalidArgumentError(
      absl::StrCat(source, ": ", base::Printable(*bytes, kLongestMessage)));
}

}  // namespace duet::formats::fbx
