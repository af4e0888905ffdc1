#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/angle.h"
#include "model/base/random.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/body/grade.h"
#include "model/evaluation/program/experiment.h"
#include "model/motion/filter.h"

namespace duet::evaluation::program {
namespace {

using motion::Poses;
using motion::Vec3;

// Leaning back is measured against this many first frames.
constexpr size_t kUprightFrames = 3;
// A trunk that is shorter than this, seen from the front, has no lean.
constexpr double kLeastTrunkMetres = 0.05;

// The horizontal direction, of length 1, from leader to follower in a capture's first frame.
Vec3 AwayFromLeader(const dataset::Sequence& sequence, int root) {
  Vec3 away = sequence.pair.follower.at(0, root) - sequence.pair.leader.at(0, root);
  away.y = 0;
  const float length = Norm(away);
  return length > 0 ? away / length : Vec3{1, 0, 0};
}

double Largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}
double Smallest(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

// The largest rise of a series after any earlier value.
double LargestRise(const std::vector<double>& values) {
  double lowest = values.front(), rise = 0;
  for (const double value : values) {
    lowest = std::min(lowest, value);
    rise = std::max(rise, value - lowest);
  }
  return rise;
}

// What changes over a clip, a value a frame. Metres; lean in degrees, backwards positive.
struct Series {
  std::vector<double> apart, hands_around, hand_around, hands_meet;  // distances from the leader
  std::vector<double> more_reach, less_reach,
      uneven_reach;                      // of hands to the leader, past the root
  std::vector<double> head, root, hips;  // away from the leader
  std::vector<double> lean, raised_hand;
};

// The mean lean of the first frames.
double Upright(const std::vector<double>& lean) {
  const auto count = static_cast<std::ptrdiff_t>(std::min(kUprightFrames, lean.size()));
  return base::Mean({lean.begin(), lean.begin() + count});
}

struct MeetingFeature {
  const char* name;
  double (*of)(const Series& series);
};

constexpr MeetingFeature kMeetingFeatures[] = {
    {"near", [](auto& s) { return -Smallest(s.apart); }},
    {"hands around", [](auto& s) { return -Smallest(s.hands_around); }},
    {"a hand around", [](auto& s) { return -Smallest(s.hand_around); }},
    {"hands meet", [](auto& s) { return -Smallest(s.hands_meet); }},
    {"one hand out", [](auto& s) { return Largest(s.uneven_reach); }},
    {"hand out", [](auto& s) { return Largest(s.more_reach); }},
    {"hands out", [](auto& s) { return Largest(s.less_reach); }},
    {"head recoils", [](auto& s) { return LargestRise(s.head); }},
    {"root recoils", [](auto& s) { return LargestRise(s.root); }},
    {"hips recoil", [](auto& s) { return LargestRise(s.hips); }},
    {"head retreats", [](auto& s) { return Largest(s.head) - s.head.front(); }},
    {"root retreats", [](auto& s) { return Largest(s.root) - s.root.front(); }},
    {"root approaches", [](auto& s) { return s.root.front() - Smallest(s.root); }},
    {"leans back", [](auto& s) { return Largest(s.lean) - Upright(s.lean); }},
    {"leans forward", [](auto& s) { return -Smallest(s.lean); }},
    {"hand raised", [](auto& s) { return Largest(s.raised_hand); }}};

// A feature counts for a model whose single answers differ by at least this share of the captures'
// difference; below it, what a mix keeps is a ratio of noise.
constexpr double kLeastDifference = 0.3;
// What a mix keeps of one feature is limited to this range: no single feature decides the mean.
constexpr double kLeastKept = -0.5, kMostKept = 1.5;

double IsLikeliest(const std::vector<float>& of, int label) {
  return std::max_element(of.begin(), of.end()) - of.begin() == label ? 1 : 0;
}

// By how much single answers to the class of lower index exceed those to the other one, mean over
// all answers to the pair. Shapes: by pair, [features].
std::map<std::pair<int, int>, std::vector<double>> SingleDifferences(
    const std::vector<MixedAnswer>& answers) {
  std::map<std::pair<int, int>, std::vector<std::vector<double>>> by_pair;
  for (const MixedAnswer& answer : answers) {
    std::vector<double>& row = by_pair[std::minmax(answer.own, answer.other)].emplace_back();
    const double sign = answer.own < answer.other ? 1 : -1;
    for (size_t f = 0; f < answer.mixed.size(); ++f) {
      row.push_back(sign * (answer.own_alone[f] - answer.other_alone[f]));
    }
  }
  std::map<std::pair<int, int>, std::vector<double>> means;
  for (const auto& [pair, rows] : by_pair) means[pair] = report::ColumnMeans(rows);
  return means;
}

// What remains of one class's own geometry.
double KeptOf(const MixedAnswer& answer, bool is_own, const ClassGeometry& captured,
              const std::vector<double>& single) {
  const int kept = is_own ? answer.own : answer.other, lost = is_own ? answer.other : answer.own;
  const std::vector<double>& without = is_own ? answer.other_alone : answer.own_alone;
  std::vector<double> shares;
  for (size_t f = 0; f < single.size(); ++f) {
    const double expected = captured.Own(kept, lost, f);
    const double difference = kept < lost ? single[f] : -single[f];
    if (expected == 0 || difference < kLeastDifference * expected) continue;
    shares.push_back(
        std::clamp((answer.mixed[f] - without[f]) / difference, kLeastKept, kMostKept));
  }
  return base::Mean(shares);
}

struct MixFigure {
  const char* name;
  double (*of)(const MixedAnswer& answer, const Kept& kept);
};

constexpr MixFigure kMixFigures[] = {
    {"weaker ingredient", [](auto&, const Kept& kept) { return kept.weaker(); }},
    {"both above half", [](auto&, const Kept& kept) { return kept.both(); }},
    {"own ingredient", [](auto&, const Kept& kept) { return kept.own; }},
    {"other ingredient", [](auto&, const Kept& kept) { return kept.other; }},
    {"third class",
     [](auto& a, auto&) {
       return 1 - IsLikeliest(a.probabilities, a.own) - IsLikeliest(a.probabilities, a.other);
     }},
    {"deviation from average", [](auto& a, auto&) { return a.deviation; }},
    {"twisted", [](auto& a, auto&) { return a.grade.twisted; }},
    {"overlap", [](auto& a, auto&) { return a.grade.overlapping; }},
    {"skate", [](auto& a, auto&) { return a.grade.skating; }}};

struct MixesFlags : ExperimentFlags {
  int leaders = 0;  // of each class in a fold; 0: all
};

// What judges mixes of a data set. Shapes: [folds].
struct Meters {
  std::vector<ClassGeometry> classes;  // of the training captures
  std::vector<judge::MotionClassifier> judges;
};

absl::StatusOr<Meters> OpenMeters(const Experiment& experiment) {
  const dataset::Dataset& dataset = experiment.dataset;
  if (!CanMeasureMeeting(dataset.skeleton) ||
      !body::PairMeter::CanMeasure(dataset.skeleton, body::FindBody(dataset.skeleton))) {
    return absl::InvalidArgumentError(
        "--data: expected a skeleton with hips, feet, a chest, a head and two named arms");
  }
  Meters meters;
  for (const Fold& fold : experiment.folds) {
    meters.classes.push_back(MeasureClasses(dataset, fold.split.train));
  }
  DUET_TRY(meters.judges, TrainJudges(dataset, experiment.folds));
  return meters;
}

body::Grade GradeOf(const motion::Skeleton& skeleton, const motion::Clip& leader,
                    const Poses& follower) {
  const body::Body body = body::FindBody(skeleton);
  body::PairMeter meter(skeleton, body, leader.frame_rate_hz);
  body::GradeSum sum;
  for (int t = 0; t < follower.frame_count(); ++t) sum.Add(meter.Add(leader.poses[t], follower[t]));
  return sum.Get();
}

// Answers a leader in its own class, in two mixes with another one, and in that one.
absl::Status MixWith(const dataset::Dataset& dataset, const Meters& meters, int fold,
                     const engine::Synthesizer& model, const Asked& asked, int leader, int other,
                     int sample, std::vector<MixVariant>* mixes) {
  const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(leader)];
  const int own = sequence.interaction_class;
  std::vector<LabelledLeader> leaders;
  for (const auto& [own_weight, other_weight] :
       {std::pair(1.0f, 0.0f), {0.5f, 0.5f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
    std::vector<float> weights(dataset.classes.size());
    weights[static_cast<size_t>(own)] = own_weight;
    weights[static_cast<size_t>(other)] = other_weight;
    leaders.push_back({&sequence, std::move(weights), SeedOf(asked, dataset, leader, sample)});
  }
  DUET_TRY(const std::vector<Poses> answers, SynthesizeSequences(model, leaders, asked));
  std::vector<metrics::ScoredMotion> motions;
  for (const Poses& answer : answers) motions.push_back({leader, answer});
  const auto judged = meters.judges[static_cast<size_t>(fold)].Judge(dataset, motions);
  const Poses &own_alone = answers[0], &other_alone = answers[3];
  for (size_t v = 0; v < mixes->size(); ++v) {
    MixedAnswer answer{leader, fold, own, other};
    answer.mixed = MeasureMeeting(dataset.skeleton, sequence, answers[v]);
    answer.own_alone = MeasureMeeting(dataset.skeleton, sequence, own_alone);
    answer.other_alone = MeasureMeeting(dataset.skeleton, sequence, other_alone);
    answer.probabilities = judged.probabilities[v];
    answer.deviation = Deviation(answers[v], own_alone, other_alone);
    answer.grade = GradeOf(dataset.skeleton, sequence.pair.leader, answers[v]);
    (*mixes)[v].second.push_back(std::move(answer));
  }
  return absl::OkStatus();
}

// At most `most` (0: all) sequences of each class, evenly spread over those of a fold.
std::vector<int> ChooseLeaders(const dataset::Dataset& dataset, const std::vector<int>& sequences,
                               int most) {
  std::map<int, std::vector<int>> by_class;
  for (const int index : sequences) {
    by_class[dataset.sequences[static_cast<size_t>(index)].interaction_class].push_back(index);
  }
  std::vector<int> chosen;
  for (const auto& [c, of_class] : by_class) {
    const size_t count =
        most == 0 ? of_class.size() : std::min(of_class.size(), static_cast<size_t>(most));
    for (size_t i = 0; i < count; ++i) chosen.push_back(of_class[i * of_class.size() / count]);
  }
  return chosen;
}

// The tables of one model with one start.
absl::Status AddTables(const Experiment& experiment, const MixesFlags& flags, const Meters& meters,
                       const FoldModel& model, report::Section* section) {
  const dataset::Dataset& dataset = experiment.dataset;
  const std::string& name = model.name;
  const Asked& asked = model.asked;
  std::vector<MixVariant> mixes = {{"one label", {}}, {"0.5 / 0.5", {}}, {"1 / 1", {}}};
  SharedSynthesizer synthesizer;
  for (size_t f = 0; f < experiment.folds.size(); ++f) {
    const Fold& fold = experiment.folds[f];
    DUET_TRY(synthesizer, model.load(fold.subject));
    DUET_RETURN_IF_ERROR(CheckModelTakes(synthesizer->description(), dataset, asked.start));
    const std::vector<int> leaders = ChooseLeaders(dataset, fold.split.test, flags.leaders);
    const int samples = synthesizer->description().samples ? asked.samples : 1;
    for (int n = 0; n < samples; ++n) {
      for (const int leader : leaders) {
        const int own = dataset.sequences[static_cast<size_t>(leader)].interaction_class;
        for (int other = 0; other < dataset.class_count(); ++other) {
          if (other == own) continue;
          DUET_RETURN_IF_ERROR(MixWith(dataset, meters, static_cast<int>(f), *synthesizer, asked,
                                       leader, other, n, &mixes));
        }
      }
    }
    std::cerr << absl::StrCat(name, " without ", fold.subject, ": ", leaders.size(), " leaders\n");
  }
  const engine::ModelDescription& description = synthesizer->description();
  std::vector<MixVariant> two_kinds = mixes;
  for (auto& [variant, answers] : two_kinds) {
    const auto one_kind = [&](const MixedAnswer& answer) {
      return description.IsContact(answer.own) == description.IsContact(answer.other);
    };
    answers.erase(std::remove_if(answers.begin(), answers.end(), one_kind), answers.end());
  }
  section->tables.insert(
      section->tables.end(),
      {MixTable(name + ": mixes", meters.classes, mixes),
       MixTable(name + ": mixes of contact with other classes", meters.classes, two_kinds)});
  return absl::OkStatus();
}

absl::StatusOr<report::Section> RunMixes(const MixesFlags& flags) {
  DUET_TRY(const Experiment experiment, OpenExperiment(flags));
  DUET_TRY(const Meters meters, OpenMeters(experiment));
  report::Section section = BeginExperiment(
      flags, experiment,
      "The leaders of every left-out subject, answered in mixes of their own class with each other "
      "class. All answers to one leader have one seed; every leader has its own. +pose: the input "
      "includes the follower's first pose.");
  for (const FoldModel& model : experiment.models) {
    DUET_RETURN_IF_ERROR(AddTables(experiment, flags, meters, model, &section));
  }
  return section;
}

}  // namespace

bool CanMeasureMeeting(const motion::Skeleton& skeleton) {
  const body::Body body = body::FindBody(skeleton);
  return skeleton.hips && body.chest && body.neck && body.arms.size() == 2;
}

std::vector<std::string> MeetingFeatures() {
  std::vector<std::string> names;
  for (const MeetingFeature& feature : kMeetingFeatures) names.emplace_back(feature.name);
  return names;
}

std::vector<double> MeasureMeeting(const motion::Skeleton& skeleton,
                                   const dataset::Sequence& sequence, const Poses& follower) {
  const body::Body body = body::FindBody(skeleton);
  const Vec3 away = AwayFromLeader(sequence, skeleton.root);
  const double rate = sequence.pair.leader.frame_rate_hz;
  const Poses leader = motion::WithoutNoise(sequence.pair.leader.poses, rate);
  const Poses poses = motion::WithoutNoise(follower, rate);
  Series series;
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 root = poses.at(t, skeleton.root), chest = poses.at(t, *body.chest);
    const Vec3 spine = Lerp(leader.at(t, *body.chest), leader.at(t, skeleton.root), 0.5f);
    const Vec3 between = root - leader.at(t, skeleton.root);
    series.apart.push_back(std::hypot(double{between.x}, double{between.z}));
    std::vector<double> around, reach, raised;
    double meet = std::numeric_limits<double>::infinity();
    for (const body::Limb& arm : body.arms) {
      const Vec3 hand = poses.at(t, arm.end);
      around.push_back(Distance(hand, spine));
      reach.push_back(Dot(root - hand, away));
      raised.push_back(hand.y - chest.y);
      for (const body::Limb& held : body.arms) {
        meet = std::min(meet, double{Distance(hand, leader.at(t, held.end))});
      }
    }
    series.hands_around.push_back(base::Mean(around));
    series.hand_around.push_back(Largest(around));
    series.hands_meet.push_back(meet);
    series.more_reach.push_back(Largest(reach));
    series.less_reach.push_back(Smallest(reach));
    series.uneven_reach.push_back(Largest(reach) - Smallest(reach));
    series.raised_hand.push_back(Largest(raised));
    const Vec3 hips =
        Lerp(poses.at(t, skeleton.hips->left), poses.at(t, skeleton.hips->right), 0.5f);
    series.head.push_back(Dot(poses.at(t, body.neck->head), away));
    series.root.push_back(Dot(root, away));
    series.hips.push_back(Dot(hips, away));
    series.lean.push_back(base::kDegreesPerRadian *
                          std::atan2(double{Dot(chest - root, away)},
                                     std::max(kLeastTrunkMetres, double{chest.y - root.y})));
  }
  std::vector<double> features;
  for (const MeetingFeature& feature : kMeetingFeatures) features.push_back(feature.of(series));
  return features;
}

double ClassGeometry::Own(int of_class, int other, size_t feature) const {
  const auto a = static_cast<size_t>(of_class), b = static_cast<size_t>(other);
  const double difference = means[a][feature] - means[b][feature];
  const double spread =
      std::sqrt((std::pow(deviations[a][feature], 2) + std::pow(deviations[b][feature], 2)) / 2);
  return difference > spread ? difference : 0;
}

ClassGeometry MeasureClasses(const dataset::Dataset& dataset, const std::vector<int>& sequences) {
  // Shapes: [classes][sequences of the class][features].
  std::vector<std::vector<std::vector<double>>> values(dataset.classes.size());
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    values[static_cast<size_t>(sequence.interaction_class)].push_back(
        MeasureMeeting(dataset.skeleton, sequence, sequence.pair.follower.poses));
  }
  ClassGeometry classes;
  for (const auto& of_class : values) {
    classes.means.push_back(report::ColumnMeans(of_class));
    classes.deviations.push_back(report::ColumnDeviations(of_class));
  }
  return classes;
}

