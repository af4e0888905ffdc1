#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_LABEL_SWEEP_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_LABEL_SWEEP_H_

#include <string>
#include <vector>

#include "model/evaluation/report/result_section.h"
#include "model/evaluation/report/table.h"

// The effect of a class's weight in the label vector on a judge's probability of that class.
//
// Source: the paper's graded and negative labels (section 3.1), which it shows but does not
// measure.

namespace duet::evaluation::experiments {

// -1, -0.75, ..., 2: the weights of a sweep, in order.
const std::vector<double>& SweepWeights();

// One leader answered at every weight of one class: the only class (own == raised), or beside the
// leader's own class at weight 1.
struct SweepCurve {
  int own = 0;                                    // the class of the leader's interaction
  int raised = 0;                                 // the class whose weight is swept
  std::vector<std::vector<float>> probabilities;  // [weights][classes]
};

// The label vector of a curve at a weight. Shapes: returns [classes].
std::vector<float> SweepLabels(int classes, int own, int raised, double weight);

// Changes of the probability up to this count as level.
inline constexpr double kLevelChange = 1e-3;

// How the raised class's probability follows its weight: shares of curves (of single steps in
// steps_*) and a mean over curves; NaN without any.
struct LabelControl {
  // From weight 0 to 1: the curves that rise, and that stay level.
  double raised_up = 0, raised_level = 0;
  // From weight 0 to -1: the curves that fall, and that stay level.
  double lowered_down = 0, lowered_level = 0;
  // Steps between neighbouring weights from 0 to 1: those that rise, and that stay level.
  double steps_up = 0, steps_level = 0;
  // Spearman's, of weight and probability over all weights.
  double rank_correlation = 0;
};
LabelControl MeasureControl(const std::vector<SweepCurve>& curves);

// Spearman's rank correlation, ties at their mean rank; 0 where either side is constant. Requires
// at least two samples, equally many on both sides.
double RankCorrelation(const std::vector<double>& x, const std::vector<double>& y);

// Selects curves.
enum class SweepKind {
  kOwn,   // only the leader's own class
  kAdded  // another class, beside the own one
};
std::vector<SweepCurve> Select(const std::vector<SweepCurve>& curves, SweepKind kind, int raised);

// The mean over curves of one class's probability. Shapes: returns [weights]; NaN without curves.
std::vector<double> MeanProbabilities(const std::vector<SweepCurve>& curves, int of_class);

// One row per raised class and one for all of them.
report::Table ControlTable(const std::string& title, const std::vector<std::string>& classes,
                           const std::vector<SweepCurve>& curves, SweepKind kind);

// The mean probability of each raised class, by its weight: one row per raised class.
report::Table ProbabilityTable(const std::string& title, const std::vector<std::string>& classes,
                               const std::vector<SweepCurve>& curves, SweepKind kind);

// Adds both tables for each kind. `told`: what the requests tell, the end of the titles, such as
// "without a start".
void AddSweep(const std::vector<std::string>& classes, const std::vector<SweepCurve>& curves,
              const std::string& told, report::ResultSection* section);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_LABEL_SWEEP_H_
