#include "server/service/validate_labels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/string_view.h"
#include "model/base/text.h"

namespace duet::server::service {
namespace {

// A label vector with more than this many weights beyond the number of classes is rejected as a
// whole.
constexpr int kMaxExtraWeights = 64;

std::vector<float> ReadLabelVector(const std::string& field, const v1::LabelVector& label_vector,
                                   const engine::ModelDescription& model,
                                   const RequestLimits& limits, Violations& violations) {
  std::vector<float> weights(model.classes.size(), 0.0F);
  std::vector<int> first_use(model.classes.size(), -1);
  const std::string list = absl::StrCat(field, ".weights");
  if (label_vector.weights().empty()) {
    violations.Malformed(list, absl::StrCat("is empty, wanted a weight for at least one of ",
                                            absl::StrJoin(model.classes, ", ")));
  }
  if (label_vector.weights_size() > model.class_count() + kMaxExtraWeights) {
    violations.Malformed(list, absl::StrCat("has ", label_vector.weights_size(),
                                            " weights, wanted at most one for each of ",
                                            model.class_count(), " classes"));
    return weights;
  }
  for (int i = 0; i < label_vector.weights_size(); ++i) {
    const v1::ClassWeight& entry = label_vector.weights(i);
    const std::string at = absl::StrCat(list, "[", i, "]");
    const auto found =
        std::find(model.classes.begin(), model.classes.end(), entry.interaction_class());
    if (found == model.classes.end()) {
      violations.Malformed(absl::StrCat(at, ".interaction_class"),
                           absl::StrCat("is ", base::Quoted(entry.interaction_class()),
                                        ", wanted one of ", absl::StrJoin(model.classes, ", ")));
    }
    // False for NaN.
    if (!(std::abs(entry.weight()) <= limits.max_abs_weight)) {
      violations.Malformed(absl::StrCat(at, ".weight"),
                           absl::StrCat("is ", entry.weight(), ", wanted a finite value in [-",
                                        limits.max_abs_weight, ", ", limits.max_abs_weight, "]"));
    }
    if (found == model.classes.end()) continue;
    const auto index = static_cast<std::size_t>(found - model.classes.begin());
    if (first_use[index] >= 0) {
      violations.Malformed(
          absl::StrCat(at, ".interaction_class"),
          absl::StrCat("is ", base::Quoted(entry.interaction_class()), ", which weights[",
                       first_use[index], "] is already; wanted each class at most once"));
      continue;
    }
    first_use[index] = i;
    weights[index] = entry.weight();
  }
  return weights;
}

std::vector<engine::LabelKeyframe> ReadKeyframes(const v1::SynthesizeRequest& request,
                                                 const engine::ModelDescription& model,
                                                 const RequestLimits& limits,
                                                 Violations& violations) {
  std::vector<engine::LabelKeyframe> keyframes;
  if (request.label_keyframes_size() > limits.max_label_keyframes) {
    violations.Malformed("label_keyframes",
                         absl::StrCat("has ", request.label_keyframes_size(),
                                      " keyframes, wanted at most ", limits.max_label_keyframes));
    return keyframes;
  }
  const uint32_t frames = request.leader().frame_count();
  for (int i = 0; i < request.label_keyframes_size(); ++i) {
    const v1::LabelKeyframe& keyframe = request.label_keyframes(i);
    const std::string at = absl::StrCat("label_keyframes[", i, "]");
    if (keyframe.frame() >= frames) {
      violations.Malformed(absl::StrCat(at, ".frame"),
                           absl::StrCat("is ", keyframe.frame(), ", wanted less than ", frames,
                                        ", the leader's frame_count"));
    }
    if (i > 0 && keyframe.frame() <= request.label_keyframes(i - 1).frame()) {
      violations.Malformed(absl::StrCat(at, ".frame"),
                           absl::StrCat("is ", keyframe.frame(), ", wanted more than ",
                                        request.label_keyframes(i - 1).frame(),
                                        ", the frame of the keyframe before it"));
    }
    keyframes.push_back({static_cast<int>(std::min(keyframe.frame(), frames)),
                         ReadLabelVector(absl::StrCat(at, ".label_vector"), keyframe.label_vector(),
                                         model, limits, violations)});
  }
  return keyframes;
}

}  // namespace

std::vector<engine::LabelKeyframe> ValidateLabels(const v1::SynthesizeRequest& request,
                                                  const engine::ModelDescription& model,
                                                  const RequestLimits& limits,
                                                  Violations& violations) {
  const bool has_keyframes = !request.label_keyframes().empty();
  if (request.has_label_vector() && has_keyframes) {
    violations.Malformed("label_keyframes",
                         "is given together with label_vector, wanted one of the two");
  }
  if (!request.has_label_vector() && !has_keyframes) {
    violations.Malformed("label_vector", "is missing, wanted label_vector or label_keyframes");
  }
  std::vector<engine::LabelKeyframe> keyframes;
  if (has_keyframes) keyframes = ReadKeyframes(request, model, limits, violations);
  if (request.has_label_vector()) {
    keyframes.push_back(
        {0, ReadLabelVector("label_vector", request.label_vector(), model, limits, violations)});
  }
  return keyframes;
}

}  // namespace duet::server::service
