#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_LABEL_SWEEP_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_LABEL_SWEEP_H_

#include <string>
#include <vector>

#include "model/evaluation/report/result_section.h"

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

// Adds two tables for the own class alone, and two for another class beside it; a row for each
// class. The first has the shares of curves whose probability goes the way its weight goes (from 0
// to 1, from 0 to -1, in single steps between 0 and 1), those that stay level, and the rank
// correlation (Spearman's) over all weights; the second the mean probability at each weight. NaN
// without curves. `told`: what the requests tell, the end of the titles, such as "without a start".
void AddSweep(const std::vector<std::string>& classes, const std::vector<SweepCurve>& curves,
              const std::string& told, report::ResultSection* section);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_LABEL_SWEEP_H_
