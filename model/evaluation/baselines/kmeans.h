#ifndef DUET_MODEL_EVALUATION_BASELINES_KMEANS_H_
#define DUET_MODEL_EVALUATION_BASELINES_KMEANS_H_

#include <cstdint>
#include <vector>

#include "model/evaluation/baselines/motion_matrix.h"

namespace duet::evaluation::baselines {

// Centres of clusters of rows: k-means++ seeding (Arthur, Vassilvitskii 2007), then Lloyd's
// iterations until nothing changes. At most `clusters` centres, fewer if there are fewer distinct
// rows. The same seed gives the same centres.
Rows KMeans(const Rows& rows, int clusters, uint64_t seed);

// The index of the centre nearest to a row.
int NearestCentre(const Rows& centres, const Eigen::RowVectorXd& row);
// The same for every row.
std::vector<int> NearestCentres(const Rows& centres, const Rows& rows);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_KMEANS_H_
