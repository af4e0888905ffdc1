#ifndef DUET_TESTS_BASE_JSON_EVENT_COMPARISON_H_
#define DUET_TESTS_BASE_JSON_EVENT_COMPARISON_H_

#include <string>
#include <string_view>

namespace duet::base::test {

// Reads a text with ReadJsonEvents and with nlohmann::json::sax_parse. Returns "" if both read the
// same events, or both reject it, or only the first rejects it for a reason that its contract
// names; else the difference.
std::string CompareJsonEvents(std::string_view text);

}  // namespace duet::base::test

#endif  // DUET_TESTS_BASE_JSON_EVENT_COMPARISON_H_
