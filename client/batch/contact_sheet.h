#ifndef DUET_CLIENT_BATCH_CONTACT_SHEET_H_
#define DUET_CLIENT_BATCH_CONTACT_SHEET_H_

#include <filesystem>

#include "absl/status/status.h"
#include "client/batch/item_files.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"

namespace duet::client::batch {

// Writes <out>/contact_sheet.html, a self-contained page with a strip of poses for some items of
// each class (by the largest weight). Items are chosen by their ids, so the same data set has the
// same page. Items that cannot be read show the error instead. ABORTED if the page cannot be
// written.
absl::Status WriteContactSheet(const JournalReader& journal, const JobIdentity& identity,
                               const ItemReader& items, const std::filesystem::path& out);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_CONTACT_SHEET_H_
