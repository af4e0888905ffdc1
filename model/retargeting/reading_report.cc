#include "model/retargeting/reading_report.h"

namespace duet::retargeting {

absl::string_view OriginName(Origin origin) {
  switch (origin) {
    case Origin::kGiven:
      return "given";
    case Origin::kFile:
      return "file";
    case Origin::kGuessed:
      return "guessed";
    case Origin::kDefault:
      return "default";
  }
  return "";
}

}  // namespace duet::retargeting
