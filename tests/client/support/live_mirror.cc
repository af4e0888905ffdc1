#include "tests/client/support/live_mirror.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace duet::test {
namespace {

using Pose = std::vector<float>;

float HugOf(const v1::LabelVector& labels) {
  for (const v1::ClassWeight& weight : labels.weights()) {
    if (weight.interaction_class() == "hug") return weight.weight();
  }
  return 0;
}

// One stream of a session.
class MirrorStream {
 public:
  MirrorStream(LiveServerStream* stream, const v1::LiveStart& start)
      : stream_(stream), width_(static_cast<size_t>(start.leader().joint_names_size()) * 3) {
    delay_ = static_cast<int>(start.delay_frames());
    rotations_ = start.reply_rotations();
    if (start.has_label_vector()) hug_[0] = HugOf(start.label_vector());
    for (const v1::LabelKeyframe& key : start.label_keyframes()) {
      hug_[static_cast<int>(key.frame())] = HugOf(key.label_vector());
    }
    first_ = static_cast<int>(start.history().first_frame());
    next_ = first_ + static_cast<int>(start.history().follower_frame_count());
    AddLeaders(start.leader().positions());
    if (next_ > first_) {
      // As a model does, the mirror goes on from its own frames: an offset that it derives from the
      // last follower and leader frames of the history.
      const size_t last = static_cast<size_t>(next_ - 1 - first_);
      offset_ =
          start.history().follower_positions(static_cast<int>(last * width_)) - leaders_[last][0];
    }
  }

  int next() const { return next_; }
  int end() const { return first_ + static_cast<int>(leaders_.size()); }
  int last_due() const { return end() - delay_; }

  void Add(const v1::LeaderFrames& frames) {
    const int count = static_cast<int>(frames.frame_count());
    const int first = static_cast<int>(frames.first_frame());
    capture_seconds_ = frames.capture_seconds();
    if (const int late = std::min(count, end() - first); late > 0) {
      Notify(v1::LIVE_NOTICE_KIND_LATE, first, late);
    }
    if (const int missing = first - end(); missing > 0) {
      Notify(v1::LIVE_NOTICE_KIND_GAP_FILLED, end(), missing);
      const Pose before = leaders_.back();
      for (int i = 1; i <= missing; ++i) {
        Pose pose(width_);
        const float share = static_cast<float>(i) / static_cast<float>(missing + 1);
        for (size_t k = 0; k < width_; ++k) {
          pose[k] = before[k] + (frames.positions(static_cast<int>(k)) - before[k]) * share;
        }
        leaders_.push_back(std::move(pose));
      }
    }
    const int known = std::max(0, end() - first);
    for (int i = known; i < count; ++i) {
      const float* begin = frames.positions().data() + static_cast<size_t>(i) * width_;
      leaders_.emplace_back(begin, begin + width_);
    }
  }

  void Change(const v1::LabelChange& change) {
    const int frame = static_cast<int>(change.frame());
    const float before = HugAt(frame);
    const int ease = static_cast<int>(change.ease_frames());
    hug_.erase(hug_.upper_bound(frame), hug_.end());
    if (ease > 0) {
      hug_[frame] = before;
    } else if (frame > 0) {
      hug_[frame - 1] = HugAt(frame - 1);
    }
    hug_[frame + ease] = HugOf(change.label_vector());
  }

  void Answer() {
    v1::SynthesizeLiveResponse response;
    v1::FollowerFrames* frames = response.mutable_frames();
    frames->set_first_frame(static_cast<uint32_t>(next_));
    frames->set_frame_count(1);
    const Pose& leader = leaders_[static_cast<size_t>(next_ - first_)];
    for (size_t k = 0; k < width_; ++k) {
      const float moved = k % 3 == 0 ? offset_ : k % 3 == 1 ? HugAt(next_) : 0;
      frames->add_positions(leader[k] + moved);
    }
    if (rotations_) AddRotations(frames);
    frames->set_leader_frame(static_cast<uint32_t>(end() - 1));
    frames->set_capture_seconds(capture_seconds_);
    frames->set_server_seconds(0.001F);
    ++next_;
    ++answered_;
    stream_->Write(response);
  }

  void Notify(v1::LiveNoticeKind kind, int first, int count) {
    v1::SynthesizeLiveResponse response;
    response.mutable_notice()->set_kind(kind);
    response.mutable_notice()->mutable_frames()->set_first_frame(static_cast<uint32_t>(first));
    response.mutable_notice()->mutable_frames()->set_frame_count(static_cast<uint32_t>(count));
    stream_->Write(response);
  }

