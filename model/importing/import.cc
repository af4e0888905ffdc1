#include "model/importing/import.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/base/counted.h"
#include "model/base/file.h"
#include "model/base/median.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/formats/motion_file.h"
#include "model/importing/steps.h"
#include "model/motion/inferred_coordinates.h"
#include "model/motion/posture.h"
#include "model/motion/resample.h"

namespace duet::importing {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTableBytes = std::size_t{16} << 20;
constexpr char kTableName[] = "pairs.tsv";
constexpr double kHighestOwnRate = 30;  // networks expect at most this
constexpr double kSameRate = 1e-3;
// Thresholds above which data is levelled by default.
constexpr double kLeastLeanDegrees = 3;
constexpr double kLeastFloorMetres = 0.1;
constexpr double kFloorShare = 0.25;
constexpr double kCloseCall = 1.2;  // ratio of the larger displacement to the smaller
constexpr std::size_t kMostListed = 8;

constexpr int kFewestFrames = 2;
// Median distance of the roots, metres.
constexpr double kNearest = 0.05, kFarthest = 10;
// One person's legs may be this factor shorter or longer than the range that InferUnit accepts for
// the median of all people.
constexpr double kLegTolerance = 1.5;

bool HasHierarchy(std::optional<formats::Format> format) {
  return format == formats::Format::kBvh || format == formats::Format::kGltf ||
         format == formats::Format::kGlb;
}

// Formats with a hierarchy (BVH, glTF) keep the file's unit and axes. Every other format is read in
// the coordinates that the file states; the default is metres, y up. `notes` receives one note for
// each choice between several joints.
absl::StatusOr<motion::Clip> ReadPerson(const fs::path& path, formats::Side side,
                                        formats::ReadOptions options,
                                        std::vector<std::string>* notes) {
  options.side = side;
  retargeting::ReadingReport report;
  options.report = &report;
  const std::optional<formats::Format> format = formats::FormatOf(path);
  if (HasHierarchy(format)) {
    options.metres_per_unit = 1;
    options.coordinates = motion::Coordinates{};
  }
  absl::StatusOr<motion::Clip> person = formats::ReadLeader(path, options);
  if (person.ok()) {
    const std::vector<std::string> more = report.Notes();
    notes->insert(notes->end(), more.begin(), more.end());
  }
  if (person.ok() || format != formats::Format::kNpy) return person;
  return absl::Status(
      person.status().code(),
      absl::StrCat(person.status().message(),
                   "; NPY states neither frame rate nor joints: specify --frame-rate, and "
                   "--skeleton unless they are the 15 joints of SBU"));
}

// Resamples the whole duration, as the engine does with leaders.
void ToRate(double rate_hz, motion::Clip* clip) {
  if (clip->frame_rate_hz != rate_hz) {
    clip->poses = Resample(clip->poses, clip->frame_rate_hz, rate_hz);
  }
  clip->frame_rate_hz = rate_hz;
}

double MedianRootDistance(const Capture& capture, int root) {
  std::vector<double> distances;
  for (int t = 0; t < capture.first.frame_count(); ++t) {
    distances.push_back(Distance(capture.first.at(t, root), capture.second.at(t, root)));
  }
  return base::Median(std::move(distances));
}

// Reads both people. Errors: INVALID_ARGUMENT naming the file, also if a file that must hold two
// people holds one.
absl::StatusOr<Capture> ReadCapture(const fs::path& folder, const PairFiles& files,
                                    const formats::ReadOptions& options,
                                    std::vector<std::string>* notes) {
  const bool one_file = files.first == files.second;
  DUET_TRY(motion::Clip first,
           ReadPerson(folder / files.first, formats::Side::kLeft, options, notes));
  DUET_TRY(motion::Clip second,
           ReadPerson(folder / files.second,
                      one_file ? formats::Side::kRight : formats::Side::kLeft, options, notes));
  // The reader returns the only person of a file for either side.
  if (first.poses == second.poses) {
    return absl::InvalidArgumentError(
        one_file
            ? "people: expected 2 in the file, or a file for each whose names end in _a and _b "
              "(or _leader and _follower), got 1"
            : "expected one motion for each person, got the same one in both files");
  }
  const int frames = std::min(first.frame_count(), second.frame_count());
  if (frames < kFewestFrames) {
    return absl::InvalidArgumentError(
        absl::StrCat("frames: expected at least ", kFewestFrames, ", got ", frames));
  }
  return Capture{files, std::move(first), std::move(second)};
}

// Resamples both people to one rate and truncates the longer one. Returns their difference in
// length, seconds.
double Align(double rate_hz, Capture* capture) {
  ToRate(rate_hz, &capture->first);
  ToRate(rate_hz, &capture->second);
  const int first = capture->first.frame_count(), second = capture->second.frame_count();
  capture->first.poses.Resize(std::min(first, second));
  capture->second.poses.Resize(std::min(first, second));
  return std::abs(first - second) / rate_hz;
}

// INVALID_ARGUMENT unless these can be two people in one place, in metres, y up: with legs of a
// person's length, and at a plausible distance from each other.
absl::Status CheckPlausible(const Capture& capture, const motion::Skeleton& skeleton) {
  for (const motion::Clip* person : {&capture.first, &capture.second}) {
    const double leg = motion::LegLength(skeleton, person->poses);
    const double shortest = motion::kShortestLeg / kLegTolerance;
    const double longest = motion::kLongestLeg * kLegTolerance;
    if (leg > shortest && leg < longest) continue;
    return absl::InvalidArgumentError(absl::StrFormat(
        "%s: legs: expected %.2g to %.2g m in the unit of the other files, got %.3g m",
        person == &capture.first ? capture.files.first : capture.files.second, shortest, longest,
        leg));
  }
  const double apart = MedianRootDistance(capture, skeleton.root);
  if (apart >= kNearest && apart <= kFarthest) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "distance of the two people: expected %g to %g m, got %.3g m; both must be in one world",
      kNearest, kFarthest, apart));
}

