#include "client/batch/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "absl/container/flat_hash_set.h"
#include "absl/hash/hash.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/batch/journal.h"
#include "client/batch/text_values.h"
#include "model/base/counted.h"
#include "model/base/random.h"
#include "model/base/sha256.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

constexpr size_t kIdDigits = 32;
// File systems allow 255 bytes; extensions and the names of temporary files need the rest.
constexpr std::size_t kMaxPartBytes = 200;
// Linux opens paths of up to 4095 bytes; the data set's folder needs the rest.
constexpr std::size_t kMaxPathBytes = 1000;
// Drawn weights are multiples of 1 / kWeightsInOne, so that they have few decimals.
constexpr double kWeightsInOne = 1000;

uint64_t HexNumber(absl::string_view digits) {
  uint64_t number = 0;
  (void)absl::SimpleHexAtoi(digits, &number);
  return number;
}

// 52 bits.
uint64_t DrawnNumber(const std::string& from) {
  return HexNumber(base::Sha256Hex(from).substr(0, 13));
}

std::string Text(const Labels& labels) {
  std::string text;
  for (const ClassWeight& label : labels) {
    absl::StrAppend(&text, label.interaction_class, "=", WeightText(label.weight), ";");
  }
  return text;
}

// What is asked of the leader `who`, as text; `start` is the follower's start.
std::string Asked(const Item& item, const Recipe& recipe, const ModelInfo& model,
                  const std::string& who, const std::string& start) {
  const LeaderEntry& leader = *item.leader;
  std::string text = absl::StrCat(who, "\n", SideName(item.side), "\n", item.reaction, "\n",
                                  Text(item.labels), "\n", model.name, "@", model.version, "\n",
                                  item.sample, "\n", recipe.variety, "\n", start, "\n");
  if (leader.partner_direction) {
    const motion::Vec3& to = *leader.partner_direction;
    absl::StrAppend(&text, "direction ", to.x, ",", to.y, ",", to.z, "\n");
  }
  if (recipe.candidates != 1) absl::StrAppend(&text, "candidates ", recipe.candidates, "\n");
  if (recipe.input.up) {
    const motion::Vec3& up = *recipe.input.up;
    absl::StrAppend(&text, "up ", up.x, ",", up.y, ",", up.z, "\n");
  }
  absl::StrAppend(&text, "seed ", leader.seed ? absl::StrCat(*leader.seed) : "", " ", recipe.seed);
  return text;
}

std::string Digest(const std::string& text) { return base::Sha256Hex(text).substr(0, kIdDigits); }

// Sets the digests of the request, of which the id is unique to each item.
void SetDigests(const Recipe& recipe, const ModelInfo& model, Item* item) {
  const LeaderEntry& leader = *item->leader;
  std::string who = absl::StrCat(leader.key, "\n", leader.given);
  if (!leader.group.empty()) absl::StrAppend(&who, "\ngroup ", leader.group);
  item->id = Digest(Asked(*item, recipe, model, who, leader.follower_start));
  // Without the paths, which the content of the files stands for.
  const bool is_point = ParsePoint(leader.follower_start).has_value();
  item->asked = Digest(Asked(*item, recipe, model, leader.has_id ? leader.key : "",
                             is_point ? leader.follower_start : ""));
  // Without labels, which may be drawn from the content: an item whose leader is mended stays in
  // its shard.
  item->place = Digest(absl::StrCat(leader.key, "\n", SideName(item->side), "\n", item->reaction,
                                    "\n", item->model, "\n", item->sample));
}

// The prefix of a leader's errors: its line of the manifest, or the leader as listed.
const std::string& PlaceOf(const LeaderEntry& leader) {
  return leader.line.empty() ? leader.given : leader.line;
}

bool HasClass(const ModelInfo& model, const std::string& name) {
  const auto& known = model.interaction_classes;
  return std::find(known.begin(), known.end(), name) != known.end();
}

// INVALID_ARGUMENT for a name that file systems cannot hold.
absl::Status CheckName(const Item& item) {
  std::size_t longest = 0;
  for (const absl::string_view part : absl::StrSplit(item.name, '/')) {
    longest = std::max(longest, part.size());
  }
  if (longest <= kMaxPartBytes && item.name.size() <= kMaxPathBytes) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      PlaceOf(*item.leader), ": name: expected at most ", kMaxPathBytes, " bytes in parts of ",
      kMaxPartBytes, ", got ", item.name.size(), " in parts of ", longest, ": ", item.name,
      ". Name the leader by a shorter id in a manifest"));
}

