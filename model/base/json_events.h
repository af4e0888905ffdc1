#ifndef DUET_MODEL_BASE_JSON_EVENTS_H_
#define DUET_MODEL_BASE_JSON_EVENTS_H_

#include <nlohmann/json.hpp>
#include <string_view>

namespace duet::base {

// Reads a JSON document several times as fast as nlohmann::json::sax_parse, which spends most of
// its time on single bytes of numbers and long strings. Calls `events` as that function does, with
// the same values to the bit; the text of a number_float is empty.
//
// Returns false after an event that returned false, and for a text that it cannot read: one that is
// not JSON, begins with a byte order mark, or has a NUL or a number beyond the range of double.
// Never calls parse_error: to tell these cases apart, and for the place of an error, call sax_parse
// with new `events`.
bool ReadJsonEvents(std::string_view text, nlohmann::json_sax<nlohmann::json>* events);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_JSON_EVENTS_H_
