#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "absl/types/span.h"
#include "model/motion/posture.h"
#include "model/motion/slope_evidence.h"

namespace duet::motion {
namespace {

// All spreads are standard deviations of tangents, chosen on the captures of SBU and
// K3HI; CMU's salsa is the test (docs/decisions/captures.md).
struct Spread {
  double forward, sideways;
};
constexpr double kHabitForward = 0.03;  // mean of the habit
constexpr Spread kHabit = {0.05, 0.02}, kOwn = {0.12, 0.07};
constexpr double kNoise = 0.12;  // of a block
// What everybody in a capture leans in one direction: people push, pull and hug each other. It
// averages out over so many seconds of a person.
constexpr double kCommon = 0.03, kCommonSeconds = 6;
constexpr double kLeastError = 0.0175;  // however much is captured: 1 degree

constexpr double kBlockSeconds = 0.5;
constexpr double kLeastUpright = 0.7;  // the cosine of 45 degrees
constexpr float kLiftedMetres = 0.25f;
constexpr float kLeastStraight = 0.8f;  // of a leg; a knee bent by 74 degrees has it
constexpr int kSteps = 10;
constexpr double kReach = 2;  // standard deviations with full weight

using Vec4 = std::array<double, 4>;
using Mat4 = std::array<Vec4, 4>;

// Whether the hip is as far from the foot as the bones between them are long, about. True if the
// foot is no descendant of the hip.
bool IsStraight(absl::Span<const int> parents, absl::Span<const Vec3> pose, int hip, int foot) {
  float bones = 0;
  int joint = foot;
  for (; joint >= 0 && joint != hip; joint = parents[static_cast<std::size_t>(joint)]) {
    const int parent = parents[static_cast<std::size_t>(joint)];
    if (parent >= 0)
      bones +=
          Distance(pose[static_cast<std::size_t>(joint)], pose[static_cast<std::size_t>(parent)]);
  }
  return joint < 0 || Distance(pose[static_cast<std::size_t>(hip)],
                               pose[static_cast<std::size_t>(foot)]) >= kLeastStraight * bones;
}

// Whether the person stands on both legs. False for positions that are not finite.
bool Stands(const Skeleton& skeleton, absl::Span<const int> parents, absl::Span<const Vec3> pose) {
  const auto [left, right] = *skeleton.feet;
  const float apart =
      pose[static_cast<std::size_t>(left)].y - pose[static_cast<std::size_t>(right)].y;
  return std::abs(apart) <= kLiftedMetres && IsStraight(parents, pose, skeleton.hips->left, left) &&
         IsStraight(parents, pose, skeleton.hips->right, right);
}

}  // namespace

// The unknowns are the slope (x, z) and the habit (forward, left).
struct BodyEvidence::Equations {
  Mat4 matrix{};
  Vec4 vector{};
};

// The block of frames [first, end). Absent if the person does not stand in it.
std::optional<BodyEvidence::Block> BodyEvidence::BlockOf(const Skeleton& skeleton, const Clip& clip,
                                                         int first, int end) {
  const std::vector<int> parents = skeleton.Parents();
  Vec3 body, left;
  for (int t = first; t < end; ++t) {
    if (!Stands(skeleton, parents, clip.poses[t])) return std::nullopt;
    body += FromFeet(skeleton, clip.poses, t);
    left += clip.at(t, skeleton.hips->left) - clip.at(t, skeleton.hips->right);
  }
  if (!(static_cast<double>(body.y) > kLeastUpright * static_cast<double>(Norm(body)))) return {};
  const double across = std::hypot(left.x, left.z);
  if (!(across > 0)) return std::nullopt;
  Block block;
  block.lean = {static_cast<double>(body.x / body.y), static_cast<double>(body.z / body.y)};
  block.c = left.x / across;
  block.s = -left.z / across;
  return block;
}

void BodyEvidence::Add(const Skeleton& skeleton, const Clip& person) {
  std::vector<Block> blocks;
  const int window =
      std::max(1, static_cast<int>(std::lround(kBlockSeconds * person.frame_rate_hz)));
  for (int first = 0; first < person.frame_count(); first += window) {
    const int end = std::min(first + window, person.frame_count());
    std::optional<Block> block = BlockOf(skeleton, person, first, end);
    if (!block) continue;
    block->weight = static_cast<double>(end - first) / window;
    blocks.push_back(*block);
  }
  if (!blocks.empty()) people_.push_back(std::move(blocks));
}

// The precision of a block, smaller for one far from what `now` predicts.
double BodyEvidence::Precision(const Block& block, const Vec4& now) {
  const std::array<Vec4, 2> rows = block.Rows();
  double squares = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    double residual = block.lean[k];
    for (std::size_t i = 0; i < 4; ++i) residual -= rows[k][i] * now[i];
    squares += residual * residual;
  }
  const double far = std::sqrt(squares) / (kReach * std::hypot(kOwn.forward, kNoise));
  return block.weight / (kNoise * kNoise) / std::max(1.0, far * far);
}

