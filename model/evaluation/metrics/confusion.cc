#include "model/evaluation/metrics/confusion.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace duet::evaluation::metrics {
namespace {
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
}  // namespace

Confusion::Confusion(int classes)
    : classes_(classes), counts_(static_cast<size_t>(classes) * static_cast<size_t>(classes)) {}

void Confusion::Add(int meant, int taken_for) {
  ++counts_[static_cast<size_t>(meant * classes_ + taken_for)];
}

void Confusion::AddLikeliest(const std::vector<int>& meant,
                             const std::vector<std::vector<float>>& probabilities) {
  for (size_t i = 0; i < meant.size(); ++i) {
    const std::vector<float>& one = probabilities[i];
    Add(meant[i], static_cast<int>(std::max_element(one.begin(), one.end()) - one.begin()));
  }
}

int Confusion::count(int meant, int taken_for) const {
  return counts_[static_cast<size_t>(meant * classes_ + taken_for)];
}

int Confusion::Total(int meant) const {
  int total = 0;
  for (int i = 0; i < classes_; ++i) total += count(meant, i);
  return total;
}

double Confusion::ClassAccuracy(int meant) const {
  const int total = Total(meant);
  return total == 0 ? kNone : static_cast<double>(count(meant, meant)) / total;
}

std::vector<double> Confusion::ClassAccuracies() const {
  std::vector<double> accuracies;
  for (int c = 0; c < classes_; ++c) accuracies.push_back(ClassAccuracy(c));
  return accuracies;
}

double Confusion::Accuracy() const {
  int right = 0, total = 0;
  for (int i = 0; i < classes_; ++i) {
    right += count(i, i);
    total += Total(i);
  }
  return total == 0 ? kNone : static_cast<double>(right) / total;
}

double Confusion::MeanClassAccuracy() const {
  double sum = 0, present = 0;
  for (int i = 0; i < classes_; ++i) {
    if (Total(i) == 0) continue;
    sum += ClassAccuracy(i);
    ++present;
  }
  return present == 0 ? kNone : sum / present;
}

}  // namespace duet::evaluation::metrics
