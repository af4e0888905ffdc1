#ifndef DUET_CLIENT_BATCH_POSE_STRIP_H_
#define DUET_CLIENT_BATCH_POSE_STRIP_H_

#include <string>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// A pair as a strip of at most six frames, evenly from the first to the last: an <svg> with a path
// of class "leader" and one of class "follower". The view is from the side, with the leader on the
// left. All frames have the same scale and floor; each is centred in its part of the strip.
//
// Requires at least one frame, people with the same number of frames, and finite positions.
std::string PoseStrip(const motion::ClipPair& pair, const motion::Skeleton& skeleton);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_POSE_STRIP_H_
