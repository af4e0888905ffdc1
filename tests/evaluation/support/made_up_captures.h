#ifndef DUET_TESTS_EVALUATION_SUPPORT_MADE_UP_CAPTURES_H_
#define DUET_TESTS_EVALUATION_SUPPORT_MADE_UP_CAPTURES_H_

#include <array>
#include <vector>

#include "model/motion/vec3.h"
#include "tests/dataset/capture_folder.h"

namespace duet::test {

// The folders of the SBU classes that the data set keeps, kick to hug.
inline constexpr std::array<const char*, 6> kSbuClassFolders = {"03", "04", "05", "06", "07", "08"};

// A pose in metres, turned and moved, as SBU's files store it.
std::vector<motion::Vec3> AsCaptured(std::vector<motion::Vec3> pose, motion::Vec3 at,
                                     double yaw = 0);

// A clip of every class by each of two pairs of people who sway towards each other, s01s02 and
// s03s04. Each clip has a rhythm of its own.
void WriteSwayingCaptures(const dataset::CaptureFolder& folder);

}  // namespace duet::test

#endif  // DUET_TESTS_EVALUATION_SUPPORT_MADE_UP_CAPTURES_H_
