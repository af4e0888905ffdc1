#ifndef DUET_MODEL_RETARGETING_MANNEQUIN_LOOK_H_
#define DUET_MODEL_RETARGETING_MANNEQUIN_LOOK_H_

#include <cmath>

namespace duet::retargeting {

// An sRGB colour, 0 to 255.
struct Colour {
  int red = 0, green = 0, blue = 0;
};

// The look of the mannequins in every file and on the page (client/viewer).
struct Look {
  Colour colour;
  double roughness = 0;
};
inline constexpr Look kLeaderLook = {{0xf0, 0xa0, 0x4b}, 0.62},
                      kFollowerLook = {{0x4f, 0xb3, 0xbf}, 0.62},
                      kVisorLook = {{0x1b, 0x1d, 0x22}, 0.25};

// Converts a channel of an sRGB colour to linear light, 0 to 1, as renderers need it.
inline double Linear(int channel) {
  const double share = channel / 255.0;
  return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_MANNEQUIN_LOOK_H_
