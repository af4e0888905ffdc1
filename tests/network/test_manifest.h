#ifndef DUET_TESTS_NETWORK_TEST_MANIFEST_H_
#define DUET_TESTS_NETWORK_TEST_MANIFEST_H_

#include <string>

#include "model/checkpoint/manifest.h"
#include "tests/support/architectures.h"

namespace duet::network {

// The SBU skeleton with a network small enough for gradient checks.
inline checkpoint::Manifest SmallManifest(bool follower_start = true) {
  checkpoint::Manifest manifest;
  manifest.model.name = "small";
  manifest.model.version = 1;
  manifest.model.skeleton = motion::SbuSkeleton();
  manifest.model.classes = {"kick", "push", "hug"};
  manifest.model.frame_rate_hz = 15;
  manifest.model.window_frames = 12;
  manifest.model.accepts_follower_start = follower_start;
  manifest.parts = motion::SbuParts();
  test::PaperOf(manifest).follower_start = follower_start;
  test::PaperOf(manifest).slice_features = 5;
  test::PaperOf(manifest).encoder_hidden = 4;
  test::PaperOf(manifest).attention = 6;
  return manifest;
}

}  // namespace duet::network

#endif  // DUET_TESTS_NETWORK_TEST_MANIFEST_H_
