#include "client/cli/help_topics.h"

#include <map>

#include "absl/strings/str_join.h"

namespace duet::client::cli {
namespace {

const std::map<std::string, std::string>& Topics() {
  static const auto& topics = *new std::map<std::string, std::string>{
      {"exit-codes", R"(The exit codes of the program.

  0   done
  1   failed, but the same call may succeed later (server away, busy or draining; a full disk)
  2   the command line or a setting is invalid
  42  failed, and will fail again: the input, the model or the credentials are rejected
)"},
      {"formats", R"(The motion files that Duet reads and writes.

  extension    read                  written              holds
  .gltf .glb   yes                   yes                  animated skeletons
  .bvh         yes                   one per person       joint angles, one length per bone
  .csv         yes                   yes                  positions of one or two people
  .json        yes                   yes                  positions of one or two people
  .npy         with --frame-rate     yes                  positions of one or two people
  .txt         yes                   of two people        SBU text: positions of two people

The extension decides the format. --input-format sets it for standard input (-) and overrides the
extension. Duet detects unit, up axis and joints; duet inspect FILE shows the result and the reason.
)"},
      {"joints", R"(How Duet finds the joints of a file.

Models have these joints: head, neck, torso, and left_ and right_ of shoulder, elbow, hand, hip,
knee and foot. Duet finds them in a file by the names of Mixamo, CMU, Biped, SMPL, DAZ, Rigify,
Unreal and others, and neck and torso by their position along the trunk.

  duet inspect walk.bvh                    which joint of the file stands for which
  --joint-map torso=Chest3                 sets a joint (repeatable)
  --joint-map-file rig.txt                 the same from a file, one joint on each line
)"},
      {"labels", R"(How to describe a reaction.

A label is an interaction class and its weight from -2 to 2: 1 requests the class, 0 is neutral, -1
avoids it. Several labels are mixed. duet models lists the classes of each model.

  --label kick=1                           a kick
  --label hug=0.7 --label push=-0.5        similar to a hug and unlike a push
  --keyframe 0:kick=1 --keyframe 30:hug=1  a kick, then a hug from frame 30
  --beat 180 --keyframe 0b:basic --keyframe 8b:follower_turn
                                           to music of 180 BPM: basic steps on the first beat, which
                                           become a turn over eight beats
)"},
      {"settings", R"(Defaults from the environment and a file.

A flag overrides the environment, which overrides the configuration file, which overrides the
default.

  DUET_SERVER   sets --server
  DUET_CONFIG   the configuration file; empty for none (default: $XDG_CONFIG_HOME/duet/config, or
                ~/.config/duet/config)
  NO_COLOR      any value turns off colour; only terminals get colour

The configuration file holds flags of any command without their dashes, one on each line. Flags that
a command does not have are ignored; a flag that no command has is an error.

  # the lab's server
  server = lab:50051
  tls-ca = /etc/lab/ca.pem
  quiet = true
)"}};
  return topics;
}

}  // namespace

std::vector<std::string> HelpTopics() {
  std::vector<std::string> names;
  for (const auto& [name, text] : Topics()) names.push_back(name);
  return names;
}

std::string HelpTopicNames() { return absl::StrJoin(HelpTopics(), ", "); }

std::string TopicText(const std::string& topic) { return Topics().at(topic); }

}  // namespace duet::client::cli
