#ifndef DUET_TESTS_SERVER_SUPPORT_SAMPLE_REQUEST_H_
#define DUET_TESTS_SERVER_SUPPORT_SAMPLE_REQUEST_H_

#include <string>

#include "duet/v1/synthesis.pb.h"

namespace duet::test {

// A request that the fake model accepts: so many frames of SwayingMotion at 15 Hz in metres, y up,
// joints in the model's order, kick = 1.
v1::SynthesizeRequest SampleRequest(int frames = 40);

// Adds a weight to a label vector.
void AddWeight(v1::LabelVector& label_vector, const std::string& interaction_class, float weight);

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_SAMPLE_REQUEST_H_
