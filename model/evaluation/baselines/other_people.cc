#include "model/evaluation/baselines/other_people.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/random.h"
#include "model/evaluation/baselines/motion_matrix.h"
#include "model/motion/resample.h"
#include "model/motion/standardise.h"

namespace duet::evaluation::baselines {
namespace {

using dataset::Sequence;

// The captured followers of a class that can answer a clip of `frames` frames.
std::vector<const Sequence*> Candidates(const dataset::Dataset& dataset,
                                        const std::vector<int>& train, int interaction_class,
                                        int frames) {
  std::vector<const Sequence*> all, enough;
  for (const int index : train) {
    const Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    if (sequence.interaction_class != interaction_class) continue;
    all.push_back(&sequence);
    if (sequence.pair.leader.frame_count() >= frames) enough.push_back(&sequence);
  }
  return enough.empty() ? all : enough;
}

constexpr double kPieceSeconds = 1, kStrideSeconds = 0.1;

int Frames(const dataset::Dataset& dataset, double seconds) {
  return std::max(1, static_cast<int>(std::lround(seconds * dataset.frame_rate_hz)));
}

// The coordinates of the leader's first frame.
motion::Standardisation FrameOf(const dataset::Dataset& dataset, const motion::Poses& leader) {
  return {dataset.skeleton, leader, motion::YawDirection::kRemove,
          motion::StandardOrigin::kFirstFrame};
}

// A piece of both people in the coordinates of its leader's first frame.
struct StandardPiece {
  motion::Poses leader, follower;
};

StandardPiece Cut(const dataset::Dataset& dataset, const motion::ClipPair& pair, int begin,
                  int frames) {
  const motion::Poses leader = motion::Part(pair.leader.poses, begin, frames);
  const motion::Standardisation frame = FrameOf(dataset, leader);
  return {frame.Apply(leader), frame.Apply(motion::Part(pair.follower.poses, begin, frames))};
}

double SquaredDistance(const motion::Poses& a, const motion::Poses& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.all().size(); ++i) {
    const motion::Vec3 apart = a.all()[i] - b.all()[i];
    sum += Dot(apart, apart);
  }
  return sum;
}

const StandardPiece& Nearest(const std::vector<StandardPiece>& pieces,
                             const motion::Poses& leader) {
  const StandardPiece* nearest = &pieces.front();
  double least = std::numeric_limits<double>::infinity();
  for (const StandardPiece& piece : pieces) {
    const double distance = SquaredDistance(piece.leader, leader);
    if (distance >= least) continue;
    least = distance;
    nearest = &piece;
  }
  return *nearest;
}

int ClassAt(const dataset::Sequence& sequence, int frame) {
  for (const dataset::LabelSpan& span : sequence.labels) {
    if (span.begin <= frame && frame < span.end) return span.interaction_class;
  }
  return sequence.interaction_class;
}

// The mean pose of each class and, last, of all frames; of a class without frames that of all.
std::vector<motion::Poses> MeanFollowers(const dataset::Dataset& dataset,
                                         const std::vector<int>& train) {
  const auto classes = static_cast<std::size_t>(dataset.class_count());
  std::vector<motion::Poses> means(classes + 1, motion::Poses(1, dataset.skeleton.joint_count()));
  std::vector<float> counts(classes + 1);
  for (const int index : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<std::size_t>(index)];
    for (int t = 0; t < sequence.pair.leader.frame_count(); ++t) {
      const StandardPiece piece = Cut(dataset, sequence.pair, t, 1);
      for (const std::size_t to : {static_cast<std::size_t>(ClassAt(sequence, t)), classes}) {
        for (std::size_t j = 0; j < piece.follower.all().size(); ++j) {
          means[to].all()[j] += piece.follower.all()[j];
        }
        ++counts[to];
      }
    }
  }
  for (std::size_t c = 0; c <= classes; ++c) {
    for (motion::Vec3& joint : means[c].all()) joint = joint / std::max(counts[c], 1.0f);
  }
  for (std::size_t c = 0; c < classes; ++c) {
    if (counts[c] == 0) means[c] = means[classes];
  }
  return means;
}

}  // namespace

absl::StatusOr<std::vector<motion::Poses>> AnswerWithOtherPeople(const dataset::Dataset& dataset,
                                                                 const std::vector<int>& train,
                                                                 const std::vector<int>& test,
                                                                 uint64_t seed) {
  constexpr auto kFirstFrame = motion::StandardOrigin::kFirstFrame;
  base::Random random(seed);
  std::vector<motion::Poses> answers;
  for (const int index : test) {
    const Sequence& asked = dataset.sequences[static_cast<size_t>(index)];
    const int frames = asked.pair.leader.frame_count();
    const auto candidates = Candidates(dataset, train, asked.interaction_class, frames);
    if (candidates.empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          "other people: expected at least one training sequence of class ",
          dataset.classes[static_cast<size_t>(asked.interaction_class)], ", got none"));
    }
    const auto drawn = random.Below(static_cast<int64_t>(candidates.size()));
    const Sequence& other = *candidates[static_cast<size_t>(drawn)];
    const Rows motion = ToRows(BaselineStandardisation(dataset.skeleton, other, kFirstFrame)
                                   .Apply(other.pair.follower.poses));
    answers.push_back(BaselineStandardisation(dataset.skeleton, asked, kFirstFrame)
                          .Invert(FromRows(motion.rows() < frames ? StretchTo(motion, frames)
                                                                  : Rows(motion.topRows(frames)))));
  }
  return answers;
}

motion::Poses NearestSeconds(const dataset::Dataset& dataset, const std::vector<int>& train,
                             const dataset::Sequence& take) {
  const int frames = take.pair.leader.frame_count();
  const int length = std::min(Frames(dataset, kPieceSeconds), frames);
  std::vector<StandardPiece> pieces;
  for (const int index : train) {
    const motion::ClipPair& pair = dataset.sequences[static_cast<std::size_t>(index)].pair;
    for (int t = 0; t + length <= pair.leader.frame_count(); t += Frames(dataset, kStrideSeconds)) {
      pieces.push_back(Cut(dataset, pair, t, length));
    }
  }
  motion::Poses follower(0, dataset.skeleton.joint_count());
  for (int t = 0; t < frames && !pieces.empty(); t += length) {
    const int begin = std::min(t, frames - length);
    const motion::Poses leader = motion::Part(take.pair.leader.poses, begin, length);
    const motion::Standardisation frame = FrameOf(dataset, leader);
    const motion::Poses made = frame.Invert(Nearest(pieces, frame.Apply(leader)).follower);
    follower.Append(made.frames(t - begin, length - (t - begin)));
  }
  return follower;
}

motion::Poses MeanOfClass(const dataset::Dataset& dataset, const std::vector<int>& train,
                          const dataset::Sequence& take) {
  const std::vector<motion::Poses> means = MeanFollowers(dataset, train);
  motion::Poses follower(0, dataset.skeleton.joint_count());
  for (int t = 0; t < take.pair.leader.frame_count(); ++t) {
    const motion::Standardisation frame =
        FrameOf(dataset, motion::Part(take.pair.leader.poses, t, 1));
    follower.Append(frame.Invert(means[static_cast<std::size_t>(ClassAt(take, t))]).all());
  }
  return follower;
}

motion::Poses FirstPoseHeld(const dataset::Sequence& take) {
  motion::Poses held(0, take.pair.follower.poses.joint_count());
  for (int t = 0; t < take.pair.leader.frame_count(); ++t) {
    held.Append(take.pair.follower.poses[0]);
  }
  return held;
}

}  // namespace duet::evaluation::baselines
