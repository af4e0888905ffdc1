#ifndef DUET_CLIENT_BATCH_RECIPE_DIFFERENCE_H_
#define DUET_CLIENT_BATCH_RECIPE_DIFFERENCE_H_

#include <string>

namespace duet::client::batch {

// How two recipes differ, each as Recipe::json: 'seed: expected 7, got 9; output.formats[1]:
// expected none, got "FORMAT_CSV"', the first five fields and the number of the others. Empty if
// they are equal, or if one of them is not a JSON object.
std::string DescribeDifference(const std::string& expected, const std::string& got);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECIPE_DIFFERENCE_H_
