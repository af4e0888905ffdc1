#include "model/cpu_engine/flow_network.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "model/base/angle.h"
#include "model/checkpoint/architecture.h"
#include "model/cpu_engine/kernels/transformer.h"

namespace duet::cpu_engine {
namespace {

using kernels::Precision;

using base::kPi;
constexpr double kHighestFrequency = 200;  // of the sines of the time

// [kTimeFeatures] sines, then cosines.
void WriteTimeFeatures(double time, float* out) {
  constexpr int kFrequencies = checkpoint::kTimeFeatures / 2;
  for (int i = 0; i < kFrequencies; ++i) {
    const double angle = time * std::exp(i * std::log(kHighestFrequency) / (kFrequencies - 1));
    out[i] = static_cast<float>(std::sin(angle));
    out[kFrequencies + i] = static_cast<float>(std::cos(angle));
  }
}

void Add(std::ptrdiff_t count, const float* from, float* to) {
  for (std::ptrdiff_t i = 0; i < count; ++i) to[i] += from[i];
}

// 1 in the last known frame, falling to 0 along half a cosine; 0 without known frames.
float Fade(int frame, int known_frames, int fade_frames) {
  if (known_frames == 0) return 0;
  const int since = std::clamp(frame - known_frames + 1, 0, fade_frames + 1);
  return static_cast<float>(0.5 + 0.5 * std::cos(since * kPi / (fade_frames + 1)));
}

}  // namespace

FlowNetwork::FlowNetwork(const checkpoint::Checkpoint& checkpoint, Precision precision)
    : manifest_(checkpoint.manifest),
      flow_(std::get<checkpoint::FlowArchitecture>(manifest_.architecture)),
      width_(flow_.width),
      pose_(3 * manifest_.model.skeleton.joint_count()),
      heads_(flow_.heads),
      base_poses_(Weights(checkpoint).Values("base.poses")),
      noise_(flow_.noise, Weights(checkpoint).Values("noise.roots"), pose_,
             manifest_.model.window_frames) {
  const Weights weights(checkpoint);
  const auto layer = [&](const std::string& name, Precision as) {
    return weights.FindLayer(name).Pack(as);
  };
  // A row of inputs has large and small values (positions, velocities) whose errors pass through
  // all blocks: few products, so they stay exact.
  frames_ = layer("frames", Precision::kFloat32);
  sample_ = weights.FindLayer("sample.weight", "").Pack(Precision::kFloat32);
  start_ = layer("start", Precision::kFloat32);
  if (!flow_.frame_labels) label_ = weights.FindLayer("label.weight", "");
  time_expand_ = layer("time.expand", precision);
  time_mix_ = layer("time.mix", precision);
  condition_ = layer("condition", precision);
  norm_ = {weights.Values("norm.weight"), weights.Values("norm.bias"), width_, 1};
  output_ = layer("output", precision);
  for (int i = 0; i < flow_.blocks; ++i) {
    const std::string block = absl::StrCat("block", i, ".");
    blocks_.push_back({layer(block + "modulation", precision),
                       layer(block + "attention", precision), layer(block + "attended", precision),
                       layer(block + "expand", precision), layer(block + "contract", precision),
                       weights.Values(block + "distance")});
  }
}

void FlowNetwork::Run(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch,
                      absl::Span<motion::Poses> followers) const {
  const Work work = Prepare(inputs, scratch);
  const int steps = flow_.steps;
  for (int step = 0; step < steps; ++step) {
    if (!Answer(work, inputs, static_cast<double>(step) / steps)) return;
    // The last step ends exactly at the answer.
    if (step + 1 < steps) Step(work, steps - step);
  }
  Join(work, followers);
}

FlowNetwork::Work FlowNetwork::Prepare(absl::Span<const engine::NetworkInput> inputs,
                                       Scratch::Use* scratch) const {
  Work work{};
  ReadWindows(inputs, scratch, &work);
  ReadTerms(inputs, scratch, &work);
  const std::ptrdiff_t rows = work.rows, terms = work.terms, term_rows = work.term_rows;
  work.sample = scratch->Take<float>(rows * pose_);
  work.answer = scratch->Take<float>(rows * pose_);
  for (int n = 0; n < work.windows; ++n) {
    noise_.Fill(inputs[static_cast<std::size_t>(n)].sampling, work.window[n].known_frames,
                work.window[n].frames, scratch,
                work.sample + std::ptrdiff_t{work.window_row[n]} * pose_);
  }
  work.condition = scratch->Take<float>(terms * width_);
  work.time = scratch->Take<float>(width_);
  work.modulation = scratch->Take<float>(terms * 4 * width_);
  work.frames = scratch->Take<float>(term_rows * width_);
  work.normal = scratch->Take<float>(term_rows * width_);
  // Queries, keys and values; the hidden layer; the answer.
  work.branch = scratch->Take<float>(
      term_rows * std::max<std::ptrdiff_t>({3 * width_, flow_.feed_forward, pose_}));
  work.distance = scratch->Take<float>(std::ptrdiff_t{heads_} * (2 * work.longest - 1));
  work.attention =
      scratch->Take<float>(kernels::SelfAttentionScratch(work.longest, width_ / heads_));
  return work;
}

void FlowNetwork::ReadWindows(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch,
                              Work* work) const {
  work->windows = static_cast<int>(inputs.size());
  work->window = scratch->Take<FlowWindow>(work->windows);
  work->window_row = scratch->Take<int>(work->windows);
  for (int n = 0; n < work->windows; ++n) {
    const int frames = inputs[static_cast<std::size_t>(n)].leader.frame_count();
    work->window_row[n] = work->rows;
    work->rows += frames;
    work->longest = std::max(work->longest, frames);
  }
  const std::ptrdiff_t features = frames_.inputs();
  float* const rows = scratch->Take<float>(work->rows * features);
  float* const starts = scratch->Take<float>(std::ptrdiff_t{work->windows} * start_.inputs());
  float* const bases = scratch->Take<float>(std::ptrdiff_t{work->windows} * pose_);
  for (std::ptrdiff_t n = 0; n < work->windows; ++n) {
    work->window[n] = {0,
                       0,
                       static_cast<int>(features),
                       rows + work->window_row[n] * features,
                       starts + n * start_.inputs(),
                       bases + n * pose_};
    FillFlowWindow(manifest_, base_poses_, inputs[static_cast<std::size_t>(n)], &work->window[n]);
  }
  work->context = scratch->Take<float>(std::ptrdiff_t{work->rows} * width_);
  frames_.Multiply(work->rows, rows, work->context);
}

void FlowNetwork::ReadTerms(absl::Span<const engine::NetworkInput> inputs, Scratch::Use* scratch,
                            Work* work) const {
  const int classes = manifest_.model.class_count();
  work->term = scratch->Take<FlowTerm>(std::ptrdiff_t{work->windows} * (classes + 1));
  for (int n = 0; n < work->windows; ++n) {
    work->terms += AddFlowTerms(inputs[static_cast<std::size_t>(n)], n, classes, flow_, scratch,
                                work->term + work->terms);
  }
  work->term_row = scratch->Take<int>(work->terms);
  work->told = scratch->Take<float>(std::ptrdiff_t{work->terms} * width_);
  for (int q = 0; q < work->terms; ++q) {
    const FlowTerm& term = work->term[q];
    work->term_row[q] = work->term_rows;
    work->term_rows += work->window[term.window].frames;
    float* const told = work->told + std::ptrdiff_t{q} * width_;
    start_.Multiply(1, work->window[term.window].start, told);
    if (term.label == kNoClass) continue;
    for (int i = 0; i < width_; ++i) {
      told[i] += label_.weight[static_cast<std::size_t>(i * classes + term.label)];
    }
  }
}

// Writes the guided answer to the sample at a time to work.answer. Returns false if all windows
// were cancelled before it was complete.
bool FlowNetwork::Answer(const Work& work, absl::Span<const engine::NetworkInput> inputs,
                         double time) const {
  Condition(work, time);
  Embed(work);
  for (const Block& block : blocks_) {
    if (engine::AllCancelled(inputs)) return false;
    Apply(block, work);
  }
  Output(work);
  return true;
}

void FlowNetwork::Condition(const Work& work, double time) const {
  float features[checkpoint::kTimeFeatures];
  WriteTimeFeatures(time, features);
  float* const expanded = work.condition;  // free until the end of this function
  time_expand_.Multiply(1, features, expanded);
  kernels::Silu(width_, expanded);
  time_mix_.Multiply(1, expanded, work.time);
  float* const told = work.modulation;  // free until the first block
  for (std::ptrdiff_t q = 0; q < work.terms; ++q) {
    std::copy_n(work.told + q * width_, width_, told + q * width_);
    Add(width_, work.time, told + q * width_);
  }
  condition_.Multiply(work.terms, told, work.condition);
  kernels::Silu(std::ptrdiff_t{work.terms} * width_, work.condition);
}

void FlowNetwork::Embed(const Work& work) const {
  float* const embedded = work.normal;  // [R, W]: free until the first block
  sample_.Multiply(work.rows, work.sample, embedded);
  Add(std::ptrdiff_t{work.rows} * width_, work.context, embedded);
  for (std::ptrdiff_t q = 0; q < work.terms; ++q) {
    const int window = work.term[q].window;
    const float* from = embedded + std::ptrdiff_t{work.window_row[window]} * width_;
    float* to = work.frames + std::ptrdiff_t{work.term_row[q]} * width_;
    for (int t = 0; t < work.window[window].frames; ++t, from += width_, to += width_) {
      std::copy_n(from, width_, to);
      Add(width_, work.condition + q * width_, to);
    }
  }
}

void FlowNetwork::Apply(const Block& block, const Work& work) const {
  const std::ptrdiff_t values = std::ptrdiff_t{work.term_rows} * width_;
  block.modulation.Multiply(work.terms, work.condition, work.modulation);
  Normalise(work, 0);
  block.attention.Multiply(work.term_rows, work.normal, work.branch);
  Attend(block, work);
  block.attended.Multiply(work.term_rows, work.normal, work.branch);
  Add(values, work.branch, work.frames);
  Normalise(work, 2);
  block.expand.Multiply(work.term_rows, work.normal, work.branch);
  kernels::Gelu(std::ptrdiff_t{work.term_rows} * flow_.feed_forward, work.branch);
  block.contract.Multiply(work.term_rows, work.branch, work.normal);
  Add(values, work.normal, work.frames);
}

// work.normal = work.frames, normalised by the modulations `scale` and the one after it.
void FlowNetwork::Normalise(const Work& work, int scale) const {
  for (std::ptrdiff_t q = 0; q < work.terms; ++q) {
    const float* const by = work.modulation + (q * 4 + scale) * width_;
    const int frames = work.window[work.term[q].window].frames;
    for (std::ptrdiff_t row = work.term_row[q]; row < work.term_row[q] + frames; ++row) {
      kernels::LayerNorm(
          {width_, work.frames + row * width_, by, 1, by + width_, work.normal + row * width_});
    }
  }
}

// Attention from work.branch (queries, keys and values of every frame) to work.normal.
void FlowNetwork::Attend(const Block& block, const Work& work) const {
  const int size = width_ / heads_, reach = flow_.reach, longest = work.longest;
  for (int h = 0; h < heads_; ++h) {
    for (int d = 1 - longest; d < longest; ++d) {
      work.distance[h * (2 * longest - 1) + d + longest - 1] =
          block.distance[static_cast<std::size_t>(h * (2 * reach + 1) +
                                                  std::clamp(d, -reach, reach) + reach)];
    }
  }
  for (int q = 0; q < work.terms; ++q) {
    const int frames = work.window[work.term[q].window].frames;
    const float* const all = work.branch + std::ptrdiff_t{work.term_row[q]} * 3 * width_;
    float* const out = work.normal + std::ptrdiff_t{work.term_row[q]} * width_;
    for (int h = 0; h < heads_; ++h) {
      const float* const head = all + std::ptrdiff_t{h} * size;
      const float* const distance = work.distance + h * (2 * longest - 1) + longest - frames;
      kernels::AttendToSelf({frames, size, head, head + width_, head + 2 * width_, 3 * width_,
                             distance, out + std::ptrdiff_t{h} * size, width_, work.attention});
    }
  }
}

void FlowNetwork::Output(const Work& work) const {
  for (std::ptrdiff_t row = 0; row < work.term_rows; ++row) {
    kernels::LayerNorm({width_, work.frames + row * width_, norm_.weight.data(), 0,
                        norm_.bias.data(), work.normal + row * width_});
  }
  output_.Multiply(work.term_rows, work.normal, work.branch);
  std::fill_n(work.answer, std::ptrdiff_t{work.rows} * pose_, 0.0f);
  for (int q = 0; q < work.terms; ++q) {
    const FlowTerm& term = work.term[q];
    const float* from = work.branch + std::ptrdiff_t{work.term_row[q]} * pose_;
    float* to = work.answer + std::ptrdiff_t{work.window_row[term.window]} * pose_;
    for (int t = 0; t < work.window[term.window].frames; ++t, from += pose_, to += pose_) {
      for (int i = 0; i < pose_; ++i) to[i] += term.factor[t] * from[i];
    }
  }
}

// An Euler step: 1 / left of the way to the answer, or to the known value in known frames.
void FlowNetwork::Step(const Work& work, int left) const {
  for (int n = 0; n < work.windows; ++n) {
    const FlowWindow& window = work.window[n];
    for (int t = 0; t < window.frames; ++t) {
      const std::ptrdiff_t row = work.window_row[n] + t;
      const float* const to =
          t < window.known_frames ? window.known(t, pose_) : work.answer + row * pose_;
      float* const sample = work.sample + row * pose_;
      for (int i = 0; i < pose_; ++i) sample[i] += (to[i] - sample[i]) / static_cast<float>(left);
    }
  }
}

// Writes the answer in metres. Known frames are exact. The frames after them are shifted to
// continue from the last known frame, which has offset 0 from the base.
void FlowNetwork::Join(const Work& work, absl::Span<motion::Poses> followers) const {
  const float scale = static_cast<float>(flow_.offset_scale);
  for (int n = 0; n < work.windows; ++n) {
    const FlowWindow& window = work.window[n];
    const float* const answer = work.answer + std::ptrdiff_t{work.window_row[n]} * pose_;
    const float* const last = answer + std::ptrdiff_t{std::max(window.known_frames - 1, 0)} * pose_;
    float* out = &followers[static_cast<std::size_t>(n)].all().front().x;
    for (int t = 0; t < window.frames; ++t) {
      const float fade = Fade(t, window.known_frames, flow_.fade_frames);
      const bool known = t < window.known_frames;
      for (int i = 0; i < pose_; ++i) {
        const float offset = known ? window.known(t, pose_)[i]
                                   : answer[std::ptrdiff_t{t} * pose_ + i] - fade * last[i];
        *out++ = window.base[i] + scale * offset;
      }
    }
  }
}

}  // namespace duet::cpu_engine
