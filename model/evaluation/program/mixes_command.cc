#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/angle.h"
#include "model/base/random.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/body/grade.h"
#include "model/body/posture.h"
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

// A table with a figure and both ends of its interval for each variant.
report::Table EstimateTable(const std::string& title, const std::vector<std::string>& variants) {
  report::Table table{title};
  for (const std::string& variant : variants) {
    table.columns.insert(table.columns.end(), {variant, "low", "high"});
  }
  table.decimals = 3;
  return table;
}

// NaN for a denominator of 0.
double Ratio(double numerator, double denominator) {
  return denominator == 0 ? NAN : numerator / denominator;
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
  std::vector<double> more_reach, less_reach;  // of the hands towards the leader, past the root
  std::vector<double> head, root, hips;        // away from the leader
  std::vector<double> lean, raised_hand;
};

// A feature counts for a model whose single answers differ by at least this share of the captures'
// difference; below it, what a mix keeps is a ratio of noise.
constexpr double kLeastDifference = 0.3;
// What a mix keeps of one feature is limited to this range: no single feature decides the mean.
constexpr double kLeastKept = -0.5, kMostKept = 1.5;

int Likeliest(const std::vector<float>& probabilities) {
  return static_cast<int>(std::max_element(probabilities.begin(), probabilities.end()) -
                          probabilities.begin());
}

double DistanceOf(const motion::Poses& a, const motion::Poses& b) {
  double sum = 0;
  for (size_t i = 0; i < a.all().size(); ++i) {
    const motion::Vec3 apart = a.all()[i] - b.all()[i];
    sum += double{Dot(apart, apart)};
  }
  return std::sqrt(sum);
}

// By how much single answers to the class of lower index exceed those to the other one, mean over
// all answers to the pair. Shapes: by pair, [features].
std::map<std::pair<int, int>, std::vector<double>> SingleDifferences(
    const std::vector<MixedAnswer>& answers) {
  std::map<std::pair<int, int>, std::vector<double>> sums;
  std::map<std::pair<int, int>, int> counts;
  for (const MixedAnswer& answer : answers) {
    const std::pair<int, int> pair = std::minmax(answer.own, answer.other);
    const double sign = answer.own < answer.other ? 1 : -1;
    std::vector<double>& sum = sums[pair];
    sum.resize(answer.mixed.size());
    for (size_t f = 0; f < sum.size(); ++f) {
      sum[f] += sign * (answer.own_alone[f] - answer.other_alone[f]);
    }
    ++counts[pair];
  }
  for (auto& [pair, sum] : sums) {
    for (double& value : sum) value /= counts[pair];
  }
  return sums;
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

// A figure of one answer.
template <typename Answer>
using Figure = std::function<double(const Answer& answer)>;

// The mean of a figure of some answers, which may be repeated.
template <typename Answer>
double MeanOver(const std::vector<Answer>& answers, const std::vector<size_t>& rows,
                const Figure<Answer>& figure) {
  std::vector<double> values;
  for (const size_t row : rows) values.push_back(figure(answers[row]));
  return base::Mean(values);
}

template <typename Answer>
std::vector<int> LeadersOf(const std::vector<Answer>& answers) {
  std::vector<int> leaders;
  for (const Answer& answer : answers) leaders.push_back(answer.leader);
  return leaders;
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
     [](const MixedAnswer& answer, auto&) {
       const int likeliest = Likeliest(answer.probabilities);
       return likeliest != answer.own && likeliest != answer.other ? 1.0 : 0.0;
     }},
    {"deviation from average", [](auto& a, auto&) { return a.deviation; }},
    {"twisted", [](auto& a, auto&) { return a.grade.twisted; }},
    {"overlap", [](auto& a, auto&) { return a.grade.overlapping; }},
    {"skate", [](auto& a, auto&) { return a.grade.skating; }}};

constexpr double kPaddingSeconds = 1;
// The time about the leader's action in which a follower goes back.
constexpr double kBeforeActionSeconds = 0.3, kAfterActionSeconds = 1;
// A series with a smaller deviation has no correlation with another.
constexpr double kConstant = 1e-9;

// Pearson's correlation; 0 if either side is constant. Shapes: both [samples].
double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = base::Mean(a), mean_b = base::Mean(b);
  double product = 0, square_a = 0, square_b = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    product += (a[i] - mean_a) * (b[i] - mean_b);
    square_a += std::pow(a[i] - mean_a, 2);
    square_b += std::pow(b[i] - mean_b, 2);
  }
  const double scale = std::sqrt(square_a * square_b);
  return scale > kConstant ? product / scale : 0;
}

