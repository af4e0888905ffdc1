#ifndef DUET_CLIENT_BATCH_PLAN_H_
#define DUET_CLIENT_BATCH_PLAN_H_

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/leaders.h"
#include "client/batch/recipe.h"
#include "client/result.h"

namespace duet::client::batch {

// One follower to make.
struct Item {
  int64_t number = 0;  // from 0, in the order of the leaders
  std::string id;      // 32 hex digits: the digest of the whole request
  std::string asked;   // the same of what is asked of the leader's file
  std::string place;   // 32 hex digits that decide the shard that has the item
  std::string name;    // unique path of its files, without extension
  std::shared_ptr<const LeaderEntry> leader;
  formats::Side side = formats::Side::kLeft;
  std::string reaction;
  Labels labels;
  bool drawn = false;  // the labels are drawn for the leader
  int model = 0;       // index into the plan's models
  int sample = 0;
};

// The seed of an item's answer; `retry` 0 is the first. `content` are the digests of the leader's
// file and of that of the follower's start. Below 2^53 unless the manifest specifies it, so that
// every JSON reader can represent it.
uint64_t SeedOf(const Item& item, uint64_t recipe_seed, absl::string_view content, int retry);

// One of several jobs that make a data set together, each a part of the items.
struct Shard {
  int index = 0;
  int count = 1;

  // Whether an item belongs to this shard. Depends only on a hash of Item::place, so that the
  // shards have similar sizes on every machine and for every order of the leaders.
  bool Has(absl::string_view place) const;
};

// "2/8": the third of eight. INVALID_ARGUMENT.
absl::StatusOr<Shard> ParseShard(absl::string_view text);

// The items of a recipe and a list of leaders, one after the other. Memory does not depend on the
// length of the list.
class Plan {
 public:
  // `models` are the recipe's models, in its order. INVALID_ARGUMENT for classes that a model does
  // not have, two reactions with the same name, and several samples of a model that does not
  // sample.
  static absl::StatusOr<Plan> Create(Recipe recipe, std::vector<ModelInfo> models,
                                     std::unique_ptr<LeaderSource> leaders);

  // The next item; nullopt at the end. After INVALID_ARGUMENT, which concerns one leader or one
  // line of a manifest (an unknown class, a name of more than 200 bytes), the next call continues
  // with the next leader. Any other error ends the plan.
  absl::StatusOr<std::optional<Item>> Next();

 private:
  struct LabelledReaction {
    std::string name;
    Labels labels;
    bool drawn = false;
  };

  Plan(Recipe recipe, std::vector<ModelInfo> models, std::unique_ptr<LeaderSource> leaders);
  absl::Status AddReaction(const v1::Reaction& reaction);
  absl::Status AddDrawn(const v1::Reaction& reaction);
  absl::Status AddNamed(const v1::Reaction& reaction, Labels labels);
  absl::Status CheckClasses() const;
  absl::Status CheckLabels(const LeaderEntry& leader) const;
  // The classes of mixes, or of a vector for each class.
  std::vector<std::string> ClassesOf(const v1::Reaction& reaction) const;
  std::string DrawnFrom(const LeaderEntry& leader);
  void DrawFor(const LeaderEntry& leader);
  absl::Status BeginLeader(LeaderEntry leader);
  Item MakeItem();
  std::string NameOf(const Item& item) const;
  bool Advance();

  Recipe recipe_;
  std::vector<ModelInfo> models_;
  std::unique_ptr<LeaderSource> leaders_;
  std::vector<LabelledReaction> fixed_;  // the same for each leader
  std::vector<v1::Reaction> drawn_;      // mixes, different for each leader

  // The current leader, and the position of the next item in it.
  std::shared_ptr<const LeaderEntry> leader_;
  std::vector<formats::Side> sides_;
  std::vector<LabelledReaction> reactions_;
  size_t side_ = 0, reaction_ = 0, model_ = 0;
  int sample_ = 0;
  int64_t number_ = 0;
};

// The items of a plan that a run makes.
struct PlanPart {
  Shard shard;
  int64_t limit = std::numeric_limits<int64_t>::max();  // only the first items of the plan
  bool Has(const Item& item) const { return item.number < limit && shard.Has(item.place); }
};

// The result of checking a plan before the first call.
struct PlanCheck {
  int64_t items = 0;    // of the part
  int64_t leaders = 0;  // leading people, counted as often as they are listed
  int64_t files = 0;    // different leaders, as listed

  // Invalid lines of a manifest, in the order of the list; at most kListed are stored.
  static constexpr size_t kListed = 1000;
  int64_t bad_line_count = 0;
  std::vector<std::string> bad_lines;  // "FILE:LINE: FIELD: expected ..., got ..."
};

// Reads the plan to its end. `visit` is called for each item of the part, in the order of the plan
// and up to the first bad line, which shifts the numbers of items; its error ends the check.
// `stopped` is called between items; once it returns true, the check ends with what it has. Errors:
// those that end the plan, and those of `visit`.
absl::StatusOr<PlanCheck> CheckPlan(
    const PlanPart& part, Plan* plan, const std::function<absl::Status(const Item&)>& visit,
    const std::function<bool()>& stopped = [] { return false; });

// INVALID_ARGUMENT with a list of the bad lines, if the plan has any: its run must not begin.
absl::Status BadLinesError(const PlanCheck& check);

// Classes and weights as a name: "kick", "kick0p5+hug1". A single weight of 1 is left out.
std::string NameOfLabels(const Labels& labels);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_PLAN_H_