float DrawWeight(const WeightRange& range, base::Random* random) {
  const double weight = random->Uniform(range.min, range.max);
  return static_cast<float>(std::round(weight * kWeightsInOne) / kWeightsInOne);
}

Labels DrawMix(const v1::Mixes& mixes, std::vector<std::string> classes, base::Random* random) {
  random->Shuffle(&classes);
  Labels labels;
  for (uint32_t c = 0; c < ClassesInMix(mixes); ++c) {
    labels.push_back({classes[c], DrawWeight(RangeOf(mixes), random)});
  }
  SortByClass(&labels);
  return labels;
}

// A class or a model as a part of a file name, without dashes, which separate the parts.
std::string PlainName(const std::string& name) {
  return absl::StrReplaceAll(KeyOf(name), {{"/", "_"}, {"-", "_"}, {"+", "_"}});
}

}  // namespace

bool Shard::Has(absl::string_view item_id) const {
  // The id is a digest, so its hex digits are uniformly distributed.
  return static_cast<int>(HexNumber(item_id.substr(0, 8)) % static_cast<uint64_t>(count)) == index;
}

absl::StatusOr<Shard> ParseShard(absl::string_view text) {
  const std::pair<std::string, std::string> parts = absl::StrSplit(text, absl::MaxSplits('/', 1));
  Shard shard;
  if (absl::SimpleAtoi(parts.first, &shard.index) && absl::SimpleAtoi(parts.second, &shard.count) &&
      shard.index >= 0 && shard.index < shard.count) {
    return shard;
  }
  return absl::InvalidArgumentError(
      absl::StrCat("expected INDEX/COUNT such as 0/8, with an index from 0 to COUNT - 1, got ",
                   base::Quoted(text)));
}

std::string NameOfLabels(const Labels& labels) {
  std::string name;
  for (const ClassWeight& label : labels) {
    if (!name.empty()) name += '+';
    name += PlainName(label.interaction_class);
    if (labels.size() == 1 && label.weight == 1) continue;
    name += absl::StrReplaceAll(WeightText(label.weight), {{".", "p"}, {"-", "m"}, {"+", ""}});
  }
  return name;
}

uint64_t SeedOf(const Item& item, uint64_t recipe_seed, absl::string_view content, int retry) {
  if (item.leader->seed.has_value() && retry == 0) {
    return *item.leader->seed + static_cast<uint64_t>(item.sample);
  }
  return DrawnNumber(absl::StrCat("seed ", recipe_seed, " ", content, " ", item.asked, " ", retry));
}

Plan::Plan(Recipe recipe, std::vector<ModelInfo> models, std::unique_ptr<LeaderSource> leaders)
    : recipe_(std::move(recipe)), models_(std::move(models)), leaders_(std::move(leaders)) {}

absl::StatusOr<Plan> Plan::Create(Recipe recipe, std::vector<ModelInfo> models,
                                  std::unique_ptr<LeaderSource> leaders) {
  Plan plan(std::move(recipe), std::move(models), std::move(leaders));
  for (const v1::Reaction& reaction : plan.recipe_.reactions) {
    absl::Status status = plan.AddReaction(reaction);
    if (!status.ok()) return status;
  }
  absl::Status status = plan.CheckClasses();
  if (!status.ok()) return status;
  for (const ModelInfo& model : plan.models_) {
    if (plan.recipe_.samples > 1 && !model.samples) {
      return absl::InvalidArgumentError(
          absl::StrCat("samples: expected 1, got ", plan.recipe_.samples, ". ", model.name, "@",
                       model.version, " does not sample: it has one answer for all seeds"));
    }
  }
  return plan;
}

std::vector<std::string> Plan::ClassesOf(const v1::Reaction& reaction) const {
  const auto& classes =
      reaction.has_mixes() ? reaction.mixes().classes() : reaction.each_class().classes();
  if (classes.empty()) return models_.front().interaction_classes;
  return {classes.begin(), classes.end()};
}

absl::Status Plan::AddNamed(const v1::Reaction& reaction, Labels labels) {
  // A single reaction has the name of its entry; several append their labels.
  std::string name = NameOfLabels(labels);
  if (reaction.has_labels() && !reaction.name().empty()) {
    name = reaction.name();
  } else if (!reaction.name().empty()) {
    name = absl::StrCat(reaction.name(), "_", name);
  }
  const auto same_name = [&name](const LabelledReaction& other) { return other.name == name; };
  if (std::any_of(fixed_.begin(), fixed_.end(), same_name)) {
    return absl::InvalidArgumentError(absl::StrCat("reactions: expected different names, got ",
                                                   name, " twice. Set name in each"));
  }
  fixed_.push_back({std::move(name), std::move(labels)});
  return absl::OkStatus();
}

