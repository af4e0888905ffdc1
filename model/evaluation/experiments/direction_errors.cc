#include "model/evaluation/experiments/direction_errors.h"

#include <cmath>
#include <cstddef>

#include "model/base/angle.h"
#include "model/dataset/partner_direction.h"
#include "model/engine/window_standardisation.h"

namespace duet::evaluation::experiments {
std::vector<double> DirectionErrors(const dataset::Dataset& dataset, const std::vector<int>& tests,
                                    const std::optional<engine::DirectionRegression>& regression) {
  std::vector<double> errors;
  for (const int test : tests) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<std::size_t>(test)];
    engine::SynthesisWindow window;
    window.leader = sequence.pair.leader.poses;
    if (regression) {
      std::vector<float> label(static_cast<std::size_t>(dataset.class_count()), 0);
      label[static_cast<std::size_t>(sequence.interaction_class)] = 1;
      window.partner_direction =
          EstimatePartnerDirection(*regression, dataset.skeleton, window.leader, label);
    }
    const double expected = WindowStandardisation(dataset.skeleton, window).yaw();
    const double actual = motion::FacingYaw(PartnerDirection(dataset.skeleton, sequence));
    errors.push_back(base::kDegreesPerRadian *
                     std::abs(std::remainder(expected - actual, 2 * M_PI)));
  }
  return errors;
}

}  // namespace duet::evaluation::experiments
