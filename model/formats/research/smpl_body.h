#ifndef DUET_MODEL_FORMATS_RESEARCH_SMPL_BODY_H_
#define DUET_MODEL_FORMATS_RESEARCH_SMPL_BODY_H_

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/formats/research/npz_archive.h"
#include "model/formats/research/placement.h"

namespace duet::formats::research {

// The joints of a body model of the SMPL family (SMPL, SMPL+H, SMPL-X) at rest, for a person's
// shape: J_regressor (v_template + shapedirs betas), of which the 22 joints of BodySkeleton() are
// returned, in metres. `model` is the user's own .npz with these arrays:
//
//   v_template    [vertices, 3]
//   shapedirs     [vertices, 3, shapes]; needed only for betas other than 0
//   J_regressor   [joints >= 22, vertices], dense
//   kintree_table [2, joints]; its first row has the parents
//
// Betas beyond the model's shapes are ignored.
//
// Source: Loper et al. 2015, "SMPL: a skinned multi-person linear model", equations 8 and 10.
// Errors: INVALID_ARGUMENT naming the file, the array, the expected value and the actual one.
absl::StatusOr<BodyPose> RestJoints(const NpzArchive& model, absl::Span<const double> betas);

}  // namespace duet::formats::research

#endif  // DUET_MODEL_FORMATS_RESEARCH_SMPL_BODY_H_
