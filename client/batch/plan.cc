#include "client/batch/plan.h"

#include <algorithm>
#include <set>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/batch/capture_layout.h"
#include "client/batch/drawn_labels.h"
#include "client/batch/file_name.h"
#include "client/batch/journal.h"
#include "client/batch/text_values.h"
#include "model/base/random.h"
#include "model/base/sha256.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

constexpr size_t kIdDigits = 32;

uint64_t DrawnNumber(const std::string& from) {
  uint64_t number = 0;
  // 13 hex digits: 52 bits.
  (void)absl::SimpleHexAtoi(base::Sha256Hex(from).substr(0, 13), &number);
  return number;
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
  for (const TimedLabels& keyframe : item.keyframes) {
    absl::StrAppend(&text, keyframe.at, ":", Text(keyframe.labels), "\n");
  }
  if (leader.follower_start_side) {
    absl::StrAppend(&text, "start side ", SideName(*leader.follower_start_side), "\n");
  }
  if (leader.partner_direction) {
    const motion::Vec3& to = *leader.partner_direction;
    absl::StrAppend(&text, "direction ", to.x, ",", to.y, ",", to.z, "\n");
  }
  for (const JointConstraint& pin : leader.pins) {
    absl::StrAppend(&text, "pin ", PinText(pin), "\n");
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

// All combinations of a grid's weights; the last axis changes fastest.
std::vector<Labels> Combinations(const v1::Grid& grid) {
  std::vector<Labels> all = {{}};
  for (const v1::Grid::Axis& axis : grid.axes()) {
    std::vector<Labels> longer;
    for (const Labels& labels : all) {
      for (const float weight : axis.weights()) {
        longer.push_back(labels);
        longer.back().push_back({axis.interaction_class(), weight});
      }
    }
    all = std::move(longer);
  }
  for (Labels& labels : all) SortByClass(&labels);
  return all;
}

// The prefix of a leader's errors: its line of the manifest, or the leader as listed.
const std::string& PlaceOf(const LeaderEntry& leader) {
  return leader.line.empty() ? leader.given : leader.line;
}

bool Means(const ModelChoice& choice, const ModelInfo& model) {
  return choice.name == model.name && choice.version.value_or(model.version) == model.version &&
         (choice.version_label.empty() ||
          std::count(model.version_labels.begin(), model.version_labels.end(),
                     choice.version_label) > 0);
}

}  // namespace

std::string LargestClass(const Item& item) {
  ClassWeight largest{"none", 0};
  const auto look = [&largest](const Labels& labels) {
    for (const ClassWeight& label : labels) {
      if (label.weight > largest.weight) largest = label;
    }
  };
  look(item.labels);
  for (const TimedLabels& keyframe : item.keyframes) look(keyframe.labels);
  return largest.interaction_class;
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
    const dataset::DatasetLayout* const captures = CapturesOf(plan.recipe_.output.layout());
    if (captures != nullptr) status.Update(CheckJoints(*captures, model));
    status.Update(plan.CheckClassifier(model));
    if (!status.ok()) return status;
    if (plan.recipe_.samples > 1 && !model.samples) {
      return absl::InvalidArgumentError(
          absl::StrCat("samples: expected 1, got ", plan.recipe_.samples, ". ", model.name, "@",
                       model.version, " does not sample: it has one answer for all seeds"));
    }
  }
  return plan;
}

std::vector<std::string> Plan::ClassesOr(const std::vector<std::string>& classes) const {
  return classes.empty() ? models_.front().interaction_classes : classes;
}

absl::Status Plan::AddNamed(const v1::Reaction& reaction, LabelledReaction labelled) {
  // A single reaction has the name of its entry; several append their labels.
  const std::string own = NameOfLabels(labelled.labels);
  const bool single = reaction.has_labels() || reaction.has_schedule();
  labelled.name = reaction.name();
  if (labelled.name.empty()) labelled.name = own.empty() ? "schedule" : own;
  if (!reaction.name().empty() && !single) labelled.name = absl::StrCat(reaction.name(), "_", own);
  const auto same_name = [&labelled](const LabelledReaction& other) {
    return other.name == labelled.name;
  };
  if (std::any_of(fixed_.begin(), fixed_.end(), same_name)) {
    return absl::InvalidArgumentError(absl::StrCat("reactions: expected different names, got ",
                                                   labelled.name, " twice. Set name in each"));
  }
  fixed_.push_back(std::move(labelled));
  return absl::OkStatus();
}

absl::Status Plan::AddDrawn(const v1::Reaction& reaction) {
  const std::vector<std::string> classes = ClassesOr(ClassesOf(reaction));
  absl::Status status = CheckDrawn(reaction, classes);
  if (!status.ok()) return status;
  const auto same_name = [&reaction](const v1::Reaction& other) {
    return other.name() == reaction.name();
  };
  if (std::any_of(drawn_.begin(), drawn_.end(), same_name)) {
    return absl::InvalidArgumentError(
        "reactions: expected a name for each of several drawn reactions, got the same name twice");
  }
  drawn_.push_back(reaction);
  return absl::OkStatus();
}

