#include "model/evaluation/report/render_png.h"

#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "absl/strings/str_cat.h"

extern char** environ;

namespace duet::evaluation::report {
namespace {

constexpr char kZoom[] = "--zoom=3.125";  // 300 / 96

// The status of a program that has ended; -1 for one that was killed.
int WaitFor(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

absl::Status RenderPng(const std::filesystem::path& svg, const std::filesystem::path& png,
                       const std::string& program) {
  // "./-x" is a file, where "-x" would be a flag.
  std::vector<std::string> words = {program,
                                    kZoom,
                                    "--background-color=white",
                                    "--output",
                                    std::filesystem::absolute(png),
                                    std::filesystem::absolute(svg)};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t pid = 0;
  const int error =
      posix_spawnp(&pid, program.c_str(), nullptr, nullptr, arguments.data(), environ);
  if (error == ENOENT) {
    return absl::NotFoundError(absl::StrCat(program, " is not installed"));
  }
  if (error != 0) {
    return absl::InternalError(absl::StrCat(program, ": ", std::strerror(error)));
  }
  const int status = WaitFor(pid);
  if (status == 0) return absl::OkStatus();
  return absl::InternalError(
      absl::StrCat(program, " ", svg.string(), ": ended with status ", status, ", wanted 0"));
}

}  // namespace duet::evaluation::report
