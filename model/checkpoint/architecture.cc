#include "model/checkpoint/architecture.h"

#include <array>
#include <cstddef>
#include <variant>

#include "model/checkpoint/architecture_json.h"
#include "model/checkpoint/manifest.h"
#include "model/checkpoint/names.h"

namespace duet::checkpoint {
namespace {

using Reader = Architecture (*)(base::ObjectReader*);

template <typename T>
Architecture ReadAs(base::ObjectReader* reader) {
  T architecture;
  ReadFields(reader, &architecture);
  return architecture;
}

// One row for each alternative of the variant, by kind.
template <typename... T>
constexpr std::array<Named<Reader>, sizeof...(T)> Rows(const std::variant<T...>* /*type*/) {
  return {Named<Reader>{T::kKind, &ReadAs<T>}...};
}

constexpr auto kReaders = Rows(static_cast<const Architecture*>(nullptr));

}  // namespace

Architecture ReadArchitecture(bool has_kind, base::ObjectReader* reader) {
  if (!has_kind) return ReadAs<PaperArchitecture>(reader);
  const Reader read = ReadNamed(reader, kArchitectureKind, kReaders);
  return reader->ok() ? read(reader) : Architecture();
}

nlohmann::ordered_json ToJson(const Architecture& architecture) {
  return std::visit([](const auto& one) { return ToJson(one); }, architecture);
}

std::string_view Summary(const Architecture& architecture) {
  return std::visit([](const auto& one) { return one.kSummary; }, architecture);
}

void SetArchitecture(const Architecture& architecture, Manifest* manifest) {
  manifest->architecture = architecture;
  std::visit(
      [manifest](const auto& one) {
        manifest->model.samples = one.kSamples;
        manifest->model.accepts_follower_start = one.AcceptsFollowerStart();
        manifest->model.labels_guide = one.LabelsGuide();
      },
      architecture);
}

int StartFeatureCount(const motion::Skeleton& skeleton) {
  constexpr int kCoordinates = 3;
  constexpr int kFlags = 2;  // root known, pose known
  return kCoordinates + kCoordinates * skeleton.joint_count() + kFlags;
}

std::vector<TensorSpec> ExpectedTensors(const Manifest& manifest) {
  return std::visit([&manifest](const auto& one) { return Tensors(manifest, one); },
                    manifest.architecture);
}

}  // namespace duet::checkpoint
