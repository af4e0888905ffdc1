#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/string_view.h"
#include "model/base/text.h"
#include "server/service/request_fields.h"

namespace duet::server::service {
namespace {

// A label vector with more than this many weights beyond the number of classes is rejected as a
// whole.
constexpr int kMaxExtraWeights = 64;

std::vector<engine::LabelKeyframe> ReadKeyframes(const v1::SynthesizeRequest& request,
                                                 uint32_t frames,
                                                 const engine::ModelDescription& model,
                                                 const RequestLimits& limits,
                                                 Violations& violations) {
  std::vector<engine::LabelKeyframe> keyframes;
  if (request.label_keyframes_size() > limits.max_label_keyframes) {
    violations.Malformed("label_keyframes",
                         absl::StrCat("at most ", limits.max_label_keyframes, " keyframes"),
                         absl::StrCat(request.label_keyframes_size()));
    return keyframes;
  }
  for (int i = 0; i < request.label_keyframes_size(); ++i) {
    const v1::LabelKeyframe& keyframe = request.label_keyframes(i);
    const std::string at = absl::StrCat("label_keyframes[", i, "]");
    if (keyframe.frame() >= frames) {
      violations.Malformed(absl::StrCat(at, ".frame"),
                           absl::StrCat("less than ", frames, ", the number of frames"),
                           absl::StrCat(keyframe.frame()));
    }
    if (i > 0 && keyframe.frame() <= request.label_keyframes(i - 1).frame()) {
      violations.Malformed(absl::StrCat(at, ".frame"),
                           absl::StrCat("more than the previous keyframe's ",
                                        request.label_keyframes(i - 1).frame()),
                           absl::StrCat(keyframe.frame()));
    }
    keyframes.push_back({static_cast<int>(std::min(keyframe.frame(), frames)),
                         ReadLabelVector(absl::StrCat(at, ".label_vector"), keyframe.label_vector(),
                                         model, limits, violations)});
  }
  return keyframes;
}

}  // namespace

std::vector<float> ReadLabelVector(const std::string& field, const v1::LabelVector& label_vector,
                                   const engine::ModelDescription& model,
                                   const RequestLimits& limits, Violations& violations) {
  std::vector<float> weights(model.classes.size(), 0.0F);
  std::vector<int> first_use(model.classes.size(), -1);
  const std::string list = absl::StrCat(field, ".weights");
  if (label_vector.weights().empty()) {
    violations.Malformed(
        list, absl::StrCat("a weight for at least one of ", absl::StrJoin(model.classes, ", ")),
        "none");
  }
  if (label_vector.weights_size() > model.class_count() + kMaxExtraWeights) {
    violations.Malformed(
        list, absl::StrCat("at most one weight for each of ", model.class_count(), " classes"),
        absl::StrCat(label_vector.weights_size(), " weights"));
    return weights;
  }
  for (int i = 0; i < label_vector.weights_size(); ++i) {
    const v1::ClassWeight& entry = label_vector.weights(i);
    const std::string at = absl::StrCat(list, "[", i, "]");
    const auto found =
        std::find(model.classes.begin(), model.classes.end(), entry.interaction_class());
    if (found == model.classes.end()) {
      violations.Malformed(absl::StrCat(at, ".interaction_class"),
                           absl::StrCat("one of ", absl::StrJoin(model.classes, ", ")),
                           base::Quoted(entry.interaction_class()));
    }
    // False for NaN.
    if (!(std::abs(entry.weight()) <= limits.max_abs_weight)) {
      violations.Malformed(absl::StrCat(at, ".weight"),
                           absl::StrCat("a finite value in [-", limits.max_abs_weight, ", ",
                                        limits.max_abs_weight, "]"),
                           base::NumberText(entry.weight()));
    }
    if (found == model.classes.end()) continue;
    const auto index = static_cast<std::size_t>(found - model.classes.begin());
    if (first_use[index] >= 0) {
      violations.Malformed(absl::StrCat(at, ".interaction_class"), "each class at most once",
                           absl::StrCat(base::Quoted(entry.interaction_class()),
                                        " again after weights[", first_use[index], "]"));
      continue;
    }
    first_use[index] = i;
    weights[index] = entry.weight();
  }
  return weights;
}

std::vector<engine::LabelKeyframe> ValidateLabels(const v1::SynthesizeRequest& request,
                                                  uint32_t frames,
                                                  const engine::ModelDescription& model,
                                                  const RequestLimits& limits,
                                                  Violations& violations) {
  const bool has_keyframes = !request.label_keyframes().empty();
  if (request.has_label_vector() && has_keyframes) {
    violations.Malformed("label_keyframes", "label_vector or label_keyframes", "both");
  }
  if (!request.has_label_vector() && !has_keyframes) {
    violations.Malformed("label_vector", "label_vector or label_keyframes", "neither");
  }
  std::vector<engine::LabelKeyframe> keyframes;
  if (has_keyframes) keyframes = ReadKeyframes(request, frames, model, limits, violations);
  if (request.has_label_vector()) {
    keyframes.push_back(
        {0, ReadLabelVector("label_vector", request.label_vector(), model, limits, violations)});
  }
  return keyframes;
}

}  // namespace duet::server::service
