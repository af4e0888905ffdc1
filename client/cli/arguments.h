#ifndef DUET_CLIENT_CLI_ARGUMENTS_H_
#define DUET_CLIENT_CLI_ARGUMENTS_H_

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "client/batch/flow/server_choice.h"
#include "client/batch/recipe_file.h"
#include "client/batch/shard.h"
#include "client/cli/settings.h"
#include "client/options.h"
#include "client/request.h"
#include "model/formats/motion_file.h"
#include "model/motion/vec3.h"

namespace duet::client::cli {

// Where the server is and how to speak to it.
struct ServerArguments {
  std::string address = ClientOptions().server_address;
  double timeout_seconds = absl::ToDoubleSeconds(ClientOptions().deadline);
  double wait_seconds = absl::ToDoubleSeconds(ClientOptions().wait);
  bool tls = false;  // implied by any of the files
  std::string tls_ca_file;
  std::string tls_certificate_file;
  std::string tls_key_file;
  std::string tls_server_name;
  std::string token_file;
  std::string authority;
};

// Of a file with two people, the one that is read where nothing else is said.
inline constexpr formats::Side kDefaultSide = formats::Side::kLeft;

// What stands for standard input or output where a file is wanted.
inline constexpr char kStandardStream[] = "-";

// How a motion file is to be read where the file itself does not say.
struct InputArguments {
  std::optional<formats::Format> format;
  std::optional<double> frame_rate_hz;
  std::optional<motion::LengthUnit> unit;
  std::optional<motion::UpAxis> up_axis;
  std::optional<double> metres_per_unit;
  retargeting::JointOverrides joints;
  std::filesystem::path joint_table;  // a file of such joints; `joints` win over it
};

// What a result is written as: a motion, or a page to watch.
struct OutputFormat {
  std::optional<formats::Format> motion;  // absent: a page
};

// How .bvh is written.
struct BvhArguments {
  double metres_per_unit = formats::kCentimetre;
  int keys_per_frame = 1;
};

// duet models
struct ModelsArguments {
  ServerArguments server;
  bool json = false;
};

// duet admin
struct AdminArguments {
  enum class Action { kModels, kReload, kLoad, kUnload, kLabel };
  Action action = Action::kModels;
  ServerArguments server = AdminServer();
  std::string name;
  uint32_t version = 0;
  std::string label;
  bool delete_label = false;
  bool json = false;

 private:
  static ServerArguments AdminServer() {
    ServerArguments server;
    server.address = "localhost:50052";
    return server;
  }
};

// duet synthesize
struct SynthesizeArguments : SynthesisOptions {
  ServerArguments server;
  std::filesystem::path leader;
  formats::Side leader_side = kDefaultSide;
  InputArguments input;
  ModelChoice model;
  std::vector<ClassWeight> weights;
  std::vector<WeightKeyframe> keyframes;
  std::string follower_start;  // empty, "X,Y,Z" or a motion file
  std::optional<formats::Side> follower_start_side;
  int samples = 1;  // answers, with seeds from `seed` on; none passes the largest seed
  std::vector<std::filesystem::path> outputs;
  std::optional<OutputFormat> output_format;  // of standard output
  BvhArguments bvh;
  std::string follower_rig;                // empty, kLeadersRig or a file
  retargeting::JointOverrides rig_joints;  // of such a file
  std::filesystem::path rig_joint_table;   // a file of such joints; `rig_joints` win over it
  bool json = false;
  bool quiet = false;
};
inline constexpr char kLeadersRig[] = "leader";

// The seed of one of the samples, 0 the first.
inline uint64_t SeedOf(const SynthesizeArguments& arguments, int sample) {
  return arguments.seed + static_cast<uint64_t>(sample);
}

// The files of one of the samples: with several, pair.html becomes pair.seed7.html.
std::vector<std::filesystem::path> SampleOutputs(const SynthesizeArguments& arguments, int sample);

// duet batch, duet batch merge and duet batch verify
struct BatchArguments {
  enum class Action { kRun, kMerge, kVerify };
  Action action = Action::kRun;
  std::vector<std::string> words;       // the whole command line, with the settings that count
  bool repair = false;                  // of kVerify, as is
  std::vector<std::string> repairers;   // servers instead of the last run's; may be empty
  std::vector<std::string> leaders;     // files, folders, patterns
  std::string manifest;                 // a file, "-" or empty
  std::filesystem::path manifest_copy;  // of what "-" brought, once it is read
  std::filesystem::path recipe;
  std::filesystem::path out;
  std::vector<std::string> servers = {ClientOptions().server_address};
  ServerArguments connection;  // all but the address
  std::optional<batch::Shard> shard;
  batch::RecipeOverrides overrides;
  int max_in_flight = batch::flow::Options().max_in_flight;
  int channels = 1;
  double patience_seconds = 120;
  int64_t limit = std::numeric_limits<int64_t>::max();
  double share = 1;
  bool retry_failed = false;
  bool dry_run = false;
  bool json = false;
  bool quiet = false;
};

// duet inspect
struct InspectArguments {
  std::vector<std::filesystem::path> files;
  InputArguments input;
  bool json = false;
};

// Who of a file with two people.
enum class People { kLeft, kRight, kBoth };

// duet convert
struct ConvertArguments {
  std::filesystem::path file;
  InputArguments input;
  std::optional<People> people;  // absent: all that the file has
  std::optional<double> resample_hz;
  std::vector<std::filesystem::path> outputs;
  std::optional<OutputFormat> output_format;  // of standard output
  BvhArguments bvh;
  bool json = false;
  bool quiet = false;
};

// The motions that duet view and duet compare show: "[NAME=]FILE" or "[NAME=]LEADER,FOLLOWER".
struct TakeArguments {
  std::vector<std::string> takes;
  // Who leads in a file with two people: of all files, or of each in their order.
  std::vector<formats::Side> leader_sides = {kDefaultSide};
  InputArguments input;
};

// duet view
struct ViewArguments {
  TakeArguments takes;
  std::filesystem::path out;
  std::string title;  // empty: the takes' names
  bool quiet = false;
};

// duet compare
struct CompareArguments {
  TakeArguments takes;  // two
  std::filesystem::path out;
  bool json = false;
};

// duet man
struct ManArguments {
  std::filesystem::path folder;
};

// What the command line asks for: one of the commands, or to print `text` and exit with `exit_code`
// (help, version, a usage error).
struct ParsedCommandLine {
  std::optional<ModelsArguments> models;
  std::optional<AdminArguments> admin;
  std::optional<SynthesizeArguments> synthesize;
  std::optional<BatchArguments> batch;
  std::optional<InspectArguments> inspect;
  std::optional<ConvertArguments> convert;
  std::optional<ViewArguments> view;
  std::optional<CompareArguments> compare;
  std::optional<ManArguments> man;
  bool stdio = false;
  std::string text;
  int exit_code = 0;
};

// `arguments` without the program's name; `settings` count for flags that are not among them. Never
// touches the network; looks at output folders only.
ParsedCommandLine ParseCommandLine(const std::vector<std::string>& arguments,
                                   const std::vector<Setting>& settings = {});

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_ARGUMENTS_H_
