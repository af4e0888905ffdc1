#ifndef DUET_MODEL_EVALUATION_REPORT_MARKUP_H_
#define DUET_MODEL_EVALUATION_REPORT_MARKUP_H_

#include <string>

namespace duet::evaluation::report {

// Text that reads as itself in each format. Whatever the report writes passes through one of these,
// but for JSON, which nlohmann's library writes.

// Within GitHub's Markdown, also in a cell of a table; control characters become blanks.
std::string EscapeMarkdown(const std::string& text);

// In an element or a quoted attribute of HTML or SVG; control characters are dropped.
std::string EscapeMarkup(const std::string& text);

// As one field of a CSV file: in quotes where it needs them. Source: RFC 4180.
std::string EscapeCsv(const std::string& text);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_MARKUP_H_
