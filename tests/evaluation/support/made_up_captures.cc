#include "tests/evaluation/support/made_up_captures.h"

#include <string>

#include "model/motion/coordinates.h"
#include "tests/support/sample_motion.h"

namespace duet::test {
namespace {

std::string SwayingCapture(double rhythm) {
  std::string text;
  for (int t = 0; t < 24; ++t) {
    const double seconds = rhythm * t / 15;
    text += dataset::CaptureLine(t + 1, AsCaptured(SwayingPose(seconds), {-1, 0, 0}, 1.6),
                                 AsCaptured(SwayingPose(2 * seconds), {1, 0, 1}, -1.6));
  }
  return text;
}

}  // namespace

std::vector<motion::Vec3> AsCaptured(std::vector<motion::Vec3> pose, motion::Vec3 at, double yaw) {
  for (motion::Vec3& p : pose) {
    p = FromWorld({motion::LengthUnit::kSbuNormalised, motion::UpAxis::kYDown},
                  RotateY(p, yaw) + at);
  }
  return pose;
}

void WriteSwayingCaptures(const dataset::CaptureFolder& folder) {
  double rhythm = 1;
  for (const char* people : {"s01s02", "s03s04"}) {
    for (const char* interaction_class : kSbuClassFolders) {
      folder.Write(std::string(people) + "/" + interaction_class + "/001/skeleton_pos.txt",
                   SwayingCapture(rhythm += 0.1));
    }
  }
}

}  // namespace duet::test
