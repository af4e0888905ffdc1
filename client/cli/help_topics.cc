#include "client/cli/help_topics.h"

#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/command_line.h"
#include "client/cli/exit_code.h"
#include "model/base/nearest.h"
#include "model/base/text.h"

namespace duet::client::cli {
namespace {

const std::map<std::string, std::string>& Topics() {
  static const auto& topics = *new std::map<std::string, std::string>{
      {"exit-codes", R"(What the program's exit code tells a script.

  0   done
  1   failed, but the same call may succeed later (server away, busy or draining; a full disk)
  2   the command line, or a setting, makes no sense
  42  failed, and will again: the input, the model or the credentials are refused
)"},
      {"formats", R"(Which motion files are read and written.

  extension    read                  written              holds
  .gltf .glb   yes                   yes                  animated skeletons
  .usda        no                    yes                  animated skeletons
  .bvh         yes                   a file a person      joint angles, one length a bone
  .amc         with its .asf beside  no                   joint angles
  .csv         yes                   yes                  positions of one or two people
  .json        yes                   yes                  positions of one or two people
  .npy         with --frame-rate     yes                  positions of one or two people
  .txt         yes                   of two people        SBU text: positions of two people

The extension decides; --input-format says it where there is none, as for standard input (-).
Unit, up axis and joints are found by themselves; duet inspect FILE shows what was found and why.
)"},
      {"joints", R"(How the joints of a file are found.

Models have these joints: head, neck, torso, and left_ and right_ of shoulder, elbow, hand, hip,
knee and foot. In a file they go by their names, as Mixamo, CMU, Biped, SMPL, DAZ, Rigify, Unreal
and others write them; neck and torso go by where they are along the trunk.

  duet inspect walk.bvh                    which joint of the file became which
  --joint-map torso=Chest3                 says it where the names do not (repeatable)
  --joint-map-file rig.txt                 the same for a rig that is used often, one a line
)"},
      {"labels", R"(How a reaction is described.

A label is an interaction class and its weight: 1 is wanted, 0 is neutral, -1 is avoided, up to 2
either way. Several mix. duet models lists the classes that each model knows.

  --label kick=1                           a kick
  --label hug=0.7 --label push=-0.5        something like a hug and nothing like a push
  --keyframe 0:kick=1 --keyframe 30:hug=1  first a kick, from frame 30 on a hug
)"},
      {"settings", R"(What counts where the command line says nothing.

A flag wins over the environment, the environment over the configuration file, and that over the
default.

  DUET_SERVER   stands for --server
  DUET_CONFIG   the configuration file; empty: none. Otherwise $XDG_CONFIG_HOME/duet/config, or
                ~/.config/duet/config
  NO_COLOR      set to anything: no colour, which only a terminal gets at all

The configuration file holds flags of any command without their dashes, one a line. A command takes
those that it has; a flag that none has is an error.

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

ParsedCommandLine ExplainTopic(const CLI::App& app, const std::string& topic) {
  ParsedCommandLine parsed;
  const CLI::App* command = FindCommand(app, topic);
  if (topic.empty()) {
    // The program that was parsed would explain the command help.
    parsed.text = absl::StrCat(CommandLine().app.help(), "\nTopics (duet help TOPIC):\n  ",
                               HelpTopicNames(), "\n");
  } else if (command != nullptr) {
    parsed.text = command->help("duet");
  } else if (Topics().count(topic) > 0) {
    parsed.text = TopicText(topic);
  } else {
    std::vector<std::string> known = CommandNames(app);
    for (std::string& name : HelpTopics()) known.push_back(std::move(name));
    parsed.text =
        absl::StrCat("There is no command or topic ", base::Quoted(topic),
                     base::DidYouMean(topic, known), "\nTopics: ", HelpTopicNames(), "\n");
    parsed.exit_code = kExitUsage;
  }
  return parsed;
}

}  // namespace duet::client::cli
