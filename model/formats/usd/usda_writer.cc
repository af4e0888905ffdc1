#include "model/formats/usd/usda_writer.h"

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"

namespace duet::formats::usd {
namespace {

constexpr std::size_t kIndent = 4;

}  // namespace

std::string PrimName(absl::string_view name) {
  std::string prim;
  for (const char c : name) prim += absl::ascii_isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (prim.empty() || absl::ascii_isdigit(static_cast<unsigned char>(prim[0]))) prim = "_" + prim;
  return prim;
}

std::string UsdString(absl::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      absl::StrAppendFormat(&quoted, "\\x%02x", byte);
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string UsdNumber(double value) {
  std::string text;
  base::AppendNumber(&text, static_cast<float>(value) + 0.0f);  // no minus before zero
  return text;
}

std::string UsdVector(retargeting::Vec3d a) {
  return absl::StrCat("(", UsdNumber(a.x), ", ", UsdNumber(a.y), ", ", UsdNumber(a.z), ")");
}

std::string UsdTurn(retargeting::Quaternion q) {
  return absl::StrCat("(", UsdNumber(q.w), ", ", UsdNumber(q.x), ", ", UsdNumber(q.y), ", ",
                      UsdNumber(q.z), ")");
}

std::string UsdTranslation(retargeting::Vec3d by) {
  return absl::StrCat("((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (", UsdNumber(by.x), ", ",
                      UsdNumber(by.y), ", ", UsdNumber(by.z), ", 1))");
}

std::string UsdArray(const std::vector<std::string>& values) {
  return absl::StrCat("[", absl::StrJoin(values, ", "), "]");
}

UsdaWriter::UsdaWriter() : text_("#usda 1.0\n") {}

void UsdaWriter::Line(absl::string_view text) {
  text_.append(kIndent * depth_, ' ');
  absl::StrAppend(&text_, text, "\n");
}

void UsdaWriter::Open(absl::string_view text, char bracket) {
  Line(absl::StrCat(text, text.empty() ? "" : " ", std::string(1, bracket)));
  ++depth_;
}

void UsdaWriter::Close(absl::string_view bracket) {
  --depth_;
  Line(bracket);
}

void UsdaWriter::TimeSamples(absl::string_view name, const std::vector<std::string>& values) {
  Open(absl::StrCat(name, ".timeSamples ="));
  for (std::size_t frame = 0; frame < values.size(); ++frame) {
    Line(absl::StrCat(frame, ": ", values[frame], ","));
  }
  Close();
}

}  // namespace duet::formats::usd
