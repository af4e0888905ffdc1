#include <algorithm>
#include <cmath>
#include <limits>

#include "model/base/median.h"
#include "model/evaluation/baselines/class_models.h"

namespace duet::evaluation::baselines {
namespace {

constexpr int kComponents = 10;
// The most training frames to keep: of more, every second (third, ...) one, and the leader's
// likewise.
constexpr int kMostSamples = 400;
// Widths of the kernels, in units of the median distance to the nearest sample of another clip.
constexpr double kTransitionWidth = 1, kDecodingWidth = 4;
constexpr double kVelocityWeight = 2;  // weight of the change over a step, relative to the pose
constexpr int kDemonstrations = 8;     // clips from which the reward's weight is learnt
constexpr double kNever = -1e9;        // log weight of an excluded sample
// Minimum width of a kernel, relative to the root mean squared distance: otherwise repeated takes
// of one motion would make every other motion infinitely far.
constexpr double kLeastWidth = 0.05;
constexpr double kTiny = 1e-9;
// Candidate weights of the reward: powers of two times that of a Gaussian of the cues' own width.
constexpr int kLeastPower = -8, kMostPower = 4;
constexpr int kMeanShifts = 20;

// The median over samples of the distance to the nearest one of another clip.
double MedianNearest(const Eigen::MatrixXd& squared, const std::vector<int>& clip) {
  std::vector<double> nearest;
  for (Eigen::Index i = 0; i < squared.rows(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index j = 0; j < squared.cols(); ++j) {
      const bool other = clip[static_cast<size_t>(i)] != clip[static_cast<size_t>(j)];
      if (other) least = std::min(least, squared(i, j));
    }
    if (std::isfinite(least)) nearest.push_back(std::sqrt(least));
  }
  const double least_width = kLeastWidth * std::sqrt(squared.mean()) + kTiny;
  if (nearest.empty()) return least_width;  // a single clip
  return std::max(base::Median(nearest), least_width);
}

// Rows 0, n, 2 n, ...
Rows EveryNth(const Rows& rows, Eigen::Index n) {
  return rows(Eigen::seq(0, rows.rows() - 1, n), Eigen::all);
}

// Inverts EveryNth: linear between the kept rows, constant after the last.
Rows FillBetween(const Rows& kept, Eigen::Index n, Eigen::Index rows) {
  Rows filled(rows, kept.cols());
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Eigen::Index next = std::min(i / n + 1, kept.rows() - 1);
    const double part = static_cast<double>(i % n) / static_cast<double>(n);
    filled.row(i) = (1 - part) * kept.row(i / n) + part * kept.row(next);
  }
  return filled;
}

class KernelRl : public ClassModel {
 public:
  explicit KernelRl(const std::vector<StandardPair>& pairs) {
    const Rows cues = Stack(pairs, &StandardPair::cues),
               poses = Stack(pairs, &StandardPair::follower);
    leader_ = PoseSpace(cues, kComponents);
    follower_ = PoseSpace(poses, kComponents);
    stride_ = (cues.rows() + kMostSamples - 1) / kMostSamples;
    std::vector<Eigen::Index> kept;
    std::vector<int> successor;
    Eigen::Index first = 0;
    for (size_t i = 0; i < pairs.size(); ++i) {
      const Eigen::Index frames = pairs[i].cues.rows();
      for (Eigen::Index t = 0; t < frames; t += stride_) {
        const int index = static_cast<int>(kept.size());
        kept.push_back(first + t);
        clip_.push_back(static_cast<int>(i));
        // A clip's last pose follows itself.
        successor.push_back(t + stride_ < frames ? index + 1 : index);
      }
      first += frames;
    }
    cues_ = leader_.Project(cues(kept, Eigen::all));
    poses_ = follower_.Project(poses(kept, Eigen::all));
    BuildStep(successor);
    LearnReward(pairs);
  }

  Rows Predict(const StandardPair& leader) const override {
    const Rows visits = Plan(reward_weight_ * Cost(leader.cues), /*without=*/-1).states;
    return follower_.Reconstruct(FillBetween(MeanShift(visits), stride_, leader.cues.rows()));
  }

