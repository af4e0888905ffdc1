#include "model/dataset/dataset.h"

#include <algorithm>
#include <set>

namespace duet::dataset {

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

}  // namespace duet::dataset
