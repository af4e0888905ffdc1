#include "model/evaluation/baselines/baselines.h"

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"
#include "model/evaluation/baselines/class_mean.h"
#include "model/evaluation/baselines/discrete_mdp.h"
#include "model/evaluation/baselines/frozen_first_frame.h"
#include "model/evaluation/baselines/hmm.h"
#include "model/evaluation/baselines/kernel_rl.h"
#include "model/evaluation/baselines/maxent_ioc.h"
#include "model/evaluation/baselines/nearest_neighbour.h"

namespace duet::evaluation::baselines {
namespace {

using Maker = std::unique_ptr<protocol::Method> (*)();

template <typename T>
std::unique_ptr<protocol::Method> Make() {
  return std::make_unique<T>();
}

struct Entry {
  const char* name;
  Maker make;
};

constexpr Entry kBaselines[] = {
    {"class_mean", Make<ClassMean>},
    {"frozen_first_frame", Make<FrozenFirstFrame>},
    {"nearest_neighbour", Make<NearestNeighbour>},
    {"hmm", Make<Hmm>},
    {"kzbh12", Make<DiscreteMdp>},
    {"hk14", Make<KernelRl>},
    {"hfkb15", Make<MaxEntIoc>},
};

}  // namespace

std::vector<std::string> BaselineNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kBaselines) names.push_back(entry.name);
  return names;
}

absl::StatusOr<std::unique_ptr<protocol::Method>> MakeBaseline(const std::string& name) {
  for (const Entry& entry : kBaselines) {
    if (name == entry.name) return entry.make();
  }
  return absl::InvalidArgumentError(absl::StrCat("method: ", base::Quoted(name), ", wanted one of ",
                                                 absl::StrJoin(BaselineNames(), ", ")));
}

}  // namespace duet::evaluation::baselines
