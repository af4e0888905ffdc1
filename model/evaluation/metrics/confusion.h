#ifndef DUET_MODEL_EVALUATION_METRICS_CONFUSION_H_
#define DUET_MODEL_EVALUATION_METRICS_CONFUSION_H_

#include <vector>

namespace duet::evaluation::metrics {

// How often motions meant as one class were taken for another.
class Confusion {
 public:
  explicit Confusion(int classes);

  // Both in [0, classes).
  void Add(int meant, int taken_for);

  int class_count() const { return classes_; }
  int count(int meant, int taken_for) const;
  // The share of motions meant as a class that were taken for it; NaN without any such motion.
  double ClassAccuracy(int meant) const;
  // The share of all motions that were taken for what they were meant as; NaN without any.
  double Accuracy() const;
  // The mean of ClassAccuracy over the classes that have motions: each class counts alike.
  double MeanClassAccuracy() const;

 private:
  int Total(int meant) const;

  int classes_;
  std::vector<int> counts_;  // [meant, taken_for]
};

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_CONFUSION_H_
