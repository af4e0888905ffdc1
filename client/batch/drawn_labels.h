#ifndef DUET_CLIENT_BATCH_DRAWN_LABELS_H_
#define DUET_CLIENT_BATCH_DRAWN_LABELS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/batch/recipe.h"
#include "model/base/random.h"

namespace duet::client::batch {

// Label vectors that are drawn for each leader. `classes` are those of the reaction, or the model's
// where it names none.

// Whether a reaction's are.
bool IsDrawn(const Reaction& reaction);
// Its classes; empty: the model's.
const std::vector<std::string>& ClassesOf(const Reaction& reaction);
// INVALID_ARGUMENT where it wants more classes in a vector than there are.
absl::Status CheckDrawn(const Reaction& reaction, const std::vector<std::string>& classes);

struct DrawnLabels {
  std::string name;
  Labels labels;
};
// As many whatever is drawn, of the same names. Requires what CheckDrawn accepts.
std::vector<DrawnLabels> Draw(const Reaction& reaction, const std::vector<std::string>& classes,
                              base::Random* random);

// A class or a model as a part of a file name: no dashes, which separate the parts.
std::string PlainName(const std::string& name);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_DRAWN_LABELS_H_
