#include "model/dataset/partner_direction.h"

namespace duet::dataset {

motion::Vec3 PartnerDirection(const motion::Skeleton& skeleton, const Sequence& sequence) {
  if (sequence.partner_direction) return *sequence.partner_direction;
  const motion::Vec3 toward =
      sequence.pair.follower.at(0, skeleton.root) - sequence.pair.leader.at(0, skeleton.root);
  return {toward.x, 0, toward.z};
}

}  // namespace duet::dataset