// Adds a person's blocks and eliminates the person's own lean.
void BodyEvidence::AddPerson(const std::vector<Block>& blocks, const Vec4& now,
                             Equations* equations) {
  std::array<double, 2> own = {1 / (kOwn.forward * kOwn.forward),
                               1 / (kOwn.sideways * kOwn.sideways)};
  std::array<std::array<double, 2>, 4> mixed{};
  std::array<double, 2> own_vector{};
  for (const Block& block : blocks) {
    const double precision = Precision(block, now);
    const std::array<Vec4, 2> rows = block.Rows();
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t i = 0; i < 4; ++i) {
        const double scaled = precision * rows[k][i];
        for (std::size_t j = 0; j < 4; ++j) equations->matrix[i][j] += scaled * rows[k][j];
        for (std::size_t j = 0; j < 2; ++j) mixed[i][j] += scaled * rows[k][j + 2];
        equations->vector[i] += scaled * block.lean[k];
      }
      for (std::size_t j = 0; j < 2; ++j)
        own_vector[j] += precision * rows[k][j + 2] * block.lean[k];
    }
    own[0] += precision;  // forward and left are perpendicular unit vectors
    own[1] += precision;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t j = 0; j < 4; ++j) {
        equations->matrix[i][j] -= mixed[i][k] * mixed[j][k] / own[k];
      }
      equations->vector[i] -= mixed[i][k] * own_vector[k] / own[k];
    }
  }
}

namespace {

// The equations of the slope without the habit.
Information WithoutHabit(const Mat4& m, const Vec4& v) {
  const auto without = [&](const Vec4& row, double right_forward, double right_left, double value) {
    const SlopeEstimate habit = Solve({m[2][2], m[2][3], m[3][3], right_forward, right_left});
    return value - row[2] * habit.mean.x - row[3] * habit.mean.z;
  };
  return {without(m[0], m[2][0], m[3][0], m[0][0]), without(m[0], m[2][1], m[3][1], m[0][1]),
          without(m[1], m[2][1], m[3][1], m[1][1]), without(m[0], v[2], v[3], v[0]),
          without(m[1], v[2], v[3], v[1])};
}

// The slope and the habit that goes with it.
Vec4 Unknowns(const Mat4& m, const Vec4& v, Slope slope) {
  const Slope habit =
      Solve({m[2][2], m[2][3], m[3][3], v[2] - m[2][0] * slope.x - m[2][1] * slope.z,
             v[3] - m[3][0] * slope.x - m[3][1] * slope.z})
          .mean;
  return {slope.x, slope.z, habit.x, habit.z};
}

}  // namespace

std::optional<SlopeEstimate> BodyEvidence::Estimate() const {
  if (people_.empty()) return std::nullopt;
  Vec4 now = {0, 0, kHabitForward, 0};
  SlopeEstimate slope;
  for (int step = 0; step < kSteps; ++step) {
    Equations equations;
    equations.matrix[2][2] = 1 / (kHabit.forward * kHabit.forward);
    equations.matrix[3][3] = 1 / (kHabit.sideways * kHabit.sideways);
    equations.vector[2] = equations.matrix[2][2] * kHabitForward;
    for (const std::vector<Block>& blocks : people_) AddPerson(blocks, now, &equations);
    slope = Solve(WithoutHabit(equations.matrix, equations.vector));
    now = Unknowns(equations.matrix, equations.vector, slope.mean);
  }
  double seconds = 0;
  for (const std::vector<Block>& blocks : people_) {
    for (const Block& block : blocks) seconds += kBlockSeconds * block.weight;
  }
  const double common = kCommon * kCommon / std::max(1.0, seconds / kCommonSeconds);
  slope.xx += common + kLeastError * kLeastError;
  slope.zz += common + kLeastError * kLeastError;
  return slope;
}

}  // namespace duet::motion
