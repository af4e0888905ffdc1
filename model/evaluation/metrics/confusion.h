#ifndef DUET_MODEL_EVALUATION_METRICS_CONFUSION_H_
#define DUET_MODEL_EVALUATION_METRICS_CONFUSION_H_

#include <vector>

namespace duet::evaluation::metrics {

// Counts how often motions of one class were classified as another.
class Confusion {
 public:
  explicit Confusion(int classes);

  // Both in [0, classes).
  void Add(int meant, int taken_for);
  // Counts the likeliest class of each motion. Shapes: meant [motions], probabilities
  // [motions][classes].
  void AddLikeliest(const std::vector<int>& meant,
                    const std::vector<std::vector<float>>& probabilities);

  int count(int meant, int taken_for) const;
  // The share of a class's motions that were classified correctly; NaN without any.
  double ClassAccuracy(int meant) const;
  // ClassAccuracy of every class.
  std::vector<double> ClassAccuracies() const;
  // The share of all motions that were classified correctly; NaN without any.
  double Accuracy() const;
  // The mean of ClassAccuracy over the classes that have motions: all classes have equal weight.
  double MeanClassAccuracy() const;

 private:
  int Total(int meant) const;

  int classes_;
  std::vector<int> counts_;  // [actual, predicted]
};

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_CONFUSION_H_
