#ifndef DUET_MODEL_EVALUATION_REPORT_MARKUP_H_
#define DUET_MODEL_EVALUATION_REPORT_MARKUP_H_

#include <string>

namespace duet::evaluation::report {

// Text that reads as itself within GitHub's Markdown, also in a cell of a table; line ends become
// blanks.
std::string EscapeMarkdown(const std::string& text);

// Text for an element or a quoted attribute of HTML or SVG: &, <, > and both quotes escaped,
// control characters dropped.
std::string EscapeMarkup(const std::string& text);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_MARKUP_H_
