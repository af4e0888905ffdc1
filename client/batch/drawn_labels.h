#ifndef DUET_CLIENT_BATCH_DRAWN_LABELS_H_
#define DUET_CLIENT_BATCH_DRAWN_LABELS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/batch/recipe.h"
#include "model/base/random.h"

namespace duet::client::batch {

// Label vectors that are drawn for each leader. `classes` are the classes of the reaction, or those
// of the model if the reaction names none.

struct WeightRange {
  float min = 1;
  float max = 1;
};
// What the messages say, with their defaults.
WeightRange RangeOf(const v1::Mixes& mixes);
WeightRange RangeOf(const v1::EachClass& each);
uint32_t ClassesInMix(const v1::Mixes& mixes);

// Whether the label vectors of a reaction are drawn.
bool IsDrawn(const v1::Reaction& reaction);
// The classes of mixes, or of a vector for each class; empty: the model's.
std::vector<std::string> ClassesOf(const v1::Reaction& reaction);
// INVALID_ARGUMENT if the reaction needs more classes in a vector than there are.
absl::Status CheckDrawn(const v1::Reaction& reaction, const std::vector<std::string>& classes);

struct DrawnLabels {
  std::string name;
  Labels labels;
};
// The number of vectors and their names do not depend on the random numbers. Requires a reaction
// that CheckDrawn accepts.
std::vector<DrawnLabels> Draw(const v1::Reaction& reaction, const std::vector<std::string>& classes,
                              base::Random* random);

// A class or a model as a part of a file name, without dashes, which separate the parts.
std::string PlainName(const std::string& name);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_DRAWN_LABELS_H_
