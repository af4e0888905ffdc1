#include "client/batch/contact_sheet.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/batch/durable_file.h"
#include "client/batch/parse_record.h"
#include "client/batch/pose_strip.h"
#include "client/batch/record.h"
#include "client/batch/stored_pair.h"
#include "client/batch/text_values.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

constexpr size_t kItemsOfAClass = 12;

constexpr char kStyle[] = R"(
:root { color-scheme: dark; --soft: #9a9fa8; --leader: #f0a04b; --follower: #4fb3bf; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 28px; max-width: 1720px; background: #17181c; color: #e9eaed;
       font: 14px/1.5 system-ui, sans-serif; }
h1 { margin: 0; font-size: 22px; }
h2 { margin: 34px 0 12px; font-size: 17px; }
h2 small, p, .asked, .figures { color: var(--soft); font-size: 13px; font-weight: normal; }
p { margin: 4px 0; }
p b.leader { color: var(--leader); }
p b.follower { color: var(--follower); }
.items { display: grid; gap: 12px; grid-template-columns: repeat(auto-fill, minmax(min(100%, 500px), 1fr)); }
figure { margin: 0; padding: 10px 14px; border-radius: 10px; background: #202227; }
svg { display: block; width: 100%; }
path { fill: none; stroke-width: 22; stroke-linecap: round; stroke-linejoin: round; }
path.floor { stroke: #5a5f6a; stroke-width: 12; }
path.leader { stroke: var(--leader); }
path.follower { stroke: var(--follower); }
figcaption { display: flex; flex-wrap: wrap; gap: 0 14px; overflow-wrap: anywhere; }
figcaption a { color: inherit; }
.figures { flex-basis: 100%; }
.unread { margin: 18px 0; color: #ffb4ab; overflow-wrap: anywhere; }
)";

std::string Escaped(absl::string_view text) {
  return absl::StrReplaceAll(text,
                             {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

// "kick 1, hug 0.5", one keyframe after the other.
std::string LabelsText(const ordered_json& record) {
  const auto text = [](const ordered_json& labels) {
    std::vector<std::string> words;
    for (const auto& [name, weight] : labels.items()) {
      words.push_back(absl::StrCat(name, " ", weight.dump()));
    }
    return absl::StrJoin(words, ", ");
  };
  if (record.contains("labels")) return text(record["labels"]);
  std::vector<std::string> keyframes;
  for (const ordered_json& keyframe : record["keyframes"]) {
    keyframes.push_back(text(keyframe["labels"]));
  }
  return absl::StrJoin(keyframes, " \u2192 ");
}

std::string FiguresText(const ordered_json& record) {
  const ordered_json& quality = record["quality"];
  std::string text = absl::StrFormat(
      "%.1f s \u00b7 %.2f m apart",
      record["frames"].get<double>() / std::max(record["frame_rate_hz"].get<double>(), 1e-9),
      quality["distance_metres"].get<double>());
  if (quality.contains("lean_degrees")) {
    absl::StrAppend(
        &text, absl::StrFormat(" \u00b7 leans %.0f\u00b0", quality["lean_degrees"].get<double>()));
  }
  return text;
}

// A random sample of the items of a class: those with the lowest ids, which are digests.
struct Sample {
  int64_t items = 0;                         // of the class
  std::map<std::string, JournalEntry> kept;  // by id
};

class Sheet {
 public:
  Sheet(const JobIdentity& identity, const ItemReader& items)
      : identity_(identity), items_(items) {}

  absl::Status Add(const JournalEntry& entry) {
    const absl::StatusOr<ordered_json> parsed = ParseRecord(entry.record);
    if (!parsed.ok()) return parsed.status();
    const ordered_json& record = *parsed;
    if (record["state"] != kDone) return absl::OkStatus();
    Sample& sample = samples_[LargestClass(record)];
    ++sample.items;
    ++total_;
    sample.kept.emplace(record["id"].get<std::string>(), entry);
    if (sample.kept.size() > kItemsOfAClass) sample.kept.erase(std::prev(sample.kept.end()));
    return absl::OkStatus();
  }

  std::string Page() const {
    std::vector<std::string> models;
    for (const ModelChoice& model : identity_.models) models.push_back(ModelText(model));
    std::string page = absl::StrCat(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width\">\n<title>Contact sheet</title>\n"
        "<style>",
        kStyle, "</style>\n<h1>Contact sheet</h1>\n<p>", total_, " followers by ",
        Escaped(absl::StrJoin(models, ", ")),
        ", by the class of the largest weight; of each class ", kItemsOfAClass,
        " at most, chosen at random.</p>\n",
        "<p>Each at six moments from first to last, seen from the side: <b class=\"leader\">leader"
        "</b> and <b class=\"follower\">follower</b>.</p>\n");
    for (const auto& [name, sample] : samples_) AppendClass(name, sample, &page);
    return page;
  }

 private:
  void AppendClass(const std::string& name, const Sample& sample, std::string* page) const {
    absl::StrAppend(page, "<h2>", Escaped(name), " <small>", sample.kept.size(), " of ",
                    sample.items, "</small></h2>\n<div class=\"items\">\n");
    for (const auto& [id, entry] : sample.kept) {
      AppendItem(ordered_json::parse(entry.record), entry.place, page);
    }
    absl::StrAppend(page, "</div>\n");
  }

  void AppendItem(const ordered_json& record, const SpoolPlace& place, std::string* page) const {
    const std::string name = Escaped(record["name"].get<std::string>());
    const std::string file = Escaped(record["files"][0]["path"].get<std::string>());
    absl::StrAppend(page, "<figure>", Picture(record, place), "<figcaption>");
    // A file in a shard has no link.
    if (identity_.packing == Packing::kNone) {
      absl::StrAppend(page, "<a href=\"", file, "\">", name, "</a>");
    } else {
      absl::StrAppend(page, "<span>", name, "</span>");
    }
    absl::StrAppend(page, "<span class=\"asked\">", Escaped(LabelsText(record)),
                    "</span><span class=\"figures\">", FiguresText(record),
                    "</span></figcaption></figure>\n");
  }

  std::string Picture(const ordered_json& record, const SpoolPlace& place) const {
    const auto unread = [](absl::string_view why) {
      return absl::StrCat("<div class=\"unread\">", Escaped(why), "</div>");
    };
    const std::string model = record["model"];
    for (size_t i = 0; i < identity_.models.size(); ++i) {
      if (ModelText(identity_.models[i]) != model) continue;
      const motion::Skeleton& skeleton = identity_.skeletons[i];
      const auto read = [&](size_t file) { return items_.Read(record, place, file); };
      const absl::StatusOr<motion::ClipPair> pair = ReadStoredPair(read, record, skeleton);
      return pair.ok() ? PoseStrip(*pair, skeleton) : unread(pair.status().message());
    }
    return unread(model + " is not a model of the job");
  }

  const JobIdentity& identity_;
  const ItemReader& items_;
  std::map<std::string, Sample> samples_;
  int64_t total_ = 0;
};

}  // namespace

absl::Status WriteContactSheet(const JournalReader& journal, const JobIdentity& identity,
                               const ItemReader& items, const std::filesystem::path& out) {
  Sheet sheet(identity, items);
  absl::Status status =
      journal.ForEach([&sheet](const JournalEntry& entry) { return sheet.Add(entry); });
  if (!status.ok()) return status;
  return ReplaceDurably(out / "contact_sheet.html", sheet.Page());
}

}  // namespace duet::client::batch
