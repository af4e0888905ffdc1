#ifndef DUET_MODEL_MESSAGES_JSON_PLACES_H_
#define DUET_MODEL_MESSAGES_JSON_PLACES_H_

#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "model/messages/field_places.h"

namespace duet::messages {

// What a JSON text is made of, as far as its outermost object goes.
struct JsonPlaces {
  struct Element {
    std::string key;
    Place place;                  // of the key
    std::vector<Place> elements;  // of a value that is an array: where its items begin; of numbers
                                  // and words: where the key is
  };
  std::vector<Element> keys;  // in the order of the text; a repeated key each time
  // What is no JSON, and where; empty where all is.
  std::string error;
  Place error_place;
};

// Walks a text without keeping it. Nesting beyond a hundred levels is an error.
JsonPlaces FindJsonPlaces(absl::string_view text);

}  // namespace duet::messages

#endif  // DUET_MODEL_MESSAGES_JSON_PLACES_H_
