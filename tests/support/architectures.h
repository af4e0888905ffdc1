#ifndef DUET_TESTS_SUPPORT_ARCHITECTURES_H_
#define DUET_TESTS_SUPPORT_ARCHITECTURES_H_

#include <variant>

#include "model/checkpoint/manifest.h"

namespace duet::test {

// Requires a manifest of the paper's architecture.
inline checkpoint::PaperArchitecture& PaperOf(checkpoint::Manifest& manifest) {
  return std::get<checkpoint::PaperArchitecture>(manifest.architecture);
}

// Requires a manifest of the sampling architecture.
inline checkpoint::FlowArchitecture& FlowOf(checkpoint::Manifest& manifest) {
  return std::get<checkpoint::FlowArchitecture>(manifest.architecture);
}

// The paper's architecture with its published sizes.
inline checkpoint::PaperArchitecture PublishedPaper() {
  checkpoint::PaperArchitecture paper;
  paper.slice_features = 50;
  paper.encoder_hidden = 40;
  paper.attention = 128;
  return paper;
}

// A small sampling architecture with every number set.
inline checkpoint::FlowArchitecture SmallFlow() {
  checkpoint::FlowArchitecture flow;
  flow.width = 8;
  flow.blocks = 2;
  flow.heads = 2;
  flow.feed_forward = 12;
  flow.reach = 4;
  flow.offset_scale = 0.2;
  flow.noise = {4, 0.6, 8, 0.02};
  flow.steps = 3;
  flow.guidance = 1.5;
  flow.fade_frames = 5;
  return flow;
}

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_ARCHITECTURES_H_
