#ifndef DUET_MODEL_ENGINE_ASKED_TURNS_H_
#define DUET_MODEL_ENGINE_ASKED_TURNS_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "model/engine/model_description.h"
#include "model/engine/network.h"
#include "model/engine/synthesizer.h"
#include "model/engine/turned_range.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// Whether a label vector has a positive weight of a turn. Shapes: weights [classes].
bool AsksForTurn(const ModelDescription& description, const float* weights);

// The turns of the follower that the labels of a window ask for (a positive weight of one of
// ModelDescription::turning_classes) or avoid: a negative weight of such a class, or a positive
// weight of another class where those of turns are 0. Judged are the frames between the settled
// ones and the lookahead. Turns before them count as well, as far as the window knows them
// (SynthesisWindow::settled and turns_around): neither may a turn of another class grow unnoticed
// from one window to the next, nor is a turn asked for again that the follower has completed.
//
// A label asks for one turn in one direction or, if it is long, for several. A window that ends
// within a turn asks for that fraction of it; one that sees only the beginning asks for nothing.
class AskedTurns {
 public:
  AskedTurns(const ModelDescription& description, const SynthesisWindow& window);

  // How much the labels say about turns, 0 to 1: the mean size of the weights of turns or, if these
  // are all 0, of the other classes. 0 if they say nothing, or too little to be judged.
  double demand() const { return demand_; }

  // Whether labels ask for a turn that the follower did not complete before the window.
  bool asks() const;

  // How far a follower has turned, seen from the leader, in each frame but the first, up to the
  // lookahead. Degrees, not limited to whole turns. Shapes: follower as the window's leader;
  // returns [frames].
  std::vector<double> TurnsOf(const motion::Poses& leader, const motion::Poses& follower) const;

  // How far the largest rotation goes in each turn that is asked for, with what the follower turned
  // before the window: above 0 one way, below 0 the other. Shapes: returns [asked turns].
  std::vector<double> Asked(const std::vector<double>& turns) const;

  // How far a follower is from doing what the labels say: 0 if it does, at most demand() for a
  // follower that does not turn where it should, and more if it turns against the labels.
  // `ways`: for each turn that is asked for, the sign of the direction that counts fully, while the
  // other counts less. Empty, or 0: both directions count fully.
  double Miss(const std::vector<double>& turns, const std::vector<double>& ways = {}) const;

  // A miss of at most this is not worth more samples.
  double tolerated() const { return 0.1 * demand_; }

  // The number of samples that are drawn at most after the first: up to six, the more the labels
  // demand.
  int further_samples() const;
  // The fraction of them that such a window draws on average.
  double share_drawn() const;

 private:
  struct AskedTurn {
    int begin = 0, end = 0;  // its judged frames
    TurnedRange before;      // of its frames before these
    double share = 0;        // of the judged frames, times their weight
    double degrees = 0;      // that the follower has to turn by the end of the judged frames
  };
  struct JudgedFrames {
    int begin = 0, end = 0;
  };
  // Adds the turns that frames [begin, end) with the label of a turn ask for.
  void AddAsked(const SynthesisWindow& window, int begin, int end,
                const std::vector<double>& weights, JudgedFrames judged);
  TurnedRange RangeOf(const AskedTurn& turn, const std::vector<double>& turns) const;
  double MissOf(const AskedTurn& turn, const std::vector<double>& turns, double way) const;

  int root_ = 0;
  motion::JointPair hips_;
  double frames_per_turn_ = 0;
  std::vector<AskedTurn> asked_;
  // Of every frame but the first, up to the lookahead: where a negative weight of a turn or another
  // class avoids turns.
  std::vector<bool> avoided_, other_;
  double share_asked_ = 0, share_avoided_ = 0, share_other_ = 0;
  double demand_ = 0;
};

// The inputs of AskedTurns::further_samples() samples: with other seeds, with labels of turns that
// are enlarged, because the network gives them less weight than its leader, and with more noise, so
// that they differ more. Returns groups to draw one after the other until IsDecided. `input`: of
// the window's first sample.
std::vector<std::vector<NetworkInput>> DrawnAgain(const ModelDescription& description,
                                                  const AskedTurns& turns,
                                                  const SynthesisWindow& window,
                                                  const NetworkInput& input);

// Whether a window needs no more samples: at least one does what the labels say and, if they ask
// for turns, there are at least three samples that agree on the direction. The last group is not
// worth drawing if a sample does more than half of what the labels say.
// Shapes: samples, TurnsOf each.
bool IsDecided(const AskedTurns& turns, const std::vector<std::vector<double>>& samples);

// The index of the sample that best does what the labels say. Where they ask for turns, the
// direction in which the samples turn farther in total counts more: most of them follow the lead.
// Of those that do what the labels say, the one whose turns are nearest to those of the others is
// chosen.
// Shapes: samples, TurnsOf each.
std::size_t MostAsAsked(const AskedTurns& turns, const std::vector<std::vector<double>>& samples);

// The number of samples that a window is expected to cost: its candidates, and those that are drawn
// because they do not turn as the labels ask, times how often that happens.
double ExpectedSamples(const ModelDescription& description, const SynthesisWindow& window);

// Finds out from captured pairs of one class whether its followers turn about themselves, and how
// fast: seen from the leader, by more than half a turn and in one direction.
class TurningFit {
 public:
  // `skeleton` must outlive the fit.
  explicit TurningFit(const motion::Skeleton& skeleton) : skeleton_(skeleton) {}

  // Adds one stretch of the class: frames [begin, end) of a pair.
  void Add(const motion::Poses& leader, const motion::Poses& follower, int begin, int end);

  // The median speed. Absent for fewer than three stretches, if half of them turn by less than 230
  // degrees, or without hips.
  std::optional<double> DegreesPerSecond(double frame_rate_hz) const;

 private:
  const motion::Skeleton& skeleton_;
  std::vector<double> degrees_, per_frame_;  // of every stretch
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_ASKED_TURNS_H_
