#ifndef DUET_CLIENT_BATCH_PLAN_H_
#define DUET_CLIENT_BATCH_PLAN_H_

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/leader_entry.h"
#include "client/batch/leader_source.h"
#include "client/batch/recipe.h"
#include "client/result.h"

namespace duet::client::batch {

// One follower to make.
struct Item {
  int64_t number = 0;     // from 0, in the order of the leaders
  std::string id;         // 32 hex digits: the digest of all that is asked
  std::string name;       // its files without their endings; no other item has it
  std::string full_name;  // what `name` was shortened from; empty unless it was
  std::shared_ptr<const LeaderEntry> leader;
  formats::Side side = formats::Side::kLeft;
  std::string reaction;
  Labels labels;                              // or keyframes
  std::vector<Schedule::Keyframe> keyframes;  // in parts of the leader's length
  int model = 0;                              // of the plan's
  int sample = 0;
};

// The seed of an item's answer, `retry` 0 the first. Below 2^53 where nobody gave one, so that
// every JSON reader keeps it.
uint64_t SeedOf(const Item& item, uint64_t recipe_seed, int retry);

// The items of a recipe and a list of leaders, one after the other: nothing is kept of those before
// and after, so that lists of any length take the same memory.
class Plan {
 public:
  // `models` are what the recipe's stand for, in its order. INVALID_ARGUMENT for classes that a
  // model does not have, two reactions of one name, samples of a model that has one answer, and
  // joints that the layout does not have.
  static absl::StatusOr<Plan> Create(Recipe recipe, std::vector<ModelInfo> models,
                                     std::unique_ptr<LeaderSource> leaders);

  // The next item; nothing at the end. INVALID_ARGUMENT is of one leader or one line of a manifest,
  // such as a class that the model or the layout does not have: the call after it goes on with the
  // next leader. Any other error ends the plan.
  absl::StatusOr<std::optional<Item>> Next();

 private:
  struct LabelledReaction {
    std::string name;
    Labels labels;
    std::vector<Schedule::Keyframe> keyframes;
  };

  Plan(Recipe recipe, std::vector<ModelInfo> models, std::unique_ptr<LeaderSource> leaders);
  absl::Status AddReaction(const Reaction& reaction);
  absl::Status AddDrawn(const Reaction& reaction);
  absl::Status AddNamed(const Reaction& reaction, LabelledReaction labelled);
  absl::Status CheckClasses() const;
  absl::Status CheckClassifier(const ModelInfo& model) const;
  std::string ModelNames() const;
  absl::Status CheckLabels(const LeaderEntry& leader) const;
  std::vector<std::string> ClassesOr(const std::vector<std::string>& classes) const;
  void DrawFor(const LeaderEntry& leader);
  absl::Status BeginLeader(LeaderEntry leader);
  absl::StatusOr<Item> MakeItem();
  absl::StatusOr<std::string> NameOf(const Item& item);
  bool Advance();

  Recipe recipe_;
  std::vector<ModelInfo> models_;
  std::unique_ptr<LeaderSource> leaders_;
  std::vector<LabelledReaction> fixed_;  // the same for each leader
  std::vector<Reaction> drawn_;          // another for each

  // The leader at hand, and where in it the next item is.
  std::shared_ptr<const LeaderEntry> leader_;
  std::vector<formats::Side> sides_;
  std::vector<LabelledReaction> reactions_;
  std::vector<int> leader_models_;
  size_t side_ = 0, reaction_ = 0, model_ = 0;
  int sample_ = 0;
  int64_t number_ = 0;
  std::map<std::string, int> clips_;  // of a layout of captures, so far by folder
};

// The class that is wanted most, of keyframes over all of them; "none" where none is.
std::string LargestClass(const Item& item);

// "kick", "kick0p5+hug1": classes and weights as a name; a lone weight of 1 goes without saying.
std::string NameOfLabels(const Labels& labels);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_PLAN_H_
