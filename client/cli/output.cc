#include "client/cli/output.h"

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/viewer/page.h"
#include "model/base/file.h"
#include "model/formats/motion_file.h"

namespace duet::client::cli {
namespace {

// A page also contains the motion as a file to download: 3 MB for two minutes at 30 Hz.
constexpr int kMostFramesToHandOut = 3600;

bool IsPage(const std::filesystem::path& path) {
  const std::string extension = absl::AsciiStrToLower(path.extension().string());
  return extension == ".html" || extension == ".htm";
}

// Weights for the whole clip become a keyframe at frame 0.
std::vector<WeightKeyframe> KeyframesOf(const SynthesisRequest& request) {
  if (!request.keyframes.empty()) return request.keyframes;
  return {{0, request.weights}};
}

motion::Provenance ProvenanceOf(const Synthesis& synthesis) {
  const SynthesisResult& result = synthesis.result;
  motion::Provenance provenance;
  provenance.model = result.model_name;
  provenance.model_version = result.model_version;
  provenance.seed = result.seed;
  provenance.variety = result.variety;
  provenance.candidates = result.candidates;
  provenance.cleaned_up = result.cleaned_up;
  for (const WeightKeyframe& keyframe : KeyframesOf(synthesis.request)) {
    motion::Provenance::Labels labels;
    labels.frame = keyframe.frame;
    for (const ClassWeight& weight : keyframe.weights) {
      labels.weights.emplace_back(weight.interaction_class, weight.weight);
    }
    provenance.labels.push_back(std::move(labels));
  }
  return provenance;
}

formats::WriteOptions WritingOf(const Synthesis& synthesis, const motion::Provenance& provenance) {
  const std::optional<motion::JointRotations>& rotations = synthesis.result.rotations;
  formats::WriteOptions writing;
  writing.provenance = &provenance;
  writing.follower_rotations = rotations ? &*rotations : nullptr;
  return writing;
}

absl::StatusOr<std::string> RenderSynthesis(const Synthesis& synthesis) {
  const SynthesisResult& result = synthesis.result;
  viewer::PageContent content;
  content.pair = result.pair;
  content.bones = synthesis.skeleton.bones;
  content.title = synthesis.leader_file.stem().string();
  content.subtitle =
      absl::StrFormat("%s@%d · %d frames at %g Hz", result.model_name, result.model_version,
                      result.pair.leader.frame_count(), result.pair.leader.frame_rate_hz);
  if (synthesis.sampled) absl::StrAppend(&content.subtitle, " · seed ", result.seed);
  content.weights = KeyframesOf(synthesis.request);
  content.grade = result.grade;
  if (content.pair.leader.frame_count() <= kMostFramesToHandOut) {
    const motion::Provenance provenance = ProvenanceOf(synthesis);
    absl::StatusOr<std::string> glb =
        formats::FormatPeople(formats::Format::kGlb, {content.pair.leader, content.pair.follower},
                              synthesis.skeleton, WritingOf(synthesis, provenance));
    if (!glb.ok()) return glb.status();
    content.glb = *std::move(glb);
  }
  return RenderPage(content);
}

}  // namespace

absl::Status CheckOutput(const std::filesystem::path& output,
                         const std::vector<std::filesystem::path>& inputs, OutputKind kind) {
  const bool is_page = kind != OutputKind::kMotion && IsPage(output);
  const bool is_motion = kind != OutputKind::kPage && formats::FormatOf(output).has_value();
  if (!is_page && !is_motion) {
    std::string known = kind == OutputKind::kMotion ? "" : ".html";
    if (kind == OutputKind::kEither) known += ", ";
    if (kind != OutputKind::kPage) known += formats::kWritableExtensions;
    return formats::UnknownExtension(output, known);
  }
  if (absl::Status status = formats::CheckFolderOf(output); !status.ok()) return status;
  std::error_code error;
  if (std::filesystem::is_directory(output, error)) {
    return absl::InvalidArgumentError(
        absl::StrCat(output.string(), ": expected a file, got a folder"));
  }
  for (const std::filesystem::path& input : inputs) {
    if (!std::filesystem::equivalent(output, input, error)) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(output.string(), ": would replace the file that is read, ", input.string()));
  }
  return absl::OkStatus();
}

absl::Status CheckCanCreate(const std::filesystem::path& output) {
  std::error_code error;
  // A pipe or a device must not be opened twice.
  if (std::filesystem::is_other(output, error)) return absl::OkStatus();
  const std::filesystem::path probe = output.string() + ".partial";
  errno = 0;
  if (!std::ofstream(probe, std::ios::binary | std::ios::app)) {
    return NotWritten(base::CannotBeWritten(output, errno));
  }
  std::filesystem::remove(probe, error);
  return absl::OkStatus();
}

absl::StatusOr<std::vector<std::filesystem::path>> WriteOutput(const std::filesystem::path& output,
                                                               const Synthesis& synthesis) {
  if (!IsPage(output)) {
    const motion::Provenance provenance = ProvenanceOf(synthesis);
    return formats::WritePair(output, synthesis.result.pair, synthesis.skeleton,
                              WritingOf(synthesis, provenance));
  }
  const absl::StatusOr<std::string> page = RenderSynthesis(synthesis);
  if (!page.ok()) return page.status();
  absl::Status status = base::WriteFile(output, *page);
  if (!status.ok()) return status;
  return std::vector<std::filesystem::path>{output};
}

absl::Status WriteFollower(const std::filesystem::path& output, const Synthesis& synthesis) {
  if (IsPage(output)) return WriteOutput(output, synthesis).status();
  const motion::Provenance provenance = ProvenanceOf(synthesis);
  return formats::WritePeople(output, *formats::FormatOf(output), {synthesis.result.pair.follower},
                              synthesis.skeleton, WritingOf(synthesis, provenance))
      .status();
}

absl::Status NotWritten(const absl::Status& status) {
  if (status.ok()) return status;
  // Errors that last have other codes (write_error.h).
  const auto code = absl::IsPermissionDenied(status) ? absl::StatusCode::kAborted : status.code();
  return {code, absl::StrCat("cannot write the result: ", status.message())};
}

}  // namespace duet::client::cli
