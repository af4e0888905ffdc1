#include "client/cli/batch_plan.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/batch/durable_file.h"
#include "client/batch/leader_source.h"
#include "client/batch/manifest.h"

namespace duet::client::cli {
namespace {

// Reads a manifest and owns its open file.
class OpenManifest final : public batch::LeaderSource {
 public:
  // Relative paths begin at `folder`; errors call the manifest `name`.
  OpenManifest(const std::filesystem::path& path, const std::filesystem::path& folder,
               const std::string& name)
      : file_(path), source_(batch::ReadManifest(file_, folder, name)) {}
  bool ok() const { return file_.is_open(); }
  absl::StatusOr<std::optional<batch::LeaderEntry>> Next() override { return source_->Next(); }

 private:
  std::ifstream file_;
  std::unique_ptr<batch::LeaderSource> source_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<batch::LeaderSource>> OpenLeaders(
    const BatchArguments& arguments, const batch::Recipe& recipe, std::istream* in,
    std::vector<std::string>* passed_over) {
  if (arguments.manifest.empty()) {
    return batch::ListLeaders(arguments.leaders, recipe.input.reading.format, passed_over);
  }
  const bool copied = !arguments.manifest_copy.empty();
  if (arguments.manifest == "-" && !copied) {
    if (in == nullptr)
      return absl::NotFoundError("--manifest -: expected a list of leaders, got no standard input");
    return batch::ReadManifest(*in, "", "-");
  }
  const std::filesystem::path given(arguments.manifest);
  auto manifest =
      copied ? std::make_unique<OpenManifest>(arguments.manifest_copy, "", arguments.manifest)
             : std::make_unique<OpenManifest>(given, given.parent_path(), arguments.manifest);
  if (!manifest->ok()) {
    return absl::NotFoundError(absl::StrCat(arguments.manifest, ": cannot be opened"));
  }
  return std::unique_ptr<batch::LeaderSource>(std::move(manifest));
}

absl::StatusOr<batch::Plan> MakePlan(const BatchArguments& arguments, const batch::Recipe& recipe,
                                     const std::vector<ModelInfo>& models, std::istream* in,
                                     std::vector<std::string>* passed_over) {
  absl::StatusOr<std::unique_ptr<batch::LeaderSource>> leaders =
      OpenLeaders(arguments, recipe, in, passed_over);
  if (!leaders.ok()) return leaders.status();
  return batch::Plan::Create(recipe, models, *std::move(leaders));
}

absl::Status CopyManifest(const std::filesystem::path& folder, std::istream* in,
                          BatchArguments* arguments) {
  if (arguments->manifest != "-" || in == nullptr) return absl::OkStatus();
  arguments->manifest_copy = folder / "manifest";
  std::ofstream copy(arguments->manifest_copy, std::ios::binary);
  // operator<< fails if the source is empty.
  if (in->peek() != std::istream::traits_type::eof()) copy << in->rdbuf();
  copy.close();
  return copy ? absl::OkStatus() : batch::CannotWrite(arguments->manifest_copy, errno);
}

}  // namespace duet::client::cli
