#include <limits>

#include "model/evaluation/baselines/class_models.h"

namespace duet::evaluation::baselines {
namespace {

class NearestNeighbour : public ClassModel {
 public:
  explicit NearestNeighbour(const std::vector<StandardPair>& pairs) : pairs_(pairs) {}

  Rows Predict(const StandardPair& leader) const override {
    const StandardPair* nearest = nullptr;
    double best = std::numeric_limits<double>::infinity();
    for (const StandardPair& pair : pairs_) {
      const double distance = TimeWarpedDistance(leader.leader, pair.leader);
      if (nearest != nullptr && distance >= best) continue;
      best = distance;
      nearest = &pair;
    }
    return StretchTo(nearest->follower, leader.leader.rows());
  }

 private:
  std::vector<StandardPair> pairs_;
};

}  // namespace

std::unique_ptr<ClassModel> LearnNearestNeighbour(const std::vector<StandardPair>& pairs) {
  return std::make_unique<NearestNeighbour>(pairs);
}

}  // namespace duet::evaluation::baselines