absl::Status Plan::AddDrawn(const v1::Reaction& reaction) {
  const std::vector<std::string> classes = ClassesOf(reaction);
  if (ClassesInMix(reaction.mixes()) > classes.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat("reactions: classes_in_mix: expected at most the ", classes.size(),
                     " classes, got ", ClassesInMix(reaction.mixes())));
  }
  const auto same_name = [&reaction](const v1::Reaction& other) {
    return other.name() == reaction.name();
  };
  if (std::any_of(drawn_.begin(), drawn_.end(), same_name)) {
    return absl::InvalidArgumentError(
        "reactions: expected a name for each of several mixes, got the same name twice");
  }
  drawn_.push_back(reaction);
  return absl::OkStatus();
}

absl::Status Plan::AddReaction(const v1::Reaction& reaction) {
  if (reaction.has_mixes()) return AddDrawn(reaction);
  if (reaction.has_labels()) return AddNamed(reaction, ToLabels(reaction.labels()));
  absl::Status status;
  for (const std::string& name : ClassesOf(reaction)) {
    status.Update(AddNamed(reaction, {{name, 1}}));
  }
  return status;
}

absl::Status Plan::CheckClasses() const {
  std::set<std::string> wanted;
  for (const LabelledReaction& reaction : fixed_) {
    for (const ClassWeight& label : reaction.labels) wanted.insert(label.interaction_class);
  }
  for (const v1::Reaction& reaction : drawn_) {
    const std::vector<std::string> classes = ClassesOf(reaction);
    wanted.insert(classes.begin(), classes.end());
  }
  for (const ModelInfo& model : models_) {
    for (const std::string& name : wanted) {
      if (HasClass(model, name)) continue;
      return absl::InvalidArgumentError(absl::StrCat("reactions: expected a class of ", model.name,
                                                     "@", model.version, ", got ",
                                                     base::Quoted(name)));
    }
  }
  return absl::OkStatus();
}

// An id decides the labels by itself, so that no file is read for them.
std::string Plan::DrawnFrom(const LeaderEntry& leader) {
  if (drawn_.empty() || leader.has_id) return leader.key;
  const absl::StatusOr<std::string> digest = base::Sha256HexOfFile(leader.file);
  return digest.ok() ? absl::StrCat("content ", digest->substr(0, 16)) : leader.key;
}

void Plan::DrawFor(const LeaderEntry& leader) {
  const std::string from = DrawnFrom(leader);
  for (size_t i = 0; i < drawn_.size(); ++i) {
    base::Random random(DrawnNumber(absl::StrCat("mixes ", recipe_.seed, " ", i, " ", from)));
    const std::string& name = drawn_[i].name();
    for (uint32_t mix = 0; mix < drawn_[i].mixes().count(); ++mix) {
      reactions_.push_back({absl::StrCat(name.empty() ? "mix" : name, mix),
                            DrawMix(drawn_[i].mixes(), ClassesOf(drawn_[i]), &random), true});
    }
  }
}

absl::Status Plan::CheckLabels(const LeaderEntry& leader) const {
  for (const ModelInfo& model : models_) {
    for (const ClassWeight& label : leader.labels) {
      if (HasClass(model, label.interaction_class)) continue;
      return absl::InvalidArgumentError(
          absl::StrCat(PlaceOf(leader), ": labels: expected classes of ", model.name, "@",
                       model.version, " (", absl::StrJoin(model.interaction_classes, ", "),
                       "), got ", base::Quoted(label.interaction_class)));
    }
  }
  return absl::OkStatus();
}

absl::Status Plan::BeginLeader(LeaderEntry leader) {
  reactions_ = leader.labels.empty()
                   ? fixed_
                   : std::vector<LabelledReaction>{{NameOfLabels(leader.labels), leader.labels}};
  if (leader.labels.empty()) DrawFor(leader);
  if (reactions_.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        PlaceOf(leader), ": labels: expected some, since the recipe has no reactions, got none"));
  }
  absl::Status status = CheckLabels(leader);
  if (!status.ok()) return status;
  sides_ = {recipe_.input.side == v1::SIDE_RIGHT ? formats::Side::kRight : formats::Side::kLeft};
  if (recipe_.input.side == v1::SIDE_BOTH) sides_ = {formats::Side::kLeft, formats::Side::kRight};
  if (leader.side.has_value()) sides_ = {*leader.side};
  leader_ = std::make_shared<const LeaderEntry>(std::move(leader));
  side_ = reaction_ = model_ = 0;
  sample_ = 0;
  return absl::OkStatus();
}

