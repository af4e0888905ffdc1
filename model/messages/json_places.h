#ifndef DUET_MODEL_MESSAGES_JSON_PLACES_H_
#define DUET_MODEL_MESSAGES_JSON_PLACES_H_

#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "model/messages/field_places.h"

namespace duet::messages {

// The places of the fields of a JSON text's root object.
struct JsonPlaces {
  struct Element {
    std::string key;
    Place place;  // of the key
    // If the value is an array, the place of each item: where an object or array begins, and the
    // key's place for every other item.
    std::vector<Place> elements;
  };
  std::vector<Element> keys;  // in the order of the text, repeated keys included
  // The first syntax error and its place; empty if there is none.
  std::string error;
  Place error_place;
};

// Scans a text without building a document. More than a hundred levels of nesting are an error.
JsonPlaces FindJsonPlaces(absl::string_view text);

}  // namespace duet::messages

#endif  // DUET_MODEL_MESSAGES_JSON_PLACES_H_
