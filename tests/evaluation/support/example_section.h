#ifndef DUET_TESTS_EVALUATION_SUPPORT_EXAMPLE_SECTION_H_
#define DUET_TESTS_EVALUATION_SUPPORT_EXAMPLE_SECTION_H_

#include <string>

#include "model/evaluation/report/result_section.h"

namespace duet::test {

// A section with id `id` and one of everything: texts that need escaping, a table with best,
// missing and printed figures, a figure "<id>_curve", settings.
evaluation::report::ResultSection ExampleSection(const std::string& id);

}  // namespace duet::test

#endif  // DUET_TESTS_EVALUATION_SUPPORT_EXAMPLE_SECTION_H_
