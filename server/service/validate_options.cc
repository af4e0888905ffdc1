#include "server/service/validate_options.h"

#include <cstdint>
#include <optional>

#include "absl/strings/str_cat.h"
#include "model/base/text.h"

namespace duet::server::service {
namespace {

static_assert(RequestLimits().max_candidates == engine::kMostCandidates);

int ValidateCandidates(const v1::SynthesizeRequest& request, const RequestLimits& limits,
                       Violations& violations) {
  if (!request.has_candidates()) return engine::kDefaultCandidates;
  const uint32_t candidates = request.candidates();
  if (candidates >= 1 && candidates <= static_cast<uint32_t>(limits.max_candidates)) {
    return static_cast<int>(candidates);
  }
  violations.Malformed("candidates", absl::StrCat("1 to ", limits.max_candidates),
                       absl::StrCat(candidates));
  return engine::kDefaultCandidates;
}

engine::Sampling ValidateSampling(const v1::SynthesizeRequest& request, const RequestLimits& limits,
                                  Violations& violations) {
  engine::Sampling sampling;
  if (request.has_seed()) sampling.seed = request.seed();
  if (request.has_variety()) sampling.variety = request.variety();
  // Negated, so that NaN is rejected.
  if (!(sampling.variety >= 0 && sampling.variety <= limits.max_variety)) {
    violations.Malformed("variety", absl::StrCat("a finite value in [0, ", limits.max_variety, "]"),
                         base::NumberText(request.variety()));
  }
  if (request.has_reaction()) sampling.reaction = request.reaction();
  if (!(sampling.reaction >= 0 && sampling.reaction <= engine::kMostReaction)) {
    violations.Malformed("reaction",
                         absl::StrCat("a finite value in [0, ", engine::kMostReaction, "]"),
                         base::NumberText(request.reaction()));
  }
  sampling.candidates = ValidateCandidates(request, limits, violations);
  return sampling;
}

std::optional<bool> ValidateCleanUp(const v1::SynthesizeRequest& request, Violations& violations) {
  switch (request.clean_up()) {
    case v1::CLEAN_UP_UNSPECIFIED:
      return std::nullopt;
    case v1::CLEAN_UP_ON:
      return true;
    case v1::CLEAN_UP_OFF:
      return false;
    default:
      violations.Malformed("clean_up", "CLEAN_UP_ON, CLEAN_UP_OFF or no value",
                           absl::StrCat(request.clean_up()));
      return std::nullopt;
  }
}

}  // namespace

engine::SynthesisOptions ValidateOptions(const v1::SynthesizeRequest& request,
                                         const RequestLimits& limits, Violations& violations) {
  engine::SynthesisOptions options;
  options.sampling = ValidateSampling(request, limits, violations);
  options.clean_up = ValidateCleanUp(request, violations);
  return options;
}

}  // namespace duet::server::service
