#include "client/batch/capture_layout.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

// The folder for leaders that are not from SBU.
constexpr char kNobodysSet[] = "s00s00";

std::string SetOf(const std::string& leader) {
  std::string set = kNobodysSet;
  for (const std::filesystem::path& part : std::filesystem::path(leader)) {
    if (dataset::IsSbuSet(part.string())) set = part.string();
  }
  return set;
}

}  // namespace

const dataset::DatasetLayout* CapturesOf(v1::Layout layout) {
  static const auto* const sbu = new dataset::DatasetLayout(dataset::SbuLayout());
  static const auto* const k3hi = new dataset::DatasetLayout(dataset::K3hiLayout());
  if (layout == v1::LAYOUT_SBU) return sbu;
  return layout == v1::LAYOUT_K3HI ? k3hi : nullptr;
}

absl::Status CheckJoints(const dataset::DatasetLayout& captures, const ModelInfo& model) {
  const std::vector<std::string>& wanted = captures.skeleton.joint_names;
  if (model.joint_names == wanted) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      "output.layout: expected a model with the joints ", absl::StrJoin(wanted, ", "), ", got ",
      model.name, "@", model.version, " with ", absl::StrJoin(model.joint_names, ", ")));
}

absl::StatusOr<std::string> CaptureFolder(v1::Layout layout, const std::string& interaction_class,
                                          const std::string& leader) {
  const std::vector<dataset::ClassLayout>& classes = CapturesOf(layout)->classes;
  const auto found =
      std::find_if(classes.begin(), classes.end(),
                   [&](const dataset::ClassLayout& one) { return one.name == interaction_class; });
  if (found != classes.end()) {
    return layout == v1::LAYOUT_SBU ? absl::StrCat(SetOf(leader), "/", found->folder)
                                    : found->folder;
  }
  std::vector<std::string> names;
  for (const dataset::ClassLayout& one : classes) names.push_back(one.name);
  return absl::InvalidArgumentError(
      absl::StrCat("class of the largest weight: expected one that the layout has a folder for (",
                   absl::StrJoin(names, ", "), "), got ", base::Quoted(interaction_class)));
}

std::string CaptureName(v1::Layout layout, const std::string& folder, int number) {
  const std::string sequence = absl::StrFormat("%s/%03d", folder, number);
  return layout == v1::LAYOUT_SBU ? sequence + "/skeleton_pos" : sequence;
}

}  // namespace duet::client::batch
