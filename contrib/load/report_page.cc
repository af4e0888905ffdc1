#include "contrib/load/report_page.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"
#include "contrib/load/report.h"

// Linked in by duet_embed_file.
extern "C" {
extern const char duet_load_page[], duet_load_page_end[];
extern const char duet_load_style[], duet_load_style_end[];
extern const char duet_load_chart[], duet_load_chart_end[];
extern const char duet_load_script[], duet_load_script_end[];
}

namespace duet::contrib::load {
namespace {

absl::string_view Embedded(const char* begin, const char* end) {
  return {begin, static_cast<size_t>(end - begin)};
}

}  // namespace

std::string PageOf(const std::string& json) {
  // "</script>" inside a string would end the script. In JSON, "<" occurs only inside strings,
  // where it may be written as an escape.
  const std::string escaped = absl::StrReplaceAll(json, {{"<", "\\u003c"}});
  const std::string script = absl::StrCat(Embedded(duet_load_chart, duet_load_chart_end),
                                          Embedded(duet_load_script, duet_load_script_end));
  return absl::StrReplaceAll(Embedded(duet_load_page, duet_load_page_end),
                             {{"{{STYLE}}", Embedded(duet_load_style, duet_load_style_end)},
                              {"{{REPORT}}", escaped},
                              {"{{SCRIPT}}", script}});
}

std::string ToPage(const Report& report) { return PageOf(ToJson(report)); }

}  // namespace duet::contrib::load