  void Summarize() {
    v1::SynthesizeLiveResponse response;
    response.mutable_summary()->set_frame_count(static_cast<uint32_t>(answered_));
    stream_->Write(response);
  }

 private:
  void AddLeaders(const google::protobuf::RepeatedField<float>& positions) {
    for (size_t i = 0; i + width_ <= static_cast<size_t>(positions.size()); i += width_) {
      leaders_.emplace_back(positions.data() + i, positions.data() + i + width_);
    }
  }

  void AddRotations(v1::FollowerFrames* frames) const {
    if (answered_ == 0) {
      v1::RigJoint* joint = frames->add_rig();
      joint->set_name("root");
      joint->set_parent(-1);
    }
    const float half = 0.25F * static_cast<float>(next_);
    const float sign = std::cos(half) < 0 ? -1 : 1;  // so that w is not negative
    for (const float value : {sign * std::sin(half), 0.0F, 0.0F, sign * std::cos(half)}) {
      frames->add_rotations(value);
    }
  }

  float HugAt(int frame) const {
    const auto after = hug_.upper_bound(frame);
    if (after == hug_.end()) return hug_.empty() ? 0 : hug_.rbegin()->second;
    if (after == hug_.begin()) return after->second;
    const auto before = std::prev(after);
    const float share = static_cast<float>(frame - before->first) /
                        static_cast<float>(after->first - before->first);
    return before->second + (after->second - before->second) * share;
  }

  LiveServerStream* stream_;
  const size_t width_;
  int delay_ = 0;
  bool rotations_ = false;
  std::map<int, float> hug_;
  std::vector<Pose> leaders_;  // from first_ on
  int first_ = 0, next_ = 0, answered_ = 0;
  float offset_ = 1;
  double capture_seconds_ = 0;
};

v1::SynthesizeLiveResponse HeaderFor(const v1::LiveStart& start, const LiveMirror& mirror,
                                     int first_frame) {
  v1::SynthesizeLiveResponse response;
  v1::LiveHeader* header = response.mutable_header();
  header->set_model_name(mirror.model_name);
  header->set_model_version(3);
  *header->mutable_joint_names() = start.leader().joint_names();
  header->set_frame_rate_hz(start.leader().frame_rate_hz());
  header->set_unit(v1::LENGTH_UNIT_METRES);
  header->set_up_axis(v1::UP_AXIS_Y_UP);
  header->add_interaction_classes("hug");
  header->set_seed(start.seed());
  header->set_clean_up(v1::CLEAN_UP_ON);
  header->set_candidates(start.candidates());
  header->set_delay_frames(start.delay_frames());
  header->set_first_frame(static_cast<uint32_t>(first_frame));
  header->set_history_frames(static_cast<uint32_t>(mirror.history_frames));
  return response;
}

}  // namespace

grpc::Status LiveMirror::Run(grpc::ServerContext* /*context*/, LiveServerStream* stream) {
  v1::SynthesizeLiveRequest request;
  if (!stream->Read(&request) || !request.has_start()) {
    return {grpc::StatusCode::INVALID_ARGUMENT, "expected a start"};
  }
  int number = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    number = static_cast<int>(starts_.size());
    starts_.push_back(request.start());
  }
  MirrorStream mirror(stream, request.start());
  if (before_frame) {
    const grpc::Status status = before_frame(number, -1);  // before the header
    if (!status.ok()) return status;
  }
  stream->Write(HeaderFor(request.start(), *this, mirror.next()));
  for (bool open = true, begun = false; open; begun = true) {
    // The start may have frames that are due.
    const bool read = begun || mirror.next() >= mirror.last_due();
    open = !read || stream->Read(&request);
    if (open && read && request.has_label_change()) mirror.Change(request.label_change());
    if (open && read && request.has_frames()) {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++messages_;
      mirror.Add(request.frames());
    }
    // At the end of the leader's motion, all its frames are answered.
    while (mirror.next() < (open ? mirror.last_due() : mirror.end())) {
      if (before_frame) {
        const grpc::Status status = before_frame(number, mirror.next());
        if (!status.ok()) return status;
      }
      if (drains && drains(number, mirror.next())) {
        mirror.Notify(v1::LIVE_NOTICE_KIND_DRAINING, 0, 0);
      }
      mirror.Answer();
    }
  }
  mirror.Summarize();
  return grpc::Status::OK;
}

std::vector<v1::LiveStart> LiveMirror::starts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return starts_;
}

int LiveMirror::messages() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return messages_;
}

}  // namespace duet::test
