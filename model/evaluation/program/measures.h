#ifndef DUET_MODEL_EVALUATION_PROGRAM_MEASURES_H_
#define DUET_MODEL_EVALUATION_PROGRAM_MEASURES_H_

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "model/body/grade.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/judge/judge.h"
#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/report/report.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// What the commands measure. Each is defined beside its command, except those of mixes (mixes.cc,
// reaction.cc).

namespace duet::evaluation::program {

// told-apart

// Settings of told-apart classifiers. They see leader and follower, and vary people's proportions
// less than a judge does, since a limb of a wrong length may identify an answer.
judge::MotionClassifierOptions ToldApartOptions(uint64_t seed);

// The balanced accuracy of a new classifier that distinguishes synthesised from captured pairs.
// 0.5: indistinguishable; 1: always correct. It learns from answers to the training sequences and
// from their captured followers, and is tested on the same of the test sequences. Leaders and
// followers all pass the same filter (WithoutNoise), so that it cannot detect sensor noise. Errors:
// INVALID_ARGUMENT without training answers.
absl::StatusOr<double> ToldApart(const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& training_answers,
                                 const std::vector<metrics::ScoredMotion>& test_answers,
                                 const judge::MotionClassifierOptions& options);

// plausible

// What a viewer would notice in one pair. Cost: linear in the frames. Requires a skeleton that
// body::PairMeter::CanMeasure accepts, at least one frame and as many of the follower. Shapes:
// returns [PlausibleFigures]; NaN where there is nothing to measure.
std::vector<double> MeasurePlausibility(const motion::Skeleton& skeleton,
                                        const motion::Poses& leader, const motion::Poses& follower,
                                        double rate);
const std::vector<std::string>& PlausibleFigures();

// sweep: the effect of a class's weight in the label vector on a judge's probability of that class.
// Source: the paper's graded and negative labels (section 3.1), which it shows but does not
// measure.

// -1, -0.75, ..., 2: the weights of a sweep, in order.
const std::vector<double>& SweepWeights();

// One leader answered at every weight of one class: the only class (own == raised), or beside the
// leader's own class at weight 1.
struct SweepCurve {
  int own = 0;                                    // the class of the leader's interaction
  int raised = 0;                                 // the class whose weight is swept
  std::vector<std::vector<float>> probabilities;  // [weights][classes]
};

// Two tables for the own class alone, and two for another class beside it; a row for each class.
// The first has the shares of curves whose probability goes the way its weight goes (from 0 to 1,
// from 0 to -1) and that stay level; the second the mean probability at each weight.
std::vector<report::Table> SweepTables(const std::string& model,
                                       const std::vector<std::string>& classes,
                                       const std::vector<SweepCurve>& curves);

// augmentation

// A request for a synthetic motion.
struct SyntheticJob {
  dataset::Sequence sequence;  // a leader of its class; the follower has no positions
  std::vector<float> labels;   // [classes], the label vector
};

// The jobs for synthetic followers of every class; only the seed determines the draw.
//
// Leaders are those of `train`, those of each class in turn as often as needed, with variations:
// both people exchanged in half of the clips of symmetric classes, bodies larger or smaller by up
// to 8 %, turned by about 6 degrees, played up to 10 % faster or slower. Interaction match gives
// the leader's class a weight of 0.75 to 1.25. Interaction mix gives it 0.75 to 1, and one other
// class 0.1 to 0.35, so that the motion stays one of its class.
//
// Source: paper section 4 (300 synthetic motions, 50 a class, "25 + 25"), which does not say how it
//         varies leaders and weights; read as 25 by interaction match and 25 by interaction mix.
// Shapes: returns match + mix jobs per class, sorted by class. Requires a sequence of every class
// in `train`; mix above 0 requires two classes.
std::vector<SyntheticJob> PlanSyntheticSet(const dataset::Dataset& dataset,
                                           const std::vector<int>& train, int match, int mix,
                                           uint64_t seed);

// mixes

// The horizontal direction, of length 1, from leader to follower in a capture's first frame.
motion::Vec3 AwayFromLeader(const dataset::Sequence& sequence, int root);

// How a follower meets a leader, in numbers: how near it comes, what its hands do, how it recoils.
// Every feature is an extreme over the clip, and larger for more of it; therefore a mix can have
// the features of two classes at different times. Metres, and degrees for leaning. Requires
// CanMeasureMeeting, and a follower of as many frames as the leader. Shapes: returns
// [MeetingFeatures].
std::vector<double> MeasureMeeting(const motion::Skeleton& skeleton,
                                   const dataset::Sequence& sequence,
                                   const motion::Poses& follower);
const std::vector<std::string>& MeetingFeatures();
// Whether the skeleton has hips, two arms, a chest and a head.
bool CanMeasureMeeting(const motion::Skeleton& skeleton);

// The features of captured followers, by class. Shapes: [classes][features].
struct ClassGeometry {
  std::vector<std::vector<double>> means, deviations;

