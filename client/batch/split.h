#ifndef DUET_CLIENT_BATCH_SPLIT_H_
#define DUET_CLIENT_BATCH_SPLIT_H_

#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::client::batch {

// How a data set is divided for training: the shares of leaders, from 0 to below 1 together, of the
// splits other than "train".
struct Splits {
  double validation = 0;
  double test = 0;
  bool any() const { return validation > 0 || test > 0; }
};

inline constexpr char kTrain[] = "train";

// The names of the splits with leaders, in their order: "train" first.
std::vector<std::string> SplitNames(const Splits& splits);

// The split of all items of a leader. It depends only on the digest of the leader's file, or of the
// leader's group, so a leader stays in its split whatever leaders, shards of a job or reactions are
// added, and the same file under two names is in one split. A larger share only moves leaders out
// of "train".
std::string SplitOf(const Splits& splits, absl::string_view sha256);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SPLIT_H_
