#ifndef DUET_MODEL_MESSAGES_FIELD_PLACES_H_
#define DUET_MODEL_MESSAGES_FIELD_PLACES_H_

#include <map>
#include <string>

namespace duet::messages {

// A place in a text; line and column count from 1.
struct Place {
  int line = 1;
  int column = 1;
  friend bool operator<(const Place& a, const Place& b) {
    return a.line != b.line ? a.line < b.line : a.column < b.column;
  }
};

// Where a text sets a message's fields, by their names in the schema: "max_calls", and
// "version_labels[0]" for each element of a repeated field.
using FieldPlaces = std::map<std::string, Place>;

}  // namespace duet::messages

#endif  // DUET_MODEL_MESSAGES_FIELD_PLACES_H_
