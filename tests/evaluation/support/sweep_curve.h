#ifndef DUET_TESTS_EVALUATION_SUPPORT_SWEEP_CURVE_H_
#define DUET_TESTS_EVALUATION_SUPPORT_SWEEP_CURVE_H_

#include <functional>

#include "model/evaluation/experiments/label_sweep.h"

namespace duet::test {

// A curve of two classes whose raised class has a probability that is a function of its weight.
evaluation::experiments::SweepCurve MakeSweepCurve(
    int own, int raised, const std::function<double(double)>& probability);

}  // namespace duet::test

#endif  // DUET_TESTS_EVALUATION_SUPPORT_SWEEP_CURVE_H_