std::vector<double> Positions(const Poses& poses, int joint, Vec3 away) {
  std::vector<double> along;
  for (int t = 0; t < poses.frame_count(); ++t) along.push_back(Dot(poses.at(t, joint), away));
  return along;
}

// The change of the head's and the root's mean position away from the leader in every frame.
std::vector<double> VelocityAway(const Poses& poses, int head, int root, Vec3 away) {
  const std::vector<double> heads = Positions(poses, head, away);
  const std::vector<double> roots = Positions(poses, root, away);
  std::vector<double> velocity(heads.size());
  for (size_t t = 1; t < velocity.size(); ++t) {
    velocity[t] = (heads[t] + roots[t] - heads[t - 1] - roots[t - 1]) / 2;
  }
  return velocity;
}

// The frame in which a hand or foot of the leader reaches farthest towards the follower.
int ActionFrame(const motion::Skeleton& skeleton, const body::Body& body, const Poses& leader,
                Vec3 away) {
  int frame = 0;
  float farthest = -INFINITY;
  for (int t = 0; t < leader.frame_count(); ++t) {
    for (const auto* limbs : {&body.arms, &body.legs}) {
      for (const body::Limb& limb : *limbs) {
        const float reach = Dot(leader.at(t, limb.end) - leader.at(t, skeleton.root), away);
        if (reach <= farthest) continue;
        farthest = reach;
        frame = t;
      }
    }
  }
  return frame;
}

// Repeats the first and last frames.
void Pad(int frames, motion::Clip* clip) {
  Poses padded(0, clip->joint_count());
  for (int t = 0; t < frames; ++t) padded.Append(clip->poses[0]);
  padded.Append(clip->poses.all());
  for (int t = 0; t < frames; ++t) padded.Append(clip->poses[clip->frame_count() - 1]);
  clip->poses = std::move(padded);
}

struct MixesFlags : ExperimentFlags {
  std::vector<std::string> reaction_classes;  // empty: all
  int leaders = 0;                            // of each class in a fold; 0: all
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

struct Measured {
  std::vector<MixVariant> mixes = {{"one label", {}}, {"0.5 / 0.5", {}}, {"1 / 1", {}}};
  std::vector<AvoidingAnswer> avoiding;
  std::vector<ReactionPair> reactions;
};

// Answers a leader in its own class, in another one, in two mixes of both, and in its own class
// with the other one at -1.
absl::Status MixWith(const dataset::Dataset& dataset, const Meters& meters, int fold,
                     const engine::Synthesizer& model, const Asked& asked, int leader, int other,
                     int sample, Measured* measured) {
  const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(leader)];
  const int own = sequence.interaction_class;
  std::vector<LabelledLeader> leaders;
  for (const auto& [own_weight, other_weight] :
       {std::pair(1.0f, 0.0f), {0.5f, 0.5f}, {1.0f, 1.0f}, {0.0f, 1.0f}, {1.0f, -1.0f}}) {
    std::vector<float> weights(dataset.classes.size());
    weights[static_cast<size_t>(own)] = own_weight;
    weights[static_cast<size_t>(other)] = other_weight;
    leaders.push_back({&sequence, std::move(weights), SeedOf(asked, dataset, leader, sample)});
  }
  DUET_TRY(const std::vector<Poses> answers, SynthesizeSequences(model, leaders, asked));
  std::vector<metrics::ScoredMotion> motions;
  for (const Poses& answer : answers) motions.push_back({leader, answer});
  const auto judged = meters.judges[static_cast<size_t>(fold)].Judge(dataset, motions);
  const Poses &own_alone = answers[0], &other_alone = answers[3], &avoiding = answers[4];
  for (size_t v = 0; v < measured->mixes.size(); ++v) {
    MixedAnswer answer{leader, fold, own, other};
    answer.mixed = MeasureMeeting(dataset.skeleton, sequence, answers[v]);
    answer.own_alone = MeasureMeeting(dataset.skeleton, sequence, own_alone);
    answer.other_alone = MeasureMeeting(dataset.skeleton, sequence, other_alone);
    answer.probabilities = judged.probabilities[v];
    answer.deviation = Deviation(answers[v], own_alone, other_alone);
    answer.grade = GradeOf(dataset.skeleton, sequence.pair.leader, answers[v]);
    measured->mixes[v].second.push_back(std::move(answer));
  }
  const auto distance = [&](const Poses& follower) {
    return body::RootDistance(sequence.pair.leader.poses, follower, dataset.skeleton);
  };
  measured->avoiding.push_back({leader, own, other, judged.probabilities[0],
                                judged.probabilities[4], distance(avoiding) - distance(own_alone)});
  return absl::OkStatus();
}