  // By how much the feature of a class exceeds that of another class, if this is more than their
  // spread; otherwise 0. A feature that exceeds it belongs to the class's own geometry.
  double Own(int of_class, int other, size_t feature) const;
};
ClassGeometry MeasureClasses(const dataset::Dataset& dataset, const std::vector<int>& sequences);

// An answer to two classes at once, and the answers to each of them by itself. All have one seed
// and one start, so that only the labels differ.
struct MixedAnswer {
  int leader = 0;
  int fold = 0;            // of the captures that say what belongs to a class
  int own = 0, other = 0;  // the class of the leader's interaction, and the one that is added
  // Of the mix and of the two single answers. Shapes: [MeetingFeatures].
  std::vector<double> mixed = {}, own_alone = {}, other_alone = {};
  std::vector<float> probabilities = {};  // the judge's of the mix [classes]
  double deviation = 0;                   // Deviation's
  body::Grade grade = {};
};

// The distance of a mix from the average of both single answers, over that of either single answer
// from it: 0 for the average, 1 for a single answer. NaN if the single answers are the same.
double Deviation(const motion::Poses& mixed, const motion::Poses& own, const motion::Poses& other);

// How much of each class's own geometry a mix keeps: 0 as in the other class's single answer, 1 as
// in its own; the mean over the features that are larger in the class, in captures by more than
// their spread, and in single answers by a good part of that. NaN if there is none.
struct Kept {
  double own = NAN, other = NAN;

  double weaker() const;
  double both() const;  // 1: both are above half
};
// Shapes: folds [folds]; returns [answers].
std::vector<Kept> MeasureKept(const std::vector<MixedAnswer>& answers,
                              const std::vector<ClassGeometry>& folds);

// Answers to all leaders with the same weights, under the name that tables show.
using MixVariant = std::pair<std::string, std::vector<MixedAnswer>>;

// The figures of every variant with their intervals.
report::Table MixTable(const std::string& title, const std::vector<ClassGeometry>& folds,
                       const std::vector<MixVariant>& variants);

// The judge's probabilities [classes] of the answer to a class, and of the same with another one at
// -1, and by how much that changes the mean distance of the roots, metres.
struct AvoidingAnswer {
  int leader = 0;
  int own = 0, avoided = 0;
  std::vector<float> alone = {}, avoiding = {};
  double moved = 0;
};
report::Table AvoidTable(const std::string& title, const std::vector<AvoidingAnswer>& answers);

// How strongly, and when, a follower gives way to what a leader does.
struct Reaction {
  // How far head and torso go back about the leader's action, metres.
  double head = 0, torso = 0;
  double correlation = 0;  // of the velocity away from the leader with the captured follower's
};

// Captured and synthesised reactions to one leader's clip.
struct ReactionPair {
  int leader = 0;
  int interaction_class = 0;
  Reaction captured, made;
  Reaction padded;  // to the same leader, who stands still for a second before and after
};

// Repeats the first and last frames of both people for a second. Returns the frames added in front.
int PadSequence(dataset::Sequence* sequence);

// Measures a follower, from 0.3 s before until 1 s after a hand or foot of the leader reaches
// farthest towards the captured follower. Requires a body with a neck and arms.
Reaction MeasureReaction(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                         const motion::Poses& follower);

// The figures of all pairs with their intervals.
report::Table ReactionTable(const std::string& title, const std::vector<ReactionPair>& pairs);

// Estimates of mixes and reaction.

// A figure of some of the rows of a measurement, which may be repeated. NaN: it has no value.
using Statistic = std::function<double(const std::vector<size_t>& rows)>;

// Adds to `row` the statistic of all rows, and both ends of its 95 % interval by the bootstrap:
// leaders are drawn with all their rows, because the answers to one leader are alike. The same
// input gives the same result. Shapes: leaders [rows].
void AddEstimate(const std::vector<int>& leaders, const Statistic& statistic,
                 report::TableRow* row);
// A table with a figure and both ends of its interval for each variant.
report::Table EstimateTable(const std::string& title, const std::vector<std::string>& variants);
// NaN for a denominator of 0.
double Ratio(double numerator, double denominator);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_MEASURES_H_
