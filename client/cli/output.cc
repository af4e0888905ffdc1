#include "client/cli/output.h"

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

// A page holds the motion a second time, as a file to take away: two minutes at 30 Hz are 3 MB.
constexpr int kMostFramesToHandOut = 3600;

bool IsPage(const std::filesystem::path& path) {
  const std::string extension = absl::AsciiStrToLower(path.extension().string());
  return extension == ".html" || extension == ".htm";
}

// Weights for the whole clip are those of its first frame.
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

absl::StatusOr<std::string> FormatPair(formats::Format format, const Synthesis& synthesis) {
  const motion::Provenance provenance = ProvenanceOf(synthesis);
  const motion::ClipPair& pair = synthesis.result.pair;
  return formats::FormatPeople(format, {pair.leader, pair.follower}, synthesis.skeleton,
                               {&provenance, synthesis.bvh_metres_per_unit});
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
  if (content.pair.leader.frame_count() <= kMostFramesToHandOut) {
    absl::StatusOr<std::string> glb = FormatPair(formats::Format::kGlb, synthesis);
    if (!glb.ok()) return glb.status();
    content.glb = *std::move(glb);
  }
  return RenderPage(content);
}

// The follower on somebody else's rig, in place of Duet's own.
absl::StatusOr<std::vector<std::filesystem::path>> WriteWithRig(const std::filesystem::path& output,
                                                                const Synthesis& synthesis) {
  const motion::ClipPair& pair = synthesis.result.pair;
  const absl::StatusOr<std::string> follower =
      formats::FormatOntoRig(pair.follower, *synthesis.follower_rig);
  if (!follower.ok()) return follower.status();
  absl::StatusOr<std::vector<std::filesystem::path>> written = formats::WritePair(
      output, pair, synthesis.skeleton, {nullptr, synthesis.bvh_metres_per_unit});
  if (!written.ok()) return written.status();
  absl::Status status = base::WriteFile(written->back(), *follower);
  if (!status.ok()) return status;
  return written;
}

}  // namespace

absl::Status CheckOutput(const std::filesystem::path& output, const std::filesystem::path& input,
                         PageAllowed page) {
  if (output == kStandardStream) return absl::OkStatus();
  const bool page_allowed = page == PageAllowed::kYes;
  if (!formats::IsWritable(output) && !(page_allowed && IsPage(output))) {
    return formats::UnknownExtension(
        output, absl::StrCat(page_allowed ? ".html, " : "", formats::kWritableExtensions));
  }
  std::error_code error;
  const std::filesystem::path folder = output.has_parent_path() ? output.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, error)) {
    return absl::InvalidArgumentError(
        absl::StrCat(output.string(), ": there is no folder ", folder.string()));
  }
  if (std::filesystem::equivalent(output, input, error)) {
    return absl::InvalidArgumentError(
        absl::StrCat(output.string(), ": would replace the file that is read"));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<std::filesystem::path>> WriteOutput(const std::filesystem::path& output,
                                                               const Synthesis& synthesis) {
  if (synthesis.follower_rig && formats::FormatOf(output) == formats::Format::kBvh) {
    return WriteWithRig(output, synthesis);
  }
  if (!IsPage(output)) {
    const motion::Provenance provenance = ProvenanceOf(synthesis);
    return formats::WritePair(output, synthesis.result.pair, synthesis.skeleton,
                              {&provenance, synthesis.bvh_metres_per_unit});
  }
  const absl::StatusOr<std::string> page = RenderSynthesis(synthesis);
  if (!page.ok()) return page.status();
  absl::Status status = base::WriteFile(output, *page);
  if (!status.ok()) return status;
  return std::vector<std::filesystem::path>{output};
}

absl::StatusOr<std::string> FormatOutput(const OutputFormat& format, const Synthesis& synthesis) {
  if (!format.motion.has_value()) return RenderSynthesis(synthesis);
  return FormatPair(*format.motion, synthesis);
}

absl::Status WriteToStream(const std::string& content, std::ostream& out) {
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.flush();
  if (out.good()) return absl::OkStatus();
  return NotWritten(absl::AbortedError("standard output: not all of it arrived"));
}

absl::Status NotWritten(const absl::Status& status) {
  if (status.ok()) return status;
  const auto code = absl::IsPermissionDenied(status) ? absl::StatusCode::kAborted : status.code();
  return absl::Status(code, absl::StrCat("cannot write the result: ", status.message()));
}

}  // namespace duet::client::cli
