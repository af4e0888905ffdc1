#ifndef DUET_MODEL_MOTION_PROVENANCE_H_
#define DUET_MODEL_MOTION_PROVENANCE_H_

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace duet::motion {

// Who made a follower, and what was asked for: what a file has to say beside the motion, where its
// format has a place for it.
struct Provenance {
  // The label vector at a frame; one keyframe where it does not change.
  struct Labels {
    int frame = 0;
    std::vector<std::pair<std::string, float>> weights;  // by class
  };
  std::string model;
  int model_version = 0;
  std::vector<Labels> labels;
  uint64_t seed = 0;
  float variety = 0;
  bool cleaned_up = false;
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_PROVENANCE_H_
