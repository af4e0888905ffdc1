#include "model/training/class_fits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "model/engine/facing_fit.h"
#include "model/engine/hand_contact_fit.h"

namespace duet::training {
namespace {

// Adds every stretch of a class to a fit (HandContactFit, FacingFit).
template <typename Fit>
void AddStretches(const dataset::Dataset& dataset, const std::vector<int>& sequences,
                  int interaction_class, Fit* fit) {
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    const motion::ClipPair& pair = sequence.pair;
    const auto add = [&](const dataset::LabelSpan& span) {
      if (span.interaction_class != interaction_class) return;
      fit->Add(pair.leader.poses, pair.follower.poses, span.begin, span.end);
    };
    std::for_each(sequence.labels.begin(), sequence.labels.end(), add);
    if (sequence.labels.empty()) add({sequence.interaction_class, 0, pair.leader.frame_count()});
  }
}

}  // namespace

void FindContacts(const dataset::Dataset& dataset, const std::vector<int>& sequences,
                  engine::ModelDescription* model) {
  for (int c = 0; c < dataset.class_count(); ++c) {
    const std::string& name = dataset.classes[static_cast<size_t>(c)];
    engine::HandContactFit hands(dataset.skeleton);
    AddStretches(dataset, sequences, c, &hands);
    if (const std::optional<double> metres = hands.Metres(dataset.frame_rate_hz)) {
      model->hand_contacts.push_back({name, *metres});
    }
  }
}

std::vector<engine::FacingClass> FindFacingClasses(const dataset::Dataset& dataset,
                                                   const std::vector<int>& sequences) {
  std::vector<engine::FacingClass> classes;
  for (int c = 0; c < dataset.class_count(); ++c) {
    engine::FacingFit fit(dataset.skeleton, dataset.frame_rate_hz);
    AddStretches(dataset, sequences, c, &fit);
    const std::optional<double> degrees = fit.Degrees();
    if (degrees) classes.push_back({dataset.classes[static_cast<size_t>(c)], std::round(*degrees)});
  }
  return classes;
}

}  // namespace duet::training