 private:
  void BuildStep(const std::vector<int>& successor) {
    // A state is a pose and its change: without the change, motion could reverse freely.
    const Eigen::Index samples = poses_.rows(), width = poses_.cols();
    Rows states(samples, 2 * width);
    for (Eigen::Index i = 0; i < samples; ++i) {
      const Eigen::Index next = successor[static_cast<size_t>(i)];
      states.row(i) << poses_.row(i), kVelocityWeight * (poses_.row(next) - poses_.row(i));
    }
    pose_width_ = MedianNearest(SquaredDistances(poses_, poses_), clip_);
    const Eigen::MatrixXd squared = SquaredDistances(states, states);
    const double spread = kTransitionWidth * MedianNearest(squared, clip_);
    Eigen::MatrixXd kernel = (-squared / (2 * spread * spread)).array().exp();
    kernel.array().colwise() /= kernel.rowwise().sum().array().eval();
    step_ = Eigen::MatrixXd::Zero(samples, samples);
    for (Eigen::Index like = 0; like < samples; ++like) {
      step_.col(successor[static_cast<size_t>(like)]) += kernel.col(like);
    }
  }

  void LearnReward(const std::vector<StandardPair>& pairs) {
    const double cue_width = MedianNearest(SquaredDistances(cues_, cues_), clip_);
    double best = -std::numeric_limits<double>::infinity();
    for (int power = kLeastPower; power <= kMostPower; ++power) {
      const double weight = std::pow(2, power) / (2 * cue_width * cue_width);
      const double likelihood = LogLikelihood(pairs, weight);
      if (likelihood <= best) continue;
      best = likelihood;
      reward_weight_ = weight;
    }
  }

  double LogLikelihood(const std::vector<StandardPair>& pairs, double weight) const {
    const size_t stride = std::max<size_t>(1, pairs.size() / size_t{kDemonstrations});
    const double precision = 1 / (2 * pose_width_ * pose_width_);
    double sum = 0;
    for (size_t i = 0; pairs.size() > 1 && i < pairs.size(); i += stride) {
      const int clip = static_cast<int>(i);
      const Rows cost = weight * Cost(pairs[i].cues);
      const Rows noise =
          precision *
          SquaredDistances(EveryNth(follower_.Project(pairs[i].follower), stride_), poses_);
      sum += Plan(cost + noise, clip).log_sum - Plan(cost, clip).log_sum;
    }
    return sum;
  }

  // Distances between the leader's cues and each sample's. Shapes: returns [frames / stride,
  // samples].
  Rows Cost(const Rows& cues) const {
    return SquaredDistances(EveryNth(leader_.Project(cues), stride_), cues_);
  }

  // Soft value iteration and the policy's visits, given the cost of arriving at each sample in each
  // frame. Ignores samples of the clip `without` (-1: none).
  PathPosterior Plan(const Rows& cost, int without) const {
    Rows arrivals = -cost;
    for (Eigen::Index i = 0; i < arrivals.cols(); ++i) {
      if (clip_[static_cast<size_t>(i)] == without) arrivals.col(i).setConstant(kNever);
    }
    return SumOverPaths({Eigen::RowVectorXd::Ones(arrivals.cols()), step_}, arrivals);
  }

  Rows MeanShift(const Rows& visits) const {
    const double width = kDecodingWidth * pose_width_;
    Rows poses(visits.rows(), poses_.cols());
    for (Eigen::Index t = 0; t < visits.rows(); ++t) {
      Eigen::Index likeliest = 0;
      visits.row(t).maxCoeff(&likeliest);
      Rows pose = poses_.row(likeliest);
      for (int i = 0; i < kMeanShifts; ++i) {
        const Eigen::RowVectorXd kernel =
            (-SquaredDistances(pose, poses_) / (2 * width * width)).array().exp();
        const Eigen::RowVectorXd weights = kernel.cwiseProduct(visits.row(t));
        pose = weights * poses_ / weights.sum();
      }
      poses.row(t) = pose;
    }
    return poses;
  }

  PoseSpace leader_, follower_;
  Eigen::Index stride_ = 1;  // frames from one sample to the next
  Rows cues_, poses_;        // [samples, components]
  std::vector<int> clip_;    // the sequence of each sample
  Eigen::MatrixXd step_;     // [from, to]: transitions from samples similar to `from`
  double pose_width_ = 1;    // median distance to the nearest sample of another clip
  double reward_weight_ = 1;
};

}  // namespace

std::unique_ptr<ClassModel> LearnKernelRl(const std::vector<StandardPair>& pairs) {
  return std::make_unique<KernelRl>(pairs);
}

}  // namespace duet::evaluation::baselines
