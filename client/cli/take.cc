#include "client/cli/take.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/cli/motion_input.h"
#include "model/motion/resample.h"

namespace duet::client::cli {
namespace {

namespace fs = std::filesystem;

constexpr char kLeaderEnding[] = ".leader.bvh", kFollowerEnding[] = ".follower.bvh";

bool Exists(const fs::path& path) {
  std::error_code error;
  return path == kStandardStream || fs::exists(path, error);
}

bool IsSame(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error);
}

// Splits at the first comma that separates two file names.
std::vector<fs::path> SplitFiles(const std::string& text) {
  for (std::size_t comma = text.find(','); comma != std::string::npos && !Exists(text);
       comma = text.find(',', comma + 1)) {
    const fs::path leader = text.substr(0, comma), follower = text.substr(comma + 1);
    if (Exists(leader) && Exists(follower)) return {leader, follower};
  }
  return {text};
}

void AddFollowerBeside(TakeFiles* take) {
  const std::string file = take->files[0].string();
  if (take->files.size() > 1 || !absl::EndsWith(file, kLeaderEnding)) return;
  const fs::path follower = absl::StrCat(absl::StripSuffix(file, kLeaderEnding), kFollowerEnding);
  if (Exists(follower)) take->files.push_back(follower);
}

std::string NameOfFile(const fs::path& file) {
  if (file == kStandardStream) return "standard input";
  const std::string name = file.filename().string();
  if (absl::EndsWith(name, kLeaderEnding)) {
    return std::string(absl::StripSuffix(name, kLeaderEnding));
  }
  return file.stem().string();
}

// Resamples a follower from another file to the leader's rate, and truncates both to the shorter
// one.
void Match(Take* take) {
  motion::Clip &leader = take->leader, &follower = *take->follower;
  const double step = follower.frame_rate_hz / leader.frame_rate_hz;
  const double reach = std::floor((follower.frame_count() - 1) / step + 1e-6) + 1;
  const int frames = static_cast<int>(std::min(static_cast<double>(leader.frame_count()), reach));
  motion::Poses poses(frames, follower.joint_count());
  for (int frame = 0; frame < frames; ++frame) {
    SampleLinear(follower.poses, frame * step, poses[frame]);
  }
  follower.poses = std::move(poses);
  follower.frame_rate_hz = leader.frame_rate_hz;
  leader.poses.Resize(frames);
}

class TakeReader {
 public:
  TakeReader(const formats::ReadOptions& options, std::istream* in) : options_(options), in_(in) {}

  absl::StatusOr<Take> Read(const TakeFiles& files, formats::Side leader_side) {
    Take take{files.name, files.files, {}, {}, {}};
    absl::StatusOr<formats::ReadPeople> people = ReadFile(files.files[0]);
    if (!people.ok()) return people.status();
    take.notes = std::move(people->notes);
    const bool alone = people->people.size() < 2;
    const std::size_t leader = !alone && leader_side == formats::Side::kRight ? 1 : 0;
    take.leader = std::move(people->people[leader]);
    if (files.files.size() > 1) {
      absl::StatusOr<formats::ReadPeople> other = ReadFile(files.files[1]);
      if (!other.ok()) return other.status();
      take.follower = std::move(other->people[0]);
      Match(&take);
    } else if (!alone) {
      take.follower = std::move(people->people[1 - leader]);
    }
    return take;
  }

 private:
  absl::StatusOr<formats::ReadPeople> ReadFile(const fs::path& file) {
    absl::Status status = CheckInput(file, options_.format);
    if (!status.ok()) return status;
    const absl::StatusOr<MotionInput> input = MotionInput::Open(file, in_);
    if (!input.ok()) return input.status();
    return ReadAllPeople(*input, options_);
  }

  const formats::ReadOptions& options_;
  std::istream* in_;
};

// Whether a file is the follower of a take that has its leader in another file.
bool IsFollowerOfAnother(const TakeFiles& take, const std::vector<TakeFiles>& takes) {
  return take.files.size() == 1 &&
         std::any_of(takes.begin(), takes.end(), [&take](const TakeFiles& other) {
           return other.files.size() > 1 && IsSame(other.files[1], take.files[0]);
         });
}

}  // namespace

TakeFiles ParseTake(const std::string& text) {
  TakeFiles take;
  std::string files = text;
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && !Exists(text)) {
    take.name = text.substr(0, equals);
    files = text.substr(equals + 1);
  }
  take.files = SplitFiles(files);
  AddFollowerBeside(&take);
  if (take.name.empty()) take.name = NameOfFile(take.files[0]);
  return take;
}

absl::StatusOr<std::vector<Take>> ReadTakes(const TakeArguments& arguments,
                                            const motion::Skeleton& skeleton, std::istream* in) {
  const absl::StatusOr<formats::ReadOptions> options = ToReadOptions(arguments.input, skeleton);
  if (!options.ok()) return options.status();
  std::vector<TakeFiles> all;
  for (const std::string& text : arguments.takes) all.push_back(ParseTake(text));
  TakeReader reader(*options, in);
  std::vector<Take> takes;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (IsFollowerOfAnother(all[i], all)) continue;
    const std::size_t side = arguments.leader_sides.size() == 1 ? 0 : i;
    absl::StatusOr<Take> take = reader.Read(all[i], arguments.leader_sides[side]);
    if (!take.ok()) return take.status();
    takes.push_back(*std::move(take));
  }
  return takes;
}

}  // namespace duet::client::cli
