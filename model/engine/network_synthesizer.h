#ifndef DUET_MODEL_ENGINE_NETWORK_SYNTHESIZER_H_
#define DUET_MODEL_ENGINE_NETWORK_SYNTHESIZER_H_

#include <memory>

#include "model/cleanup/clean_up.h"
#include "model/engine/model_description.h"
#include "model/engine/network.h"
#include "model/engine/synthesizer.h"
#include "model/motion/standardise.h"

namespace duet::engine {

// What becomes of a network's answer before the caller gets it.
struct PipelineOptions {
  // A network works on positions, and the limbs of captured people change their lengths: give the
  // follower the limbs of its start, or else its leader's, in every frame. Off: the network's own
  // answer, for measuring the method.
  bool keep_limb_lengths = true;
  // A follower without a start is set, as a whole, on the leader's floor: both reach equally low.
  bool share_floor = true;
  // A follower is made to stand, keep its feet still and its joints within human ranges, and keep
  // out of the leader (model/cleanup), where its model is cleaned up by default. A window may say
  // otherwise.
  bool clean_up = true;
  cleanup::Options cleaning = {};
};

// A synthesizer around a network:
//   WindowStandardisation, Standardise, Network::Run, Standardisation::Invert, CheckFinite,
//   KeepLimbLengths, ShareFloor, CleanUp.
// `origin` is that of the standard coordinates which the network was trained in.
std::unique_ptr<Synthesizer> MakeSynthesizer(ModelDescription description,
                                             motion::StandardOrigin origin,
                                             std::unique_ptr<const Network> network,
                                             const PipelineOptions& options = {});

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_NETWORK_SYNTHESIZER_H_
