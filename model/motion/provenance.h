#ifndef DUET_MODEL_MOTION_PROVENANCE_H_
#define DUET_MODEL_MOTION_PROVENANCE_H_

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace duet::motion {

// The model that synthesised a follower, and the request. Files hold it next to the motion if their
// format can.
struct Provenance {
  // The label vector at a frame. A constant label vector has one entry.
  struct Labels {
    int frame = 0;
    std::vector<std::pair<std::string, float>> weights;  // by class
  };
  std::string model;
  int model_version = 0;
  std::vector<Labels> labels;
  uint64_t seed = 0;
  float variety = 0;
  int candidates = 1;  // files hold it only if it is not 1
  bool cleaned_up = false;
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_PROVENANCE_H_
