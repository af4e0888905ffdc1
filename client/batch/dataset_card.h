#ifndef DUET_CLIENT_BATCH_DATASET_CARD_H_
#define DUET_CLIENT_BATCH_DATASET_CARD_H_

#include <filesystem>
#include <string>

#include "client/batch/dataset_json.h"
#include "client/batch/job_folder.h"
#include "client/batch/set_counts.h"

namespace duet::client::batch {

// README.md of a data set: a card for people, with the metadata that Hugging Face reads at its top.
// Source: https://huggingface.co/docs/hub/datasets-cards and datasets-manual-configuration.
std::string DatasetCard(const JobIdentity& identity, const SetCounts& counts,
                        const DoneItems& done);

inline constexpr char kCardFile[] = "README.md";

// Whether the folder has a card that `duet batch` does not replace: one without the line by which
// it recognises its own.
bool HasForeignCard(const std::filesystem::path& out);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_DATASET_CARD_H_