// Cuts a capture into equal pieces of at most `longest` frames.
std::vector<Capture> Cut(const Capture& capture, int longest) {
  const int frames = capture.first.frame_count();
  const int pieces = (frames + longest - 1) / longest;
  if (pieces <= 1) return {capture};
  std::vector<Capture> cut;
  for (int i = 0; i < pieces; ++i) {
    const int first = frames * i / pieces, count = frames * (i + 1) / pieces - first;
    Capture piece = capture;
    for (motion::Clip* person : {&piece.first, &piece.second}) {
      person->poses = motion::Part(person->poses, first, count);
    }
    absl::StrAppend(&piece.files.name, "_p", i + 1);
    cut.push_back(std::move(piece));
  }
  return cut;
}

std::string ListSome(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), kMostListed);
  const std::vector<std::string> some(names.begin(),
                                      names.begin() + static_cast<std::ptrdiff_t>(shown));
  return absl::StrCat(absl::StrJoin(some, ", "), shown < names.size() ? ", ..." : "");
}

bool IsHidden(const fs::path& path) {
  for (const fs::path& part : path) {
    if (absl::StartsWith(part.string(), ".")) return true;
  }
  return false;
}

// The motion files below a folder, and the number of other files by extension.
struct Listing {
  std::vector<std::string> motions;
  std::map<std::string, int> others;
};

absl::StatusOr<Listing> ListMotions(const fs::path& folder) {
  Listing listing;
  std::error_code error;
  fs::recursive_directory_iterator it(folder, error), end;
  for (; !error && it != end; it.increment(error)) {
    const fs::path path = it->path().lexically_relative(folder);
    if (IsHidden(path) || !it->is_regular_file(error)) continue;
    if (formats::IsReadable(path)) {
      listing.motions.push_back(path.generic_string());
    } else if (path != kTableName) {
      ++listing.others[path.extension().string()];
    }
  }
  if (error) return absl::NotFoundError(absl::StrCat(folder.string(), ": ", error.message()));
  std::sort(listing.motions.begin(), listing.motions.end());
  return listing;
}

// Runs one import. Each step records its assumptions.
class Importer {
 public:
  Importer(const ImportOptions& options, ImportReport* report)
      : options_(options), report_(*report) {}

