#include "client/cli/batch_plan.h"

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/batch/leader_source.h"
#include "client/batch/manifest.h"

namespace duet::client::cli {
namespace {

// A manifest's file, open as long as it is read.
class OpenManifest final : public batch::LeaderSource {
 public:
  explicit OpenManifest(const std::string& path)
      : file_(path),
        source_(batch::ReadManifest(file_, std::filesystem::path(path).parent_path(), path)) {}
  bool ok() const { return file_.is_open(); }
  absl::StatusOr<std::optional<batch::LeaderEntry>> Next() override { return source_->Next(); }

 private:
  std::ifstream file_;
  std::unique_ptr<batch::LeaderSource> source_;
};

absl::StatusOr<std::unique_ptr<batch::LeaderSource>> OpenLeaders(
    const BatchArguments& arguments, const batch::Recipe& recipe, std::istream* in,
    std::vector<std::string>* passed_over) {
  if (arguments.manifest.empty()) {
    return batch::ListLeaders(arguments.leaders, recipe.input.format, passed_over);
  }
  if (arguments.manifest == "-") {
    if (in == nullptr) return absl::NotFoundError("--manifest -: there is no standard input");
    return batch::ReadManifest(*in, "", "-");
  }
  auto manifest = std::make_unique<OpenManifest>(arguments.manifest);
  if (!manifest->ok()) {
    return absl::NotFoundError(absl::StrCat(arguments.manifest, ": cannot be opened"));
  }
  return std::unique_ptr<batch::LeaderSource>(std::move(manifest));
}

}  // namespace

absl::StatusOr<batch::Plan> MakePlan(const BatchArguments& arguments, const batch::Recipe& recipe,
                                     const std::vector<ModelInfo>& models, std::istream* in,
                                     std::vector<std::string>* passed_over) {
  absl::StatusOr<std::unique_ptr<batch::LeaderSource>> leaders =
      OpenLeaders(arguments, recipe, in, passed_over);
  if (!leaders.ok()) return leaders.status();
  return batch::Plan::Create(recipe, models, *std::move(leaders));
}

Counting::Counting(absl::StatusOr<batch::Plan> plan, const batch::Shard& shard, int64_t limit) {
  if (!plan.ok()) return;
  thread_ = std::thread([this, shard, limit, plan = *std::move(plan)]() mutable {
    int64_t count = 0;
    for (int64_t i = 0; i < limit && !ended_; ++i) {
      const absl::StatusOr<std::optional<batch::Item>> item = plan.Next();
      if (!item.ok() || ended_) return;
      if (!item->has_value()) break;
      if (shard.Has((*item)->id)) ++count;
    }
    if (!ended_) total_ = count;
  });
}

Counting::~Counting() {
  ended_ = true;
  if (thread_.joinable()) thread_.join();
}

}  // namespace duet::client::cli
