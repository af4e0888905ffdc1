#ifndef DUET_CLIENT_VIEWER_PAGE_PARTS_H_
#define DUET_CLIENT_VIEWER_PAGE_PARTS_H_

#include <string>

#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "nlohmann/json_fwd.hpp"

// What both pages are put together from.

namespace duet::client::viewer {

// "{{TITLE}}", "{{STYLE}}", "{{DATA}}", "{{SCRIPT}}" of a page and three.js filled in.
struct PageParts {
  absl::string_view index;
  std::string title;
  std::string style;
  std::string data;  // JSON of SafeJson
  std::string script;
};
std::string FillPage(const PageParts& parts);

// The text of embedded files.
inline absl::string_view Embedded(const char* begin, const char* end) {
  return {begin, static_cast<size_t>(end - begin)};
}

// JSON that is safe inside <script>, whatever the names in it hold.
std::string SafeJson(const nlohmann::json& data);

// Positions [frames, joints, 3] as base64 of little-endian float32.
std::string EncodePositions(const motion::Clip& clip);

// Scripts that both pages share: what moves, how it looks, what time it is.
std::string SharedScript();
absl::string_view SharedStyle();

}  // namespace duet::client::viewer

#endif  // DUET_CLIENT_VIEWER_PAGE_PARTS_H_