  absl::Status Run() {
    DUET_RETURN_IF_ERROR(CheckFolders());
    DUET_RETURN_IF_ERROR(FindPairs());
    DUET_RETURN_IF_ERROR(FindJoints());
    DUET_RETURN_IF_ERROR(ReadPairs());
    DUET_RETURN_IF_ERROR(FindCoordinates());
    FindRate();
    DUET_RETURN_IF_ERROR(AlignPairs());
    DUET_RETURN_IF_ERROR(CheckRefused());
    DUET_RETURN_IF_ERROR(DescribeClasses());
    ChooseLeaders();
    FindLevel();
    CutLongPairs();
    return Write();
  }

 private:
  void Assume(std::string what, std::string value, std::string flag) {
    report_.assumptions.push_back({std::move(what), std::move(value), std::move(flag)});
  }
  void Refuse(const PairFiles& files, const absl::Status& status) {
    report_.refused.push_back({files.first == files.second
                                   ? files.first
                                   : absl::StrCat(files.first, " and ", files.second),
                               std::string(status.message())});
  }

  absl::Status CheckFolders() {
    const fs::path from = fs::absolute(options_.from).lexically_normal();
    const fs::path out = fs::absolute(options_.out).lexically_normal();
    const std::string way = out.lexically_relative(from).generic_string();
    if (way != ".." && !absl::StartsWith(way, "../")) {
      return absl::InvalidArgumentError(
          absl::StrCat("--out: expected a folder outside --from, got ", options_.out.string()));
    }
    return CheckOut(options_.out, options_.overwrite);
  }

