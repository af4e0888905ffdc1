#ifndef DUET_MODEL_EVALUATION_REPORT_RENDER_PNG_H_
#define DUET_MODEL_EVALUATION_REPORT_RENDER_PNG_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"

namespace duet::evaluation::report {

// Renders an SVG file as PNG on white, at 300 dots an inch (an SVG pixel is 1/96 inch), with
// `program`, which is looked for in PATH: Debian's rsvg-convert.
// Errors: NOT_FOUND when the program is not installed; INTERNAL when it fails.
absl::Status RenderPng(const std::filesystem::path& svg, const std::filesystem::path& png,
                       const std::string& program = "rsvg-convert");

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_RENDER_PNG_H_
