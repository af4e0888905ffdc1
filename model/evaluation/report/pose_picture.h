#ifndef DUET_MODEL_EVALUATION_REPORT_POSE_PICTURE_H_
#define DUET_MODEL_EVALUATION_REPORT_POSE_PICTURE_H_

#include <string>
#include <vector>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

// Leader and follower as figures of thick strokes, seen from the side, a little from above. Leader
// blue, follower orange; of both, the left side is the paler one.

namespace duet::evaluation::report {

// Two people and what the picture calls them. Shapes: as many frames in both, 1 or more, and in
// every pair of a picture.
struct PicturedPair {
  std::string name;
  motion::Poses leader;
  motion::Poses follower;
};

// A pair a row, a time a column: `columns` moments from the first to the last frame, evenly spread.
std::string StripSvg(const motion::Skeleton& skeleton, const std::string& title,
                     const std::vector<PicturedPair>& pairs, double frame_rate_hz, int columns);

// A pair a panel, side by side, all moving at the true speed and over again: SMIL's <animate>, no
// script. Where nothing moves (print), the middle frame shows.
std::string MovingSvg(const motion::Skeleton& skeleton, const std::string& title,
                      const std::vector<PicturedPair>& pairs, double frame_rate_hz);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_POSE_PICTURE_H_