double Deviation(const Poses& mixed, const Poses& own, const Poses& other) {
  double from_average = 0, apart = 0;
  for (size_t i = 0; i < mixed.all().size(); ++i) {
    const Vec3 between = own.all()[i] - other.all()[i];
    const Vec3 away = mixed.all()[i] - Lerp(own.all()[i], other.all()[i], 0.5f);
    from_average += double{Dot(away, away)};
    apart += double{Dot(between, between)};
  }
  return apart == 0 ? NAN : std::sqrt(from_average) / (std::sqrt(apart) / 2);
}

std::vector<Kept> MeasureKept(const std::vector<MixedAnswer>& answers,
                              const std::vector<ClassGeometry>& folds) {
  const auto differences = SingleDifferences(answers);
  std::vector<Kept> all;
  for (const MixedAnswer& answer : answers) {
    const std::vector<double>& single = differences.at(std::minmax(answer.own, answer.other));
    const ClassGeometry& captured = folds[static_cast<size_t>(answer.fold)];
    all.push_back(
        {KeptOf(answer, true, captured, single), KeptOf(answer, false, captured, single)});
  }
  return all;
}

report::Table MixTable(const std::string& title, const std::vector<ClassGeometry>& folds,
                       const std::vector<MixVariant>& variants) {
  report::Table table{title};
  table.decimals = 3;
  for (const MixFigure& figure : kMixFigures) table.rows.push_back({figure.name, {}});
  for (const auto& [name, answers] : variants) {
    table.columns.insert(table.columns.end(), {name, "low", "high"});
    const std::vector<Kept> kept = MeasureKept(answers, folds);
    std::vector<int> leaders;
    for (const MixedAnswer& answer : answers) leaders.push_back(answer.leader);
    for (size_t f = 0; f < table.rows.size(); ++f) {
      std::vector<double> values;
      for (size_t i = 0; i < answers.size(); ++i) {
        values.push_back(kMixFigures[f].of(answers[i], kept[i]));
      }
      const Estimate estimate = EstimateMean(leaders, values);
      table.rows[f].values.insert(table.rows[f].values.end(),
                                  {estimate.mean, estimate.low, estimate.high});
    }
  }
  table.notes = {
      "Ingredients: how much of each class's own geometry the answer keeps, between the same "
      "leader's answer to the other class alone (0) and to this class alone (1). A class's own "
      "geometry: the features that are larger in its training captures than in the other class's, "
      "by more than their spread. Pairs in which a class has none do not count.",
      "Third class: share that the judge assigns to neither class. Deviation from average: 0 for "
      "the average of the two single answers, 1 for one of them. Twisted, overlap, skate: shares "
      "of frames. One label: the own class alone.",
      "Low, high: 95 % interval by the bootstrap over leaders."};
  return table;
}

