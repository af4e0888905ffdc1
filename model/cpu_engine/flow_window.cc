#include "model/cpu_engine/flow_window.h"

#include <algorithm>
#include <cstddef>

namespace duet::cpu_engine {
namespace {

constexpr float kVelocityScale = 4;    // metres per frame are small numbers
constexpr float kPositionFrames = 20;  // one unit of a frame's distance from the window's ends

using Frame = absl::Span<const motion::Vec3>;

// Number of known frames of the follower.
int KnownFrames(const engine::NetworkInput& input) {
  if (!input.settled.empty()) return input.settled.frame_count();
  return input.start && !input.start->pose.empty() ? 1 : 0;
}

Frame KnownFrame(const engine::NetworkInput& input, int frame) {
  return input.settled.empty() ? Frame(input.start->pose) : input.settled[frame];
}

float* Write(const motion::Vec3& point, float* out) {
  *out++ = point.x;
  *out++ = point.y;
  *out++ = point.z;
  return out;
}

// Writes the root, the pose relative to the root, and two flags (root known, pose known).
void WriteStart(const engine::NetworkInput& input, int root, int count, float* out) {
  std::fill_n(out, count, 0.0f);
  const int known = KnownFrames(input);
  if (known == 0 && !input.start) return;
  out[count - 2] = 1;
  if (known == 0) {
    Write(input.start->root, out);
    return;
  }
  out[count - 1] = 1;
  const Frame pose = KnownFrame(input, known - 1);
  const motion::Vec3 place = pose[static_cast<std::size_t>(root)];
  out = Write(place, out);
  for (const motion::Vec3& joint : pose) out = Write(joint - place, out);
}

// The mean pose of the classes by their mean label weights, or of all classes alike with
// frame_labels; moved to the start root if given.
void WriteMeanPose(const checkpoint::Manifest& manifest, const std::vector<float>& base_poses,
                   const engine::NetworkInput& input, float* base) {
  const std::ptrdiff_t classes = manifest.model.class_count();
  const std::ptrdiff_t width = 3 * std::ptrdiff_t{manifest.model.skeleton.joint_count()};
  const std::ptrdiff_t frames = input.leader.frame_count();
  for (std::ptrdiff_t i = 0; i < width; ++i) {
    float mean = 0;
    for (std::ptrdiff_t c = 0; c < classes; ++c)
      mean += base_poses[static_cast<std::size_t>(c * width + i)];
    base[i] = mean / static_cast<float>(classes);
  }
  const bool weighted = !std::get<checkpoint::FlowArchitecture>(manifest.architecture).frame_labels;
  for (std::ptrdiff_t i = 0; weighted && i < width; ++i) {
    const float mean = base[i];
    for (std::ptrdiff_t c = 0; c < classes; ++c) {
      float weight = 0;
      for (std::ptrdiff_t t = 0; t < frames; ++t)
        weight += input.labels[static_cast<std::size_t>(t * classes + c)];
      base[i] += weight / static_cast<float>(frames) *
                 (base_poses[static_cast<std::size_t>(c * width + i)] - mean);
    }
  }
  if (!input.start) return;
  float* const root = base + 3 * std::ptrdiff_t{manifest.model.skeleton.root};
  float by[3];
  Write(input.start->root, by);
  for (int axis = 0; axis < 3; ++axis) by[axis] -= root[axis];
  for (std::ptrdiff_t i = 0; i < width; ++i) base[i] += by[i % 3];
}

// Writes leader, velocity, positions, known offsets, and the known flag: the features that every
// network reads.
void WriteFeatures(const engine::NetworkInput& input, int frame, int told, float scale,
                   const float* base, float* out) {
  const Frame leader = input.leader[frame];
  for (const motion::Vec3& joint : leader) out = Write(joint, out);
  for (std::size_t j = 0; j < leader.size(); ++j) {
    const motion::Vec3 moved = frame == 0 ? motion::Vec3{} : leader[j] - input.leader[frame - 1][j];
    out = Write(kVelocityScale * moved, out);
  }
  const float at = static_cast<float>(frame),
              length = static_cast<float>(input.leader.frame_count());
  *out++ = at / kPositionFrames;
  *out++ = at / length;
  *out++ = (length - at) / kPositionFrames;
  *out++ = length / kPositionFrames;
  if (frame >= told) {
    std::fill_n(out, 3 * leader.size() + 1, 0.0f);
    return;
  }
  const Frame known = KnownFrame(input, frame);
  float* const end = out + 3 * leader.size();
  for (const motion::Vec3& joint : known) out = Write(joint, out);
  for (float* value = end - 3 * leader.size(); value < end; ++value) {
    *value = (*value - *base++) / scale;
  }
  *end = 1;
}

}  // namespace

void FillFlowWindow(const checkpoint::Manifest& manifest, const std::vector<float>& base_poses,
                    const engine::NetworkInput& input, FlowWindow* window) {
  const motion::Skeleton& skeleton = manifest.model.skeleton;
  const auto& flow = std::get<checkpoint::FlowArchitecture>(manifest.architecture);
  const int width = 3 * skeleton.joint_count(), known = KnownFrames(input);
  window->frames = input.leader.frame_count();
  window->known_frames = std::min(known, window->frames);
  WriteStart(input, skeleton.root, checkpoint::StartFeatureCount(skeleton), window->start);
  if (known == 0) {
    WriteMeanPose(manifest, base_poses, input, window->base);
  } else {
    float* out = window->base;
    for (const motion::Vec3& joint : KnownFrame(input, known - 1)) out = Write(joint, out);
  }
  for (int t = 0; t < window->frames; ++t) {
    float* const features = window->features + std::ptrdiff_t{t} * window->stride;
    WriteFeatures(input, t, window->known_frames, static_cast<float>(flow.offset_scale),
                  window->base, features);
    if (flow.frame_labels) {
      const int classes = manifest.model.class_count();
      std::copy_n(input.labels.begin() + std::ptrdiff_t{t} * classes, classes,
                  features + 3 * width + checkpoint::kPositionFeatures + 1);
    }
    if (flow.hidden_frames) {
      features[window->stride - 1] = t >= window->frames - input.hidden_frames ? 1.0f : 0.0f;
    }
  }
}

int AddFlowTerms(const engine::NetworkInput& input, int window, int classes,
                 const checkpoint::FlowArchitecture& flow, Scratch::Use* scratch, FlowTerm* terms) {
  const int frames = input.leader.frame_count();
  if (flow.frame_labels) {
    terms[0] = {window, kNoClass, scratch->Take<float>(frames)};
    std::fill_n(terms[0].factor, frames, 1.0f);
    return 1;
  }
  const float times = static_cast<float>(flow.guidance);
  const auto weight = [&](int frame, int label) {
    const float raw =
        input.labels[static_cast<std::size_t>(frame) * static_cast<std::size_t>(classes) +
                     static_cast<std::size_t>(label)];
    return raw > 0 ? times * raw : raw;
  };
  int count = 0;
  for (int label = kNoClass; label < classes; ++label) {
    float* const factor = scratch->Take<float>(frames);
    bool counts = false;
    for (int t = 0; t < frames; ++t) {
      if (label != kNoClass) {
        factor[t] = weight(t, label);
      } else {
        float sum = 0;
        for (int k = 0; k < classes; ++k) sum += weight(t, k);
        factor[t] = 1 - sum;
      }
      counts = counts || factor[t] != 0;
    }
    if (counts) terms[count++] = {window, label, factor};
  }
  return count;
}

}  // namespace duet::cpu_engine
