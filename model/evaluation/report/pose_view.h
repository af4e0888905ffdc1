#ifndef DUET_MODEL_EVALUATION_REPORT_POSE_VIEW_H_
#define DUET_MODEL_EVALUATION_REPORT_POSE_VIEW_H_

#include <string>
#include <vector>

#include "model/evaluation/report/pose_picture.h"

namespace duet::evaluation::report {

// A point of a picture, pixels, y down.
struct Pixel {
  double x = 0, y = 0;
};

// The camera of a picture: from the side of the line on which the first pair starts, such that its
// leader is on the left; every pair of the picture is seen from the same place.
class PoseView {
 public:
  PoseView(const motion::Skeleton& skeleton, const std::vector<PicturedPair>& pairs);

  // The place of a point; (0, 0) is the upper left corner of what is ever reached.
  Pixel At(motion::Vec3 world) const;
  double width() const { return width_; }
  double height() const { return height_; }

 private:
  Pixel Project(motion::Vec3 world) const;

  motion::Vec3 across_, away_;  // along the picture's width, and away from the viewer
  Pixel corner_;
  double width_ = 0, height_ = 0;
};

// What is drawn of a body, by side, as the content of path's d attributes. A head is a circle.
struct BodyPaths {
  std::string left, right, middle;
  std::string head;
};
BodyPaths DrawBody(const motion::Skeleton& skeleton, const PoseView& view,
                   absl::Span<const motion::Vec3> pose, Pixel offset);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_POSE_VIEW_H_
