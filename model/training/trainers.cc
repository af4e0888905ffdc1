#include "model/training/trainers.h"

#include <type_traits>
#include <utility>
#include <variant>

#include "model/training/flow_trainer.h"
#include "model/training/paper_trainer.h"

namespace duet::training {
namespace {

// The trainer of each method: its registration. Without a line here, a method does not compile.
template <typename Method>
struct TrainerOf;
template <>
struct TrainerOf<PaperTraining> {
  using Type = PaperTrainer;
};
template <>
struct TrainerOf<FlowTraining> {
  using Type = FlowTrainer;
};

}  // namespace

std::unique_ptr<EpochTrainer> MakeTrainer(const TrainingOptions& options,
                                          const checkpoint::Manifest& manifest,
                                          const dataset::Dataset& dataset, std::vector<int> train,
                                          std::vector<int> validation) {
  return std::visit(
      [&](const auto& method) -> std::unique_ptr<EpochTrainer> {
        using Trainer = typename TrainerOf<std::decay_t<decltype(method)>>::Type;
        return std::make_unique<Trainer>(options, manifest, dataset, std::move(train),
                                         std::move(validation));
      },
      options.method);
}

}  // namespace duet::training