// Answers leaders in their own classes, as captured and padded.
absl::Status React(const dataset::Dataset& dataset, const engine::Synthesizer& model,
                   const Asked& asked, const std::vector<int>& leaders, int sample,
                   std::vector<ReactionPair>* reactions) {
  std::vector<dataset::Sequence> sequences;  // each as captured, then padded
  std::vector<int> padding;
  for (const int leader : leaders) {
    const dataset::Sequence& captured = dataset.sequences[static_cast<size_t>(leader)];
    sequences.insert(sequences.end(), 2, captured);
    padding.push_back(PadSequence(&sequences.back()));
  }
  std::vector<LabelledLeader> labelled;
  for (size_t i = 0; i < sequences.size(); ++i) {
    labelled.push_back({&sequences[i],
                        OneClass(dataset.class_count(), sequences[i].interaction_class),
                        SeedOf(asked, dataset, leaders[i / 2], sample)});
  }
  DUET_TRY(const std::vector<Poses> answers, SynthesizeSequences(model, labelled, asked));
  for (size_t i = 0; i < leaders.size(); ++i) {
    const dataset::Sequence& sequence = sequences[2 * i];
    const auto measure = [&](const Poses& follower) {
      return MeasureReaction(dataset.skeleton, sequence, follower);
    };
    Poses padded = answers[2 * i + 1];
    padded.DropFront(padding[i]);
    padded.Resize(sequence.pair.leader.frame_count());
    reactions->push_back({leaders[i], sequence.interaction_class,
                          measure(sequence.pair.follower.poses), measure(answers[2 * i]),
                          measure(padded)});
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
  Measured measured;
  std::vector<bool> contact;  // of each class
  for (size_t f = 0; f < experiment.folds.size(); ++f) {
    const Fold& fold = experiment.folds[f];
    DUET_TRY(const SharedSynthesizer synthesizer, model.load(fold.subject));
    DUET_RETURN_IF_ERROR(CheckModelTakes(synthesizer->description(), dataset, asked.start));
    const std::vector<int> leaders = ChooseLeaders(dataset, fold.split.test, flags.leaders);
    const int samples = synthesizer->description().samples ? asked.samples : 1;
    contact.clear();
    for (int c = 0; c < dataset.class_count(); ++c) {
      contact.push_back(synthesizer->description().IsContact(c));
    }
    std::vector<int> reacting;
    for (const int leader : leaders) {
      const std::string& of_leader =
          dataset.classes[static_cast<size_t>(metrics::ClassesOf(dataset, {leader})[0])];
      const auto& some = flags.reaction_classes;
      if (some.empty() || std::count(some.begin(), some.end(), of_leader) > 0) {
        reacting.push_back(leader);
      }
    }
    for (int n = 0; n < samples; ++n) {
      for (const int leader : leaders) {
        const int own = dataset.sequences[static_cast<size_t>(leader)].interaction_class;
        for (int other = 0; other < dataset.class_count(); ++other) {
          if (other == own) continue;
          DUET_RETURN_IF_ERROR(MixWith(dataset, meters, static_cast<int>(f), *synthesizer, asked,
                                       leader, other, n, &measured));
        }
      }
      DUET_RETURN_IF_ERROR(React(dataset, *synthesizer, asked, reacting, n, &measured.reactions));
    }
    std::cerr << absl::StrCat(name, " without ", fold.subject, ": ", leaders.size(), " leaders\n");
  }
  std::vector<MixVariant> two_kinds = measured.mixes;
  for (auto& [variant, answers] : two_kinds) {
    const auto one_kind = [&](const MixedAnswer& answer) {
      return contact[static_cast<size_t>(answer.own)] == contact[static_cast<size_t>(answer.other)];
    };
    answers.erase(std::remove_if(answers.begin(), answers.end(), one_kind), answers.end());
  }
  section->tables.insert(
      section->tables.end(),
      {MixTable(name + ": mixes", meters.classes, measured.mixes),
       MixTable(name + ": mixes of contact with other classes", meters.classes, two_kinds),
       AvoidTable(name + ": negatives", measured.avoiding),
       ReactionTable(name + ": reaction", measured.reactions)});
  return absl::OkStatus();
}

absl::StatusOr<report::Section> RunMixes(const MixesFlags& flags) {
  DUET_TRY(const Experiment experiment, OpenExperiment(flags));
  DUET_TRY(const Meters meters, OpenMeters(experiment));
  report::Section section = BeginExperiment(
      flags, experiment,
      "The leaders of every left-out subject, answered in mixes of their own class with each other "
      "class, with each other class at -1, and in their own class with the leader held still "
      "before and after the clip. All answers to one leader have one seed; every leader has its "
      "own. +pose: the input includes the follower's first pose.");
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

const std::vector<std::string>& MeetingFeatures() {
  static const auto* const kFeatures = new std::vector<std::string>{
      "near",          "hands around",  "a hand around",   "hands meet",   "one hand out",
      "hand out",      "hands out",     "head recoils",    "root recoils", "hips recoil",
      "head retreats", "root retreats", "root approaches", "leans back",   "leans forward",
      "hand raised"};
  return *kFeatures;
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
  std::vector<double> uneven;
  for (size_t t = 0; t < series.lean.size(); ++t) {
    uneven.push_back(series.more_reach[t] - series.less_reach[t]);
  }
  const std::vector<double> upright(
      series.lean.begin(), series.lean.begin() + static_cast<std::ptrdiff_t>(
                                                     std::min(kUprightFrames, series.lean.size())));
  return {-Smallest(series.apart),
          -Smallest(series.hands_around),
          -Smallest(series.hand_around),
          -Smallest(series.hands_meet),
          Largest(uneven),
          Largest(series.more_reach),
          Largest(series.less_reach),
          LargestRise(series.head),
          LargestRise(series.root),
          LargestRise(series.hips),
          Largest(series.head) - series.head.front(),
          Largest(series.root) - series.root.front(),
          series.root.front() - Smallest(series.root),
          Largest(series.lean) - base::Mean(upright),
          -Smallest(series.lean),
          Largest(series.raised_hand)};
}

double ClassGeometry::Own(int of_class, int other, size_t feature) const {
  const auto a = static_cast<size_t>(of_class), b = static_cast<size_t>(other);
  const double difference = means[a][feature] - means[b][feature];
  const double spread =
      std::sqrt((std::pow(deviations[a][feature], 2) + std::pow(deviations[b][feature], 2)) / 2);
  return difference > spread ? difference : 0;
}

ClassGeometry MeasureClasses(const dataset::Dataset& dataset, const std::vector<int>& sequences) {
  const size_t features = MeetingFeatures().size();
  // Shapes: [classes][features][sequences of the class].
  std::vector<std::vector<std::vector<double>>> values(dataset.classes.size(),
                                                       std::vector<std::vector<double>>(features));
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    const std::vector<double> measured =
        MeasureMeeting(dataset.skeleton, sequence, sequence.pair.follower.poses);
    for (size_t f = 0; f < features; ++f) {
      values[static_cast<size_t>(sequence.interaction_class)][f].push_back(measured[f]);
    }
  }
  ClassGeometry classes;
  for (const auto& of_class : values) {
    auto& means = classes.means.emplace_back();
    auto& deviations = classes.deviations.emplace_back();
    for (const std::vector<double>& of_feature : of_class) {
      const base::MeanAndDeviation summary = base::Summarise(of_feature);
      means.push_back(summary.mean);
      deviations.push_back(summary.deviation);
    }
  }
  return classes;
}

double Deviation(const motion::Poses& mixed, const motion::Poses& own, const motion::Poses& other) {
  motion::Poses average = own;
  for (size_t i = 0; i < average.all().size(); ++i) {
    average.all()[i] = Lerp(own.all()[i], other.all()[i], 0.5f);
  }
  const double scale = DistanceOf(own, other) / 2;
  return Ratio(DistanceOf(mixed, average), scale);
}

double Kept::weaker() const {
  return std::isnan(own) || std::isnan(other) ? NAN : std::min(own, other);
}

double Kept::both() const { return std::isnan(weaker()) ? NAN : weaker() > 0.5 ? 1 : 0; }

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
  std::vector<std::string> names;
  std::vector<std::vector<Kept>> kept;
  for (const auto& [name, answers] : variants) {
    names.push_back(name);
    kept.push_back(MeasureKept(answers, folds));
  }
  report::Table table = EstimateTable(title, names);
  for (const MixFigure& figure : kMixFigures) {
    report::TableRow row{figure.name, {}};
    for (size_t v = 0; v < variants.size(); ++v) {
      const std::vector<MixedAnswer>& answers = variants[v].second;
      const auto mean = [&](const std::vector<size_t>& rows) {
        std::vector<double> values;
        for (const size_t i : rows) values.push_back(figure.of(answers[i], kept[v][i]));
        return base::Mean(values);
      };
      AddEstimate(LeadersOf(answers), mean, &row);
    }
    table.rows.push_back(std::move(row));
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

report::Table AvoidTable(const std::string& title, const std::vector<AvoidingAnswer>& answers) {
  using Value = Figure<AvoidingAnswer>;
  const auto probability = [](const std::vector<float>& of, int label) {
    return double{of[static_cast<size_t>(label)]};
  };
  const Value asked = [=](auto& a) { return probability(a.avoiding, a.own); };
  const Value alone = [=](auto& a) { return probability(a.alone, a.own); };
  const Value recognised = [](auto& a) { return Likeliest(a.avoiding) == a.own ? 1.0 : 0.0; };
  const Value recognised_alone = [](auto& a) { return Likeliest(a.alone) == a.own ? 1.0 : 0.0; };
  const struct {
    const char* name;
    Value of, base;  // base: none, or what its mean is divided by
  } kFigures[] = {
      {"requested, of alone", asked, alone},
      {"recognised, of alone", recognised, recognised_alone},
      {"avoided", [=](auto& a) { return probability(a.avoiding, a.avoided); }, nullptr},
      {"avoided, alone", [=](auto& a) { return probability(a.alone, a.avoided); }, nullptr},
      {"distance moved", [](auto& a) { return std::abs(a.moved); }, nullptr}};
  report::Table table = EstimateTable(title, {"own 1, other -1"});
  for (const auto& figure : kFigures) {
    const auto statistic = [&](const std::vector<size_t>& rows) {
      const double value = MeanOver(answers, rows, figure.of);
      return figure.base ? Ratio(value, MeanOver(answers, rows, figure.base)) : value;
    };
    AddEstimate(LeadersOf(answers), statistic,
                &table.rows.emplace_back(report::TableRow{figure.name, {}}));
  }
  table.notes = {
      "Requested, avoided: the judge's probability of the own class and of the class at -1; "
      "recognised: share of answers whose likeliest class is the own one; of alone: as a ratio to "
      "the own class at 1 by itself. Distance moved: of the roots, from that answer's, metres."};
  return table;
}

int PadSequence(dataset::Sequence* sequence) {
  const double rate = sequence->pair.leader.frame_rate_hz;
  const int frames = static_cast<int>(std::lround(kPaddingSeconds * rate));
  Pad(frames, &sequence->pair.leader);
  Pad(frames, &sequence->pair.follower);
  return frames;
}

Reaction MeasureReaction(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                         const Poses& follower) {
  const body::Body body = body::FindBody(skeleton);
  const Vec3 away = AwayFromLeader(sequence, skeleton.root);
  const double rate = sequence.pair.leader.frame_rate_hz;
  const auto smooth = [rate](const Poses& poses) { return motion::WithoutNoise(poses, rate); };
  const int action = ActionFrame(skeleton, body, smooth(sequence.pair.leader.poses), away);
  const int first = std::max(0, action - static_cast<int>(kBeforeActionSeconds * rate));
  const int end =
      std::min(follower.frame_count(), action + static_cast<int>(kAfterActionSeconds * rate) + 1);
  const Poses made = smooth(follower);
  const auto back = [&](int joint) {
    const std::vector<double> along = Positions(made, joint, away);
    return *std::max_element(along.begin() + first, along.begin() + end) -
           along[static_cast<size_t>(first)];
  };
  const int head = body.neck->head;
  return {back(head), back(skeleton.root),
          Correlation(VelocityAway(smooth(sequence.pair.follower.poses), head, skeleton.root, away),
                      VelocityAway(made, head, skeleton.root, away))};
}

report::Table ReactionTable(const std::string& title, const std::vector<ReactionPair>& pairs) {
  const auto mean = [&](const std::vector<size_t>& rows, const Figure<ReactionPair>& figure) {
    return MeanOver(pairs, rows, figure);
  };
  std::map<int, std::vector<size_t>> by_class;
  for (size_t row = 0; row < pairs.size(); ++row) {
    by_class[pairs[row].interaction_class].push_back(row);
  }
  report::Table table = EstimateTable(title, {"as captured", "padded"});
  // Adds a row with the statistic of each kind of answer.
  using Answer = Reaction ReactionPair::*;
  const auto add = [&](const std::string& name, const auto& statistic) {
    report::TableRow& row = table.rows.emplace_back(report::TableRow{name, {}});
    for (const Answer answer : {&ReactionPair::made, &ReactionPair::padded}) {
      AddEstimate(
          LeadersOf(pairs),
          [&](const std::vector<size_t>& rows) { return statistic(rows, answer); }, &row);
    }
  };
  for (const bool head : {true, false}) {
    const auto part = head ? &Reaction::head : &Reaction::torso;
    const Figure<ReactionPair> captured = [part](const ReactionPair& pair) {
      return pair.captured.*part;
    };
    const std::string name = head ? "head" : "torso";
    add("amplitude, " + name, [&](const std::vector<size_t>& rows, Answer answer) {
      const Figure<ReactionPair> made = [=](const ReactionPair& pair) {
        return pair.*answer.*part;
      };
      return Ratio(mean(rows, made), mean(rows, captured));
    });
    std::map<int, double> usual;
    for (const auto& [c, rows] : by_class) usual[c] = mean(rows, captured);
    add(name + " goes back", [&](const std::vector<size_t>& rows, Answer answer) {
      return mean(rows, [&](const ReactionPair& pair) {
        return pair.*answer.*part > usual.at(pair.interaction_class) / 2 ? 1.0 : 0.0;
      });
    });
  }
  add("correlation", [&](const std::vector<size_t>& rows, Answer answer) {
    return mean(rows, [answer](const ReactionPair& pair) { return (pair.*answer).correlation; });
  });
  table.notes = {
      "Amplitude: how far head and torso go away from the leader, from 0.3 s before to 1 s after "
      "the leader reaches farthest, as a ratio of means to the captured followers. Goes back: "
      "share of answers that go back by more than half of the captured mean of their class. "
      "Correlation: of the velocity away from the leader with the captured follower's, mean over "
      "the answers. Padded: the leader stands still for a second before and after. Low, high: 95 % "
      "interval by the bootstrap over leaders."};
  return table;
}

void AddEstimate(const std::vector<int>& leaders, const Statistic& statistic,
                 report::TableRow* row) {
  constexpr int kResamples = 400;
  std::vector<size_t> all(leaders.size());
  std::iota(all.begin(), all.end(), size_t{0});
  std::map<int, std::vector<size_t>> rows_of;
  for (const size_t i : all) rows_of[leaders[i]].push_back(i);
  std::vector<const std::vector<size_t>*> groups;
  for (const auto& [leader, rows] : rows_of) groups.push_back(&rows);
  base::Random random(0);
  std::vector<double> values;
  for (int n = 0; n < kResamples && !groups.empty(); ++n) {
    std::vector<size_t> drawn;
    for (size_t i = 0; i < groups.size(); ++i) {
      const auto& rows =
          *groups[static_cast<size_t>(random.Below(static_cast<int64_t>(groups.size())))];
      drawn.insert(drawn.end(), rows.begin(), rows.end());
    }
    const double value = statistic(drawn);
    if (!std::isnan(value)) values.push_back(value);
  }
  row->values.insert(row->values.end(), {statistic(all), base::Quantile(values, 0.025),
                                         base::Quantile(values, 0.975)});
}

Measure AddMixesCommand(CLI::App* command) {
  const auto flags = std::make_shared<MixesFlags>();
  AddAnswersFlags(flags.get(), command);
  AddNumber("--leaders", &flags->leaders, 0, 1000,
            "leaders of each class in a fold; 0: all of the left-out subject", command);
  command
      ->add_option("--reaction-classes", flags->reaction_classes,
                   "classes of the reaction (default: all)")
      ->delimiter(',');
  return [flags] { return RunMixes(*flags); };
}

}  // namespace duet::evaluation::program
