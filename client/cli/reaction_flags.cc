#include "client/cli/reaction_flags.h"

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/value_syntax.h"
#include "model/base/request_id.h"

namespace duet::client::cli {
namespace {

// "auto" leaves the choice to the server.
const std::map<std::string, std::optional<bool>> kCleanUps = {
    {"auto", std::nullopt}, {"on", true}, {"off", false}};

}  // namespace

void AddReadingFlags(FlagSet* app, SynthesizeArguments* arguments) {
  AddChoice<formats::Side>(
      app, "--leader-side", kSides,
      [arguments](formats::Side side) { arguments->leader_side = side; },
      "The person who leads in a file with two people")
      ->ShowDefault(NameOf(kSides, arguments->leader_side))
      ->Group(kInputGroup);
  AddInputFlags(app, &arguments->input);
  AddParsed<batch::Level>(
      app, "--level", batch::kLevelForm, ParseLevel,
      [arguments](batch::Level level) { arguments->level = level; },
      "Vertical of the leader's camera in metres, y up; auto: estimated from everybody in the "
      "file, who are levelled only if the evidence is strong (duet inspect shows it)")
      ->LastOnly()
      ->ShowDefault("auto")
      ->Group(kInputGroup);
}

Flag* AddLabelFlag(FlagSet* app, SynthesizeArguments* arguments) {
  return AddParsed<ClassWeight>(
             app, "--label", "CLASS[=WEIGHT]", ParseClassWeight, AppendTo(&arguments->weights),
             "Weight of an interaction class, such as kick=1 or hug=-0.5; repeatable")
      ->Group(kReactionGroup);
}

void AddModelFlag(FlagSet* app, SynthesizeArguments* arguments) {
  AddParsed<ModelChoice>(
      app, "--model", "NAME[@VERSION|:LABEL]", ParseModelChoice,
      [arguments](ModelChoice choice) { arguments->model = std::move(choice); },
      "Model to use (default: the server's default model)")
      ->LastOnly()
      ->Group(kReactionGroup);
}

void AddStartFlags(FlagSet* app, SynthesizeArguments* arguments) {
  app->Add("--follower-start", &arguments->follower_start,
           "Start of the follower: a motion file (its first frame), or X,Y,Z of the root "
           "joint in metres, y up; Y is about 1 above the floor for a person who stands")
      ->Form("FILE|X,Y,Z")
      ->Group(kReactionGroup);
  AddChoice<formats::Side>(
      app, "--follower-start-side", kSides,
      [arguments](formats::Side side) { arguments->follower_start_side = side; },
      absl::StrCat(
          "The person in a --follower-start file with two people (default: in the leader's "
          "file, the other person; else ",
          NameOf(kSides, kDefaultSide), ")"))
      ->Group(kReactionGroup);
  AddParsed<motion::Vec3>(
      app, "--partner-direction", "X,Y,Z", ParseDirection,
      [arguments](motion::Vec3 direction) { arguments->partner_direction = direction; },
      "Horizontal direction from the leader to the follower (default: towards --follower-start, "
      "else the model's estimate from the leader)")
      ->LastOnly()
      ->Group(kReactionGroup);
}

void AddSamplingFlags(FlagSet* app, SynthesizeArguments* arguments) {
  AddParsed<uint64_t>(
      app, "--seed", "SEED", ParseSeed, [arguments](uint64_t seed) { arguments->seed = seed; },
      "Seed of a model that samples; the same seed gives the same answer")
      ->LastOnly()
      ->ShowDefault(absl::StrCat(arguments->seed))
      ->Group(kReactionGroup);
  AddParsed<float>(
      app, "--variety", "VARIETY", ParseVariety,
      [arguments](float variety) { arguments->variety = variety; },
      "Variety of such answers, from 0 (typical) over 1 (as varied as people) to 2")
      ->LastOnly()
      ->ShowDefault(absl::StrCat(arguments->variety))
      ->Group(kReactionGroup);
  app->Add("--candidates", &arguments->candidates,
           "Number of samples that such a model draws for each window; the answer is the "
           "best of them. More take longer")
      ->InRange(1, 16)
      ->ShowDefault()
      ->Form("COUNT")
      ->Group(kReactionGroup);
}

void AddCleanUpFlag(FlagSet* app, SynthesizeArguments* arguments) {
  AddChoice<std::optional<bool>>(
      app, "--clean-up", kCleanUps,
      [arguments](std::optional<bool> clean_up) { arguments->clean_up = clean_up; },
      "Correct the follower: upright, feet still, joints within human ranges, outside the leader; "
      "auto: the server's default for the model")
      ->ShowDefault(NameOf(kCleanUps, arguments->clean_up))
      ->Group(kReactionGroup);
}

void AddRequestIdFlag(FlagSet* app, SynthesizeArguments* arguments) {
  AddParsed<std::string>(
      app, "--request-id", "ID", ParseRequestId,
      [arguments](std::string id) { arguments->request_id = std::move(id); },
      absl::StrCat("Name of the call in the server's log: ", base::kRequestIdForm))
      ->LastOnly()
      ->Group(kReactionGroup);
}

}  // namespace duet::client::cli
