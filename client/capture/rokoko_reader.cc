#include "client/capture/rokoko_reader.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/capture/lz4_frame.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"

namespace duet::client::capture {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 12;
constexpr char kHint[] = "; in Rokoko Studio, select the format JSON v3";

// The field of an object; null if `value` is no object or has no such field.
const json* Field(const json* value, const char* key) {
  if (value == nullptr || !value->is_object()) return nullptr;
  const auto found = value->find(key);
  return found == value->end() ? nullptr : &*found;
}

absl::StatusOr<motion::Vec3> ReadPosition(const json& body, const std::string& joint) {
  const json* position = Field(Field(&body, joint.c_str()), "position");
  float values[3] = {};
  int i = 0;
  for (const char* axis : {"x", "y", "z"}) {
    const json* value = Field(position, axis);
    if (value == nullptr || !value->is_number() ||
        !(std::abs(value->get<double>()) <= double{kMaxCapturePosition})) {
      return absl::InvalidArgumentError(
          absl::StrCat("Rokoko: body.", joint, ".position.", axis, ": expected a number within ",
                       static_cast<int>(kMaxCapturePosition), " m, got ",
                       value == nullptr ? "none" : base::Shown(*value)));
    }
    values[i++] = value->get<float>();
  }
  return motion::Vec3{-values[0], values[1], values[2]};
}

std::string NameOf(const json& actor) {
  const json* name = Field(&actor, "name");
  return name != nullptr && name->is_string() ? name->get<std::string>() : "";
}

// The body of an actor; null if it has none.
const json* BodyOf(const json& actor) {
  const json* has_body = Field(Field(&actor, "meta"), "hasBody");
  if (has_body != nullptr && has_body->is_boolean() && !has_body->get<bool>()) return nullptr;
  const json* body = Field(&actor, "body");
  return body != nullptr && body->is_object() ? body : nullptr;
}

std::optional<double> TimeOf(const json& scene) {
  const json* timestamp = Field(&scene, "timestamp");
  if (timestamp == nullptr || !timestamp->is_number()) return std::nullopt;
  const double seconds = timestamp->get<double>();
  return std::abs(seconds) <= kMaxSenderSeconds ? std::make_optional(seconds) : std::nullopt;
}

}  // namespace

RokokoReader::RokokoReader()
    : names_({"hip",           "spine",         "chest",        "neck",      "head",
              "leftShoulder",  "leftUpperArm",  "leftLowerArm", "leftHand",  "rightShoulder",
              "rightUpperArm", "rightLowerArm", "rightHand",    "leftUpLeg", "leftLeg",
              "leftFoot",      "leftToe",       "rightUpLeg",   "rightLeg",  "rightFoot",
              "rightToe"}) {}

absl::Status RokokoReader::Read(absl::string_view datagram, std::vector<CaptureFrame>* frames) {
  std::string text;
  if (IsLz4Frame(datagram)) {
    absl::StatusOr<std::string> decompressed = DecompressLz4Frame(datagram, kMaxJsonBytes);
    if (!decompressed.ok()) return decompressed.status();
    text = *std::move(decompressed);
  } else {
    text = std::string(datagram);
  }
  const absl::StatusOr<json> document = base::ParseStrictJson(text, kMaxDepth);
  if (!document.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("Rokoko: ", document.status().message(), kHint));
  }
  const json* scene = Field(&*document, "scene");
  const json* actors = Field(scene, "actors");
  if (actors == nullptr || !actors->is_array()) {
    return absl::InvalidArgumentError(
        absl::StrCat("Rokoko: scene.actors: expected a list, got ",
                     actors == nullptr ? "none" : base::Shown(*actors), kHint));
  }
  for (const json& actor : *actors) {
    const json* body = BodyOf(actor);
    if (body == nullptr) continue;
    const std::string name = NameOf(actor);
    if (!actor_.empty() && name != actor_) {
      if (!std::exchange(others_, true)) {
        notes_.push_back(absl::StrCat("Rokoko: ", base::Quoted(actor_),
                                      " leads; the other actors of the scene are ignored"));
      }
      continue;
    }
    CaptureFrame frame;
    frame.sender_seconds = TimeOf(*scene);
    for (const std::string& joint : names_) {
      const bool at_the_foot =
          absl::EndsWith(joint, "Toe") && Field(body, joint.c_str()) == nullptr;
      if (at_the_foot && !std::exchange(no_toes_, true)) {
        notes_.emplace_back("Rokoko: the actor has no toes; they are placed at the feet");
      }
      if (at_the_foot) {
        frame.positions.push_back(frame.positions.back());  // the foot is before its toe
        continue;
      }
      const absl::StatusOr<motion::Vec3> position = ReadPosition(*body, joint);
      if (!position.ok()) return position.status();
      frame.positions.push_back(*position);
    }
    if (actor_.empty()) actor_ = name;
    frames->push_back(std::move(frame));
    return absl::OkStatus();
  }
  return absl::OkStatus();
}

std::string RokokoReader::Missing() const {
  return "Rokoko: expected an actor with a body, got none";
}

std::vector<std::string> RokokoReader::TakeNotes() { return std::exchange(notes_, {}); }

}  // namespace duet::client::capture
