#ifndef DUET_MODEL_ENGINE_FINISHING_H_
#define DUET_MODEL_ENGINE_FINISHING_H_

#include <vector>

#include "absl/status/status.h"
#include "model/cleanup/clean_up.h"
#include "model/cleanup/frame_turns.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/solver/girdles.h"

// Stages between a network's result in world coordinates and the caller. Metres, y up.
namespace duet::engine {

// Returns INTERNAL if a position is not finite.
absl::Status CheckFinite(const motion::Poses& follower);

// Sets the follower's limb lengths in every frame to those of its start's pose, or else to the
// leader's median lengths times ModelDescription::bone_ratios.
void KeepLimbLengths(const ModelDescription& description, const SynthesisWindow& window,
                     motion::Poses* follower);

// The widths of the follower's hips and shoulders: those of its start's pose, or else the leader's
// times ModelDescription::bone_ratios.
solver::GirdleWidths GirdleWidthsOf(const ModelDescription& description,
                                    const solver::Girdles& girdles, const SynthesisWindow& window);

// Moves a follower without a start vertically so that its lowest foot is as high as the leader's.
// Does nothing for a skeleton without feet.
void ShareFloor(const motion::Skeleton& skeleton, const SynthesisWindow& window,
                motion::Poses* follower);

// Replaces the frames of SynthesisWindow::sent, and lets the frames after them leave the last one's
// place and velocity as a critically damped spring does, with their own limb lengths.
void JoinSent(const ModelDescription& description, const SynthesisWindow& window,
              motion::Poses* follower);

// Returns how clean-up places the feet: from the frames that were sent on.
cleanup::Timing FeetTiming(const ModelDescription& description, const SynthesisWindow& window);

// Returns how far the bodies may overlap in each frame: the weight of the touching classes, 0 to 1.
// Shapes: returns [frames].
cleanup::Touch TouchOf(const ModelDescription& description, const SynthesisWindow& window);

// Returns how much the hands are to meet in each frame: the weight of the classes with a hand
// contact, 0 to 1, and their mean distance; and how much fists are to end near the body.
// Shapes: returns [frames].
cleanup::Meetings MeetingsOf(const ModelDescription& description, const SynthesisWindow& window);

// Returns `options` with the limits of a model: how long its followers keep poses.
cleanup::Options CleaningOf(const ModelDescription& description, cleanup::Options options);

// Returns how far the follower may be turned away from its leader in each frame, degrees: the mean
// of its classes by weight. Empty if the model has no class in which followers face their leaders.
// Shapes: returns [frames], or empty.
std::vector<float> MostAwayOf(const ModelDescription& description, const SynthesisWindow& window);

// Returns how fast shoulders, hips and limbs turn in frames that the caller gets. The trunk of a
// follower that turns when the labels ask for it is as fast as its dance.
cleanup::FrameTurnOptions FrameTurnsOf(const ModelDescription& description);

// Returns the number of the window's first frames that must not change: the settled frames, or the
// frame of the start.
int SettledFrames(const SynthesisWindow& window);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_FINISHING_H_
