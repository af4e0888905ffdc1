#include "model/training/run_log.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace duet::training {
namespace {

constexpr char kColumns[] =
    "epoch,generator,reconstruction,bone,continuity,adversarial,discriminator,validation_afd,"
    "validation_afd_pose,seconds,whole_answers";
constexpr int kBarWidth = 24;

std::string Optional(double value) {
  return std::isnan(value) ? "" : absl::StrFormat("%.6f", value);
}

std::string Row(const EpochReport& r) {
  return absl::StrFormat("%d,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%s,%s,%.3f,%d", r.epoch, r.generator,
                         r.reconstruction, r.bone, r.continuity, r.adversarial, r.discriminator,
                         Optional(r.validation_afd), Optional(r.validation_afd_pose), r.seconds,
                         r.whole_answers ? 1 : 0);
}

absl::Status WriteText(const std::filesystem::path& file, const std::string& text,
                       std::ios::openmode mode) {
  std::ofstream out(file, mode);
  out << text;
  out.flush();
  if (out) return absl::OkStatus();
  return absl::InternalError(absl::StrCat(file.string(), ": cannot be written"));
}

}  // namespace

absl::Status RunLog::ResumeAt(int64_t epoch) {
  std::string kept = absl::StrCat(kColumns, "\n");
  std::ifstream in(file_);
  std::string line;
  std::getline(in, line);  // the column names
  while (std::getline(in, line)) {
    const int64_t row_epoch = std::strtoll(line.c_str(), nullptr, 10);
    if (row_epoch >= 1 && row_epoch <= epoch) absl::StrAppend(&kept, line, "\n");
  }
  return WriteText(file_, kept, std::ios::trunc);
}

absl::Status RunLog::Append(const EpochReport& report) {
  return WriteText(file_, Row(report) + "\n", std::ios::app);
}

std::string ProgressLine(const std::string& title, const EpochReport& report) {
  const int filled =
      static_cast<int>(kBarWidth * report.epoch / std::max<int64_t>(report.epochs, 1));
  const int64_t left =
      std::llround(static_cast<double>(report.epochs - report.epoch) * report.seconds);
  const std::string validation =
      std::isnan(report.validation_afd) ? "" : absl::StrFormat("  val %.4f", report.validation_afd);
  return absl::StrFormat("%s [%s%s] epoch %d/%d  loss %.4f%s  %d:%02d left", title,
                         std::string(static_cast<size_t>(filled), '#'),
                         std::string(static_cast<size_t>(kBarWidth - filled), '.'), report.epoch,
                         report.epochs, report.generator, validation, left / 60, left % 60);
}

}  // namespace duet::training