absl::Status Plan::AddReaction(const v1::Reaction& reaction) {
  if (IsDrawn(reaction)) return AddDrawn(reaction);
  std::vector<LabelledReaction> added;
  if (reaction.has_labels()) added.push_back({"", ToLabels(reaction.labels()), {}});
  if (reaction.has_schedule()) {
    added.emplace_back();
    for (const v1::Schedule::Keyframe& keyframe : reaction.schedule().keyframes()) {
      added.back().keyframes.push_back({keyframe.at(), ToLabels(keyframe.labels())});
    }
  }
  if (reaction.has_grid()) {
    for (Labels& labels : Combinations(reaction.grid())) {
      added.push_back({"", std::move(labels), {}});
    }
  }
  if (reaction.has_each_class()) {
    for (const std::string& name : ClassesOr(ClassesOf(reaction))) {
      added.push_back({"", {{name, RangeOf(reaction.each_class()).min}}, {}});
    }
  }
  for (LabelledReaction& labelled : added) {
    absl::Status status = AddNamed(reaction, std::move(labelled));
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status Plan::CheckClasses() const {
  std::set<std::string> wanted;
  const auto want = [&wanted](const Labels& labels) {
    for (const ClassWeight& label : labels) wanted.insert(label.interaction_class);
  };
  for (const LabelledReaction& reaction : fixed_) {
    want(reaction.labels);
    for (const TimedLabels& keyframe : reaction.keyframes) want(keyframe.labels);
  }
  for (const v1::Reaction& reaction : drawn_) {
    const std::vector<std::string> classes = ClassesOr(ClassesOf(reaction));
    wanted.insert(classes.begin(), classes.end());
  }
  for (const ModelInfo& model : models_) {
    for (const std::string& name : wanted) {
      const auto& known = model.interaction_classes;
      if (std::count(known.begin(), known.end(), name) > 0) continue;
      return absl::InvalidArgumentError(absl::StrCat("reactions: expected a class of ", model.name,
                                                     "@", model.version, ", got ",
                                                     base::Quoted(name)));
    }
  }
  return absl::OkStatus();
}

absl::Status Plan::CheckClassifier(const ModelInfo& model) const {
  if (recipe_.classifier == nullptr) return absl::OkStatus();
  for (const std::string& joint : recipe_.classifier->parts().skeleton.joint_names) {
    const auto& known = model.joint_names;
    if (std::find(known.begin(), known.end(), joint) != known.end()) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("filter.classifier: expected a model with joint ", base::Quoted(joint),
                     ", got ", model.name, "@", model.version, " without it"));
  }
  return absl::OkStatus();
}

// An id decides the labels by itself, so that no file is read for them.
std::string Plan::DrawnFrom(const LeaderEntry& leader) {
  if (drawn_.empty() || leader.has_id) return leader.key;
  const std::string digest = digests_.Of(leader);
  return digest.empty() ? leader.key : absl::StrCat("content ", digest);
}

void Plan::DrawFor(const LeaderEntry& leader) {
  const std::string from = DrawnFrom(leader);
  for (size_t i = 0; i < drawn_.size(); ++i) {
    base::Random random(DrawnNumber(absl::StrCat("mixes ", recipe_.seed, " ", i, " ", from)));
    for (DrawnLabels& one : Draw(drawn_[i], ClassesOr(ClassesOf(drawn_[i])), &random)) {
      reactions_.push_back({std::move(one.name), std::move(one.labels), {}, true});
    }
  }
}

std::string Plan::ModelNames() const {
  return absl::StrJoin(models_, ", ", [](std::string* out, const ModelInfo& model) {
    absl::StrAppend(out, model.name, "@", model.version);
  });
}

absl::Status Plan::CheckForModels(const LeaderEntry& leader) const {
  for (const int index : leader_models_) {
    const ModelInfo& model = models_[static_cast<size_t>(index)];
    const absl::Status pins = CheckPinJoints(leader.pins, model);
    if (!pins.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(PlaceOf(leader), ": ", pins.message()));
    }
    const auto& known = model.interaction_classes;
    for (const ClassWeight& label : leader.labels) {
      if (std::count(known.begin(), known.end(), label.interaction_class) > 0) continue;
      return absl::InvalidArgumentError(absl::StrCat(
          PlaceOf(leader), ": labels: expected classes of ", model.name, "@", model.version, " (",
          absl::StrJoin(known, ", "), "), got ", base::Quoted(label.interaction_class)));
    }
  }
  return absl::OkStatus();
}

