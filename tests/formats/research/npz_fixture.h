#ifndef DUET_TESTS_FORMATS_RESEARCH_NPZ_FIXTURE_H_
#define DUET_TESTS_FORMATS_RESEARCH_NPZ_FIXTURE_H_

#include <map>
#include <string>
#include <vector>

#include "model/formats/flat/npy_array.h"
#include "model/formats/research/placement.h"

namespace duet::test {

enum class Packed { kStored, kDeflated };

// A zip file with these members, named NAME.npy, as NumPy writes it.
std::string MakeNpz(const std::map<std::string, std::string>& arrays,
                    Packed packed = Packed::kDeflated);

// The arrays of a body model whose 22 vertices are its joints: a person in a T pose who faces z, y
// up, with the pelvis 0.1 m above the origin. The first of two shapes widens the hips by 0.1 m on
// each side, and the second raises the head by 1 m.
std::map<std::string, std::string> TinyBodyModel();
// Its joints at rest.
formats::research::BodyPose TinyBodyJoints();

// An array of NumPy in float32.
std::string Array(const std::vector<int>& shape, const std::vector<float>& values);

}  // namespace duet::test

#endif  // DUET_TESTS_FORMATS_RESEARCH_NPZ_FIXTURE_H_
