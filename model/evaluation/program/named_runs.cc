#include "model/evaluation/program/named_runs.h"

#include "absl/strings/str_cat.h"

namespace duet::evaluation::program {

absl::StatusOr<NamedRuns> ParseRuns(const std::string& text) {
  const size_t equals = text.find('=');
  NamedRuns runs{text.substr(0, equals), text};
  if (equals == std::string::npos) {
    // "runs/" ends in an empty part.
    const std::filesystem::path path = (std::filesystem::path(text) / "").parent_path();
    runs.name = path.lexically_normal().filename().string();
  } else {
    runs.folder = text.substr(equals + 1);
  }
  if (!runs.name.empty() && !runs.folder.empty()) return runs;
  return absl::InvalidArgumentError(absl::StrCat("--runs ", text, ": wanted NAME=DIR or DIR"));
}

std::vector<std::string> StartNames() { return {"none", "root", "pose"}; }

experiments::StartGiven ParseStart(const std::string& name) {
  if (name == "root") return experiments::StartGiven::kRoot;
  return name == "pose" ? experiments::StartGiven::kPose : experiments::StartGiven::kNone;
}

std::string StartSuffix(experiments::StartGiven start) {
  switch (start) {
    case experiments::StartGiven::kNone:
      return "";
    case experiments::StartGiven::kRoot:
      return "+root";
    case experiments::StartGiven::kPose:
      return "+pose";
  }
  return "";
}

}  // namespace duet::evaluation::program
