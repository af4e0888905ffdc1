#include "model/dataset/dataset.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/random.h"
#include "model/base/text.h"

namespace duet::dataset {
namespace {

std::vector<std::vector<int>> ByClass(const Dataset& dataset, const std::vector<int>& indices) {
  std::vector<std::vector<int>> by_class(dataset.classes.size());
  for (const int i : indices) {
    const Sequence& sequence = dataset.sequences[static_cast<size_t>(i)];
    by_class[static_cast<size_t>(sequence.interaction_class)].push_back(i);
  }
  return by_class;
}

size_t ValidationCount(size_t available, double fraction) {
  if (available < 2 || fraction <= 0) return 0;
  const auto wanted = static_cast<size_t>(std::lround(fraction * static_cast<double>(available)));
  return std::clamp<size_t>(wanted, 1, available - 1);
}

}  // namespace

std::vector<std::string> Dataset::TouchingClasses() const {
  std::vector<std::string> touching;
  for (size_t c = 0; c < classes.size(); ++c) {
    if (touches[c]) touching.push_back(classes[c]);
  }
  return touching;
}

std::vector<std::string> Dataset::Subjects() const {
  std::set<std::string> subjects;
  for (const Sequence& sequence : sequences) {
    subjects.insert(sequence.subjects.begin(), sequence.subjects.end());
  }
  return {subjects.begin(), subjects.end()};
}

int Dataset::LongestFrameCount() const {
  int longest = 0;
  for (const Sequence& sequence : sequences) {
    longest = std::max(longest, sequence.pair.leader.frame_count());
  }
  return longest;
}

std::vector<int> AllSequences(const Dataset& dataset) {
  std::vector<int> all(dataset.sequences.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

absl::StatusOr<Split> LeaveSubjectOut(const Dataset& dataset, const std::string& subject) {
  Split split;
  for (size_t i = 0; i < dataset.sequences.size(); ++i) {
    const std::vector<std::string>& subjects = dataset.sequences[i].subjects;
    const bool present = std::find(subjects.begin(), subjects.end(), subject) != subjects.end();
    (present ? split.test : split.train).push_back(static_cast<int>(i));
  }
  if (!split.test.empty()) return split;
  const std::vector<std::string> known = dataset.Subjects();
  if (known.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        dataset.name,
        ": subjects: expected sequences that name their people, got none; to leave people out, "
        "list "
        "them in the column subjects of index.tsv, or of duet-import's table (docs/datasets.md)"));
  }
  return absl::NotFoundError(absl::StrCat("subject: expected one of ", dataset.name,
                                          "'s: ", absl::StrJoin(known, ", "), ", got ",
                                          base::Quoted(subject)));
}

absl::StatusOr<Split> SplitInHalves(const Dataset& dataset, uint64_t seed) {
  std::vector<std::vector<int>> by_class = ByClass(dataset, AllSequences(dataset));
  base::Random random(seed);
  Split split;
  for (size_t c = 0; c < by_class.size(); ++c) {
    std::vector<int>& indices = by_class[c];
    if (indices.size() < 2) {
      return absl::InvalidArgumentError(
          absl::StrCat(dataset.name,
                       ": expected at least 2 sequences of each class to split in "
                       "halves, got ",
                       indices.size(), " of ", dataset.classes[c]));
    }
    random.Shuffle(&indices);
    const auto middle = indices.begin() + static_cast<std::ptrdiff_t>((indices.size() + 1) / 2);
    split.train.insert(split.train.end(), indices.begin(), middle);
    split.test.insert(split.test.end(), middle, indices.end());
  }
  std::sort(split.train.begin(), split.train.end());
  std::sort(split.test.begin(), split.test.end());
  return split;
}

std::vector<int> TakeValidation(const Dataset& dataset, double fraction, uint64_t seed,
                                std::vector<int>* train) {
  std::sort(train->begin(), train->end());
  std::vector<std::vector<int>> by_class = ByClass(dataset, *train);
  base::Random random(seed);
  std::vector<int> validation;
  train->clear();
  for (std::vector<int>& indices : by_class) {
    random.Shuffle(&indices);
    const auto cut =
        indices.begin() + static_cast<std::ptrdiff_t>(ValidationCount(indices.size(), fraction));
    validation.insert(validation.end(), indices.begin(), cut);
    train->insert(train->end(), cut, indices.end());
  }
  std::sort(validation.begin(), validation.end());
  std::sort(train->begin(), train->end());
  return validation;
}

}  // namespace duet::dataset