Estimate EstimateMean(const std::vector<int>& leaders, const std::vector<double>& values) {
  constexpr int kResamples = 400;
  std::map<int, std::vector<double>> by_leader;
  for (size_t i = 0; i < leaders.size(); ++i) by_leader[leaders[i]].push_back(values[i]);
  std::vector<const std::vector<double>*> groups;
  for (const auto& [leader, of_leader] : by_leader) groups.push_back(&of_leader);
  base::Random random(0);
  std::vector<double> means;
  for (int n = 0; n < kResamples && !groups.empty(); ++n) {
    std::vector<double> drawn;
    for (size_t i = 0; i < groups.size(); ++i) {
      const auto pick = static_cast<size_t>(random.Below(static_cast<int64_t>(groups.size())));
      drawn.insert(drawn.end(), groups[pick]->begin(), groups[pick]->end());
    }
    const double mean = base::Mean(drawn);
    if (!std::isnan(mean)) means.push_back(mean);
  }
  return {base::Mean(values), base::Quantile(means, 0.025), base::Quantile(means, 0.975)};
}

Measure AddMixesCommand(CLI::App* command) {
  const auto flags = std::make_shared<MixesFlags>();
  AddAnswersFlags(flags.get(), command);
  AddNumber("--leaders", &flags->leaders, 0, 1000,
            "leaders of each class in a fold; 0: all of the left-out subject", command);
  return [flags] { return RunMixes(*flags); };
}

}  // namespace duet::evaluation::program