  absl::Status FindPairs() {
    DUET_TRY(const Listing listing, ListMotions(options_.from));
    for (const auto& [extension, count] : listing.others) {
      const std::string how = formats::HowToConvert("file" + extension);
      Assume("ignored",
             absl::StrCat(count, " ", extension.empty() ? "" : absl::StrCat(extension, " "),
                          count == 1 ? "file" : "files",
                          extension.empty() ? " without an extension" : "", ": ",
                          how.empty() ? "not a motion" : how),
             "");
    }
    fs::path table = options_.table;
    std::error_code error;
    if (table.empty() && fs::exists(options_.from / kTableName, error)) {
      table = options_.from / kTableName;
    }
    Pairing pairing = PairByName(listing.motions);
    if (!table.empty()) {
      DUET_TRY(const std::string text, base::ReadFile(table, kMaxTableBytes, "a table of pairs"));
      DUET_TRY(pairing, PairByTable(text, table.string(), listing.motions));
    }
    report_.refused = pairing.refused;
    pairs_ = std::move(pairing.pairs);
    if (pairs_.empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          options_.from.string(),
          ": expected pairs of motion files (kick_01_a.bvh and kick_01_b.bvh), or files "
          "of both people, got no pairs among ",
          listing.motions.size(),
          " motion files; rename them or write a table (docs/guides/own_data.md)"));
    }
    Assume("pairs",
           absl::StrCat(pairs_.size(), " by ", table.empty() ? "their names" : table.string()),
           "--table FILE");
    return absl::OkStatus();
  }

  absl::Status FindJoints() {
    absl::StatusOr<CaptureSkeleton> found;
    for (const PairFiles& files : pairs_) {  // the first readable one; ReadPairs reports the others
      found = FindSkeleton(options_.from / files.first, options_.skeleton);
      if (found.ok() || !options_.skeleton.empty()) break;
    }
    if (!found.ok()) return found.status();
    skeleton_ = *std::move(found);
    const motion::Skeleton& skeleton = skeleton_.skeleton;
    Assume("skeleton", absl::StrCat(skeleton.joint_count(), " joints, from ", skeleton_.origin),
           "--skeleton FILE");
    Assume("root", skeleton.joint_names[static_cast<std::size_t>(skeleton.root)],
           "--skeleton FILE");
    for (const std::string& note : skeleton_.notes) Assume("joints", note, "--skeleton FILE");
    return absl::OkStatus();
  }

  absl::Status ReadPairs() {
    formats::ReadOptions options;
    options.skeleton = skeleton_.skeleton;
    options.joint_overrides = options_.joint_overrides;
    options.frame_rate_hz = options_.frame_rate_hz;
    std::vector<std::string> notes;
    for (const PairFiles& files : pairs_) {
      absl::StatusOr<Capture> capture = ReadCapture(options_.from, files, options, &notes);
      if (capture.ok()) {
        captures_.push_back(*std::move(capture));
      } else {
        Refuse(files, capture.status());
      }
    }
    std::map<std::string, int> people;
    for (const std::string& note : notes) ++people[note];
    for (const auto& [note, count] : people) {
      Assume("joint map", absl::StrCat(note, ", for ", base::Counted(count, "person", "people")),
             "--joint-map JOINT=NAME");
    }
    if (captures_.empty()) return AllRefused();
    return absl::OkStatus();
  }

  absl::Status AllRefused() const {
    return absl::InvalidArgumentError(
        absl::StrCat("no pair can be used, of ", report_.refused.size()));
  }

  std::vector<const motion::Poses*> People() const {
    std::vector<const motion::Poses*> people;
    for (const Capture& capture : captures_) {
      people.push_back(&capture.first.poses);
      people.push_back(&capture.second.poses);
    }
    return people;
  }

  absl::Status FindCoordinates() {
    std::vector<double> legs;
    for (const motion::Poses* poses : People()) {
      legs.push_back(motion::LegLength(skeleton_.skeleton, *poses));
    }
    const std::optional<motion::InferredUnit> unit =
        options_.metres_per_unit ? motion::InferredUnit{"as specified", *options_.metres_per_unit}
                                 : motion::InferUnit(legs);
    if (!unit) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "unit: expected legs of %g to %g m in a usual unit, got legs of %.4g units; "
          "specify --metres-per-unit",
          motion::kShortestLeg, motion::kLongestLeg, legs.front()));
    }
    const std::optional<motion::UpAxis> axis =
        options_.up_axis ? options_.up_axis : motion::InferUpAxis(skeleton_.skeleton, People());
    if (!axis) {
      return absl::InvalidArgumentError(
          "up axis: expected people who stand along y, z or -y, got another axis; specify "
          "--up-axis, or rotate the files");
    }
    const motion::Coordinates coordinates{motion::LengthUnit::kMetres, *axis};
    for (Capture& capture : captures_) {
      for (motion::Clip* person : {&capture.first, &capture.second}) {
        for (motion::Vec3& point : person->poses.all()) {
          point = ToWorld(coordinates, point * static_cast<float>(unit->metres));
        }
      }
    }
    Assume("unit",
           absl::StrFormat("%s: legs are %.2f m long", unit->name, legs.front() * unit->metres),
           "--metres-per-unit METRES");
    Assume("up axis", std::string(UpAxisName(*axis)), "--up-axis y-up|z-up|y-down");
    return absl::OkStatus();
  }

  void FindRate() {
    std::map<double, int> rates;
    for (const Capture& capture : captures_) {
      ++rates[capture.first.frame_rate_hz];
      ++rates[capture.second.frame_rate_hz];
    }
    const double found = std::max_element(rates.begin(), rates.end(), [](auto& a, auto& b) {
                           return a.second < b.second;
                         })->first;
    const double nth = std::ceil(found / kHighestOwnRate - kSameRate);
    rate_hz_ = options_.to_rate_hz.value_or(found / std::max(1.0, nth));
    std::string value =
        absl::StrFormat("%g frames per second, from files with %g", rate_hz_, found);
    if (rates.size() > 1) absl::StrAppend(&value, " and ", rates.size() - 1, " other rates");
    Assume("frame rate", value, "--to-rate HZ, --frame-rate HZ");
  }

  absl::Status AlignPairs() {
    double most = 0;
    int differ = 0;
    std::vector<Capture> good;
    for (Capture& capture : captures_) {
      const double seconds = Align(rate_hz_, &capture);
      if (seconds > 1 / rate_hz_) ++differ;
      most = std::max(most, seconds);
      const absl::Status status = CheckPlausible(capture, skeleton_.skeleton);
      if (status.ok()) {
        good.push_back(std::move(capture));
      } else {
        Refuse(capture.files, status);
      }
    }
    captures_ = std::move(good);
    if (captures_.empty()) return AllRefused();
    if (differ > 0) {
      Assume("length",
             absl::StrFormat("%s whose people differ by up to %.2f s: cut to the shorter",
                             base::Counted(differ, "pair"), most),
             "");
    }
    return absl::OkStatus();
  }

  absl::Status CheckRefused() {
    report_.pairs = static_cast<int>(captures_.size());
    if (report_.refused.empty() || options_.skip_refused) return absl::OkStatus();
    return absl::InvalidArgumentError(
        absl::StrCat(report_.refused.size(), " refused and ", captures_.size(),
                     " usable; nothing was written. Fix them, or omit them with "
                     "--skip-refused"));
  }

  // Classes in alphabetical order, with their properties.
  absl::Status DescribeClasses() {
    std::map<std::string, int> counts;
    for (const Capture& capture : captures_) ++counts[capture.files.label];
    for (const auto& [label, count] : counts) {
      dataset::ClassLayout one;
      one.name = one.folder = label;
      one.effectors = {skeleton_.hands.left, skeleton_.hands.right};
      if (absl::StrContains(label, "kick")) {
        one.effectors = {skeleton_.skeleton.feet->left, skeleton_.skeleton.feet->right};
      }
      classes_.push_back(std::move(one));
    }
    using dataset::ClassLayout;
    DUET_RETURN_IF_ERROR(SetProperty("--symmetric", options_.symmetric, &ClassLayout::symmetric));
    DUET_RETURN_IF_ERROR(SetProperty("--handed", options_.handed, &ClassLayout::handed));
    DUET_RETURN_IF_ERROR(SetProperty("--touches", options_.touches, &ClassLayout::touches));
    for (const dataset::ClassLayout& one : classes_) {
      Assume("class",
             absl::StrCat(one.name, ": ", base::Counted(counts[one.name], "pair"), "; ",
                          one.symmetric ? "either may lead" : "one leads", ", ",
                          one.handed ? "always with the same hand" : "with either hand", ", ",
                          one.touches ? "bodies may touch" : "bodies are kept apart"),
             "--symmetric, --handed, --touches CLASS");
    }
    return absl::OkStatus();
  }

  absl::Status SetProperty(const std::string& flag, const std::vector<std::string>& labels,
                           bool dataset::ClassLayout::*property) {
    for (const std::string& label : labels) {
      const auto one = std::find_if(classes_.begin(), classes_.end(),
                                    [&label](const auto& known) { return known.name == label; });
      if (one == classes_.end()) {
        const auto name = [](std::string* out, const auto& known) { out->append(known.name); };
        return absl::InvalidArgumentError(absl::StrCat(flag, ": expected one of ",
                                                       absl::StrJoin(classes_, ", ", name),
                                                       ", got ", base::Quoted(label)));
      }
      (*one).*property = true;
    }
    return absl::OkStatus();
  }

  void ChooseLeaders() {
    std::map<std::string, int> by_source;
    std::vector<std::string> close;
    std::set<std::string> ruled;  // classes with inferred leaders
    for (const Capture& capture : captures_) {
      ImportedSequence sequence{
          capture, dataset::LeaderSide::kLeft, capture.files.leader_source, {}};
      if (sequence.leader_source.empty()) RuleByMotion(&sequence, &close);
      if (capture.files.leader_source.empty()) ruled.insert(capture.files.label);
      ++by_source[sequence.leader_source];
      sequences_.push_back(std::move(sequence));
    }
    for (const auto& [source, count] : by_source) {
      const bool guess = absl::StartsWith(source, "guess");
      Assume(
          "leader",
          absl::StrCat(base::Counted(count, "pair"), " by ", guess ? "who moves farther" : source),
          guess ? "--table FILE, names with _leader and _follower" : "");
    }
    for (const dataset::ClassLayout& one : classes_) {
      if (ruled.count(one.name) == 0) continue;
      Assume("leader",
             absl::StrCat(one.name, ": who moves ", JointNames(one.effectors), " farther"),
             "--table FILE");
    }
    if (!close.empty()) {
      Assume("leader",
             absl::StrCat(base::Counted(close.size(), "close call"), ": ", ListSome(close)),
             "--table FILE");
    }
  }

  std::string JointNames(const std::vector<int>& joints) const {
    return absl::StrJoin(joints, " or ", [&](std::string* out, int joint) {
      out->append(skeleton_.skeleton.joint_names[static_cast<std::size_t>(joint)]);
    });
  }

  void RuleByMotion(ImportedSequence* sequence, std::vector<std::string>* close) const {
    const Capture& capture = sequence->capture;
    const int root = skeleton_.skeleton.root;
    for (const dataset::ClassLayout& one : classes_) {
      if (one.name != capture.files.label) continue;
      const float first = dataset::PeakDisplacement(capture.first, root, one.effectors);
      const float second = dataset::PeakDisplacement(capture.second, root, one.effectors);
      sequence->leader_side =
          dataset::LeaderByMotion(capture.first, capture.second, root, one.effectors);
      if (std::max(first, second) < kCloseCall * std::min(first, second)) {
        close->push_back(capture.files.first);
      }
    }
    sequence->leader_source = "guess: motion";
  }

  void FindLevel() {
    std::vector<motion::Vec3> directions, feet;
    for (const motion::Poses* poses : People()) {
      const auto standing = motion::StandingDirections(skeleton_.skeleton, *poses);
      const auto lower = motion::LowerFeet(skeleton_.skeleton, *poses);
      directions.insert(directions.end(), standing.begin(), standing.end());
      feet.insert(feet.end(), lower.begin(), lower.end());
    }
    const motion::Lean lean = motion::MeanLean(directions);
    const double degrees = std::hypot(lean.x, lean.z);
    const double floor = motion::HeightQuantile(feet, kFloorShare);
    level_ =
        options_.level.value_or(degrees > kLeastLeanDegrees || std::abs(floor) > kLeastFloorMetres);
    Assume("level",
           absl::StrFormat("%s: people lean %.1f degrees, feet stand at %.2f m",
                           level_ ? "yes" : "no", degrees, floor),
           "--level yes|no");
  }

  void CutLongPairs() {
    const int longest = std::max(2, static_cast<int>(options_.longest_seconds * rate_hz_));
    std::vector<ImportedSequence> all;
    int cut = 0;
    for (const ImportedSequence& sequence : sequences_) {
      const std::vector<Capture> pieces = Cut(sequence.capture, longest);
      if (pieces.size() > 1) ++cut;
      for (const Capture& piece : pieces) {
        all.push_back({piece, sequence.leader_side, sequence.leader_source, {}});
      }
    }
    sequences_ = std::move(all);
    if (cut == 0) return;
    Assume("longest",
           absl::StrFormat("%g s: cut %s into pieces", options_.longest_seconds,
                           base::Counted(cut, "longer pair")),
           "--longest SECONDS");
  }

  absl::Status Write() {
    dataset::DatasetLayout layout;
    layout.name = options_.name;
    if (layout.name.empty()) {
      const fs::path out = fs::absolute(options_.out).lexically_normal();
      layout.name = (out.filename().empty() ? out.parent_path() : out).filename().string();
    }
    layout.frame_rate_hz = rate_hz_;
    layout.skeleton = skeleton_.skeleton;
    layout.parts = skeleton_.parts;
    layout.classes = classes_;
    layout.level = level_;
    Assume("name", layout.name, "--name NAME");
    report_.sequences = static_cast<int>(sequences_.size());
    return WriteDataset(options_.out, layout, sequences_);
  }

  const ImportOptions& options_;
  ImportReport& report_;
  std::vector<PairFiles> pairs_;
  CaptureSkeleton skeleton_;
  std::vector<Capture> captures_;
  double rate_hz_ = 0;
  std::vector<dataset::ClassLayout> classes_;
  std::vector<ImportedSequence> sequences_;
  bool level_ = false;
};

}  // namespace

absl::Status Import(const ImportOptions& options, ImportReport* report) {
  return Importer(options, report).Run();
}

}  // namespace duet::importing
