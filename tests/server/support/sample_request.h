#ifndef DUET_TESTS_SERVER_SUPPORT_SAMPLE_REQUEST_H_
#define DUET_TESTS_SERVER_SUPPORT_SAMPLE_REQUEST_H_

#include <string>

#include "duet/v1/live.pb.h"
#include "duet/v1/synthesis.pb.h"

namespace duet::test {

// A request that the fake model accepts: so many frames of SwayingMotion at 15 Hz in metres, y up,
// joints in the model's order, kick = 1.
v1::SynthesizeRequest SampleRequest(int frames = 40);

// Adds a weight to a label vector.
void AddWeight(v1::LabelVector& label_vector, const std::string& interaction_class, float weight);

// The first message of a live session with the same format and labels. With `frames`, it resumes
// after so many frames of the leader and as many of the follower, which stands where the leader
// does.
v1::LiveStart SampleLiveStart(int frames = 0);

// Frames [first, first + count) of the same leader, at most 400, each captured one second after the
// frame before.
v1::LeaderFrames SampleLeaderFrames(int first, int count);

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_SAMPLE_REQUEST_H_