std::string Plan::NameOf(const Item& item) const {
  std::string name = item.leader->key;
  if (recipe_.input.side == v1::SIDE_BOTH) absl::StrAppend(&name, "-", SideName(item.side));
  absl::StrAppend(&name, "-", item.reaction);
  if (models_.size() > 1) {
    const ModelInfo& model = models_[static_cast<size_t>(item.model)];
    absl::StrAppend(&name, "-", PlainName(model.name), "_", model.version);
  }
  if (recipe_.samples > 1) absl::StrAppend(&name, "-s", item.sample);
  return name;
}

Item Plan::MakeItem() {
  const LabelledReaction& reaction = reactions_[reaction_];
  Item item;
  item.number = number_;
  item.leader = leader_;
  item.side = sides_[side_];
  item.reaction = reaction.name;
  item.labels = reaction.labels;
  item.drawn = reaction.drawn;
  item.model = static_cast<int>(model_);
  item.sample = sample_;
  item.name = NameOf(item);
  SetDigests(recipe_, models_[static_cast<size_t>(item.model)], &item);
  return item;
}

// Moves to the next item of the current leader. Returns false if there is none.
bool Plan::Advance() {
  if (++sample_ < recipe_.samples) return true;
  sample_ = 0;
  if (++model_ < models_.size()) return true;
  model_ = 0;
  if (++reaction_ < reactions_.size()) return true;
  reaction_ = 0;
  return ++side_ < sides_.size();
}

absl::StatusOr<std::optional<Item>> Plan::Next() {
  if (leader_ == nullptr) {
    absl::StatusOr<std::optional<LeaderEntry>> next = leaders_->Next();
    if (!next.ok()) return next.status();
    if (!next->has_value()) return std::optional<Item>();
    absl::Status status = BeginLeader(**std::move(next));
    if (!status.ok()) return status;
  }
  if (number_ == kMaxItems) {
    return absl::FailedPreconditionError(
        absl::StrCat("plan: expected at most ", kMaxItems, " items, got more. Make several sets."));
  }
  Item item = MakeItem();
  absl::Status status = CheckName(item);
  if (!status.ok()) {
    leader_ = nullptr;
    return status;
  }
  ++number_;
  if (!Advance()) leader_ = nullptr;
  return std::optional<Item>(std::move(item));
}

absl::StatusOr<PlanCheck> CheckPlan(const PlanPart& part, Plan* plan,
                                    const std::function<absl::Status(const Item&)>& visit,
                                    const std::function<bool()>& stopped) {
  PlanCheck check;
  absl::flat_hash_set<size_t> files;  // hashes of leaders as listed
  std::shared_ptr<const LeaderEntry> last_leader;
  formats::Side last_side = formats::Side::kLeft;
  while (!stopped()) {
    const absl::StatusOr<std::optional<Item>> next = plan->Next();
    if (absl::IsInvalidArgument(next.status())) {
      if (check.bad_line_count++ >= static_cast<int64_t>(PlanCheck::kListed)) continue;
      check.bad_lines.emplace_back(next.status().message());
      continue;
    }
    if (!next.ok()) return next.status();
    if (!next->has_value()) break;
    const Item& item = **next;
    if (!part.Has(item)) continue;
    ++check.items;
    if (item.leader != last_leader || item.side != last_side) ++check.leaders;
    if (item.leader != last_leader) files.insert(absl::Hash<std::string>()(item.leader->given));
    last_leader = item.leader;
    last_side = item.side;
    if (check.bad_line_count > 0) continue;
    absl::Status status = visit(item);
    if (!status.ok()) return status;
  }
  check.files = static_cast<int64_t>(files.size());
  return check;
}

absl::Status BadLinesError(const PlanCheck& check) {
  if (check.bad_line_count == 0) return absl::OkStatus();
  std::string lines = absl::StrJoin(check.bad_lines, "\n  ");
  const auto more = check.bad_line_count - static_cast<int64_t>(check.bad_lines.size());
  if (more > 0) absl::StrAppend(&lines, "\n  and ", more, " more");
  return absl::InvalidArgumentError(absl::StrCat(base::Counted(check.bad_line_count, "bad line"),
                                                 "; no call was made:\n  ", lines));
}

}  // namespace duet::client::batch