// In this order: the manifest, the recipe, an index.tsv, left.
void Plan::SetSides(const LeaderEntry& leader, const dataset::IndexEntry* indexed) {
  const std::optional<Sides>& asked = recipe_.input.side;
  sides_ = {asked == Sides::kRight ? formats::Side::kRight : formats::Side::kLeft};
  if (asked == Sides::kBoth) sides_ = {formats::Side::kLeft, formats::Side::kRight};
  if (leader.side.has_value()) sides_ = {*leader.side};
  if (indexed == nullptr || leader.side.has_value() || asked.has_value()) return;
  const dataset::LeaderSide side = indexed->leader_side;
  ++(side == dataset::LeaderSide::kRight  ? indexed_sides_.right
     : side == dataset::LeaderSide::kLeft ? indexed_sides_.left
                                          : indexed_sides_.unknown);
  if (side == dataset::LeaderSide::kRight) sides_ = {formats::Side::kRight};
}

// Sets what an index.tsv may state about a leader.
absl::Status Plan::UseIndex(LeaderEntry* leader) {
  const absl::StatusOr<const dataset::IndexEntry*> indexed = indexes_.Find(leader->file);
  if (!indexed.ok()) return indexed.status();
  if (*indexed != nullptr && leader->group.empty()) leader->group = (*indexed)->group;
  SetSides(*leader, *indexed);
  return absl::OkStatus();
}

absl::Status Plan::BeginLeader(LeaderEntry leader) {
  reactions_ =
      leader.labels.empty()
          ? fixed_
          : std::vector<LabelledReaction>{{NameOfLabels(leader.labels), leader.labels, {}}};
  if (leader.labels.empty()) DrawFor(leader);
  if (reactions_.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        PlaceOf(leader), ": labels: expected some, since the recipe has no reactions, got none"));
  }
  const absl::Status indexed = UseIndex(&leader);
  if (!indexed.ok()) return indexed;
  leader_models_.clear();
  const absl::StatusOr<ModelChoice> choice =
      leader.model.empty() ? ModelChoice() : ParseModelChoice(leader.model);
  for (size_t i = 0; i < models_.size(); ++i) {
    if (leader.model.empty() || (choice.ok() && Means(*choice, models_[i]))) {
      leader_models_.push_back(static_cast<int>(i));
    }
  }
  if (leader_models_.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(PlaceOf(leader), ": model: expected one of the recipe's (", ModelNames(),
                     "), got ", base::Quoted(leader.model)));
  }
  absl::Status status = CheckForModels(leader);
  if (!status.ok()) return status;
  leader_ = std::make_shared<const LeaderEntry>(std::move(leader));
  side_ = reaction_ = model_ = 0;
  sample_ = 0;
  return absl::OkStatus();
}

absl::StatusOr<std::string> Plan::NameOf(const Item& item) {
  const v1::Layout layout = recipe_.output.layout();
  if (CapturesOf(layout) != nullptr) {
    const absl::StatusOr<std::string> folder =
        CaptureFolder(layout, LargestClass(item), item.leader->given);
    if (folder.ok()) return CaptureName(layout, *folder, ++clips_[*folder]);
    return absl::InvalidArgumentError(absl::StrCat(PlaceOf(*item.leader), ": reaction ",
                                                   item.reaction, ": ", folder.status().message()));
  }
  std::string name = item.leader->key;
  if (recipe_.input.side == Sides::kBoth) absl::StrAppend(&name, "-", SideName(item.side));
  absl::StrAppend(&name, "-", item.reaction);
  if (models_.size() > 1) {
    const ModelInfo& model = models_[static_cast<size_t>(item.model)];
    absl::StrAppend(&name, "-", PlainName(model.name), "_", model.version);
  }
  if (recipe_.samples > 1) absl::StrAppend(&name, "-s", item.sample);
  if (layout == v1::LAYOUT_MIRROR) return name;
  return absl::StrCat(PlainName(LargestClass(item)), "/", name);
}

absl::StatusOr<Item> Plan::MakeItem() {
  const LabelledReaction& reaction = reactions_[reaction_];
  Item item;
  item.number = number_;
  item.leader = leader_;
  item.side = sides_[side_];
  item.reaction = reaction.name;
  item.labels = reaction.labels;
  item.keyframes = reaction.keyframes;
  item.drawn = reaction.drawn;
  item.model = leader_models_[model_];
  item.sample = sample_;
  absl::StatusOr<std::string> name = NameOf(item);
  if (!name.ok()) return name.status();
  item.name = FitFileName(*name);
  if (item.name != *name) item.full_name = *std::move(name);
  SetDigests(recipe_, models_[static_cast<size_t>(item.model)], &item);
  return item;
}

// Moves to the next item of the current leader. Returns false if there is none.
bool Plan::Advance() {
  if (++sample_ < recipe_.samples) return true;
  sample_ = 0;
  if (++model_ < leader_models_.size()) return true;
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
  absl::StatusOr<Item> item = MakeItem();
  if (!item.ok()) {
    leader_ = nullptr;
    return item.status();
  }
  ++number_;
  if (!Advance()) leader_ = nullptr;
  return std::optional<Item>(*std::move(item));
}

}  // namespace duet::client::batch
