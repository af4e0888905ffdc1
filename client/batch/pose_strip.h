#ifndef DUET_CLIENT_BATCH_POSE_STRIP_H_
#define DUET_CLIENT_BATCH_POSE_STRIP_H_

#include <string>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// A pair as a strip of at most six moments, evenly from the first frame to the last: an <svg> with
// a path of class "leader" and one of class "follower". Seen from the side, the leader on the left;
// each moment is in the middle of its place, all at one scale and on one floor.
//
// Requires a frame, people of the same length and positions that are finite.
std::string PoseStrip(const motion::ClipPair& pair, const motion::Skeleton& skeleton);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_POSE_STRIP_H_
