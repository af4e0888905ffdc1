#ifndef DUET_MODEL_TRAINING_CLASS_FITS_H_
#define DUET_MODEL_TRAINING_CLASS_FITS_H_

#include <vector>

#include "model/dataset/dataset.h"
#include "model/engine/model_description.h"

// How the people of each class of a data set meet, by captured sequences.

namespace duet::training {

// Adds the classes in which people meet an offered hand.
void FindContacts(const dataset::Dataset& dataset, const std::vector<int>& sequences,
                  engine::ModelDescription* model);

// The classes in which the follower faces its leader.
std::vector<engine::FacingClass> FindFacingClasses(const dataset::Dataset& dataset,
                                                   const std::vector<int>& sequences);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_CLASS_FITS_H_
