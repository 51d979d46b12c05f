// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/travel.h"

namespace vernier::model {

std::size_t rows_outside_travel(const Axis& axis, const Eigen::Ref<const Eigen::ArrayXd>& positions,
                                std::size_t* first) {
  if (!axis.min || !axis.max) return 0;
  const double slack = kTravelSlack * (*axis.max - *axis.min);
  std::size_t outside = 0;
  for (Eigen::Index row = 0; row < positions.size(); ++row)
    if (positions[row] < *axis.min - slack || positions[row] > *axis.max + slack)
      if (outside++ == 0 && first != nullptr) *first = static_cast<std::size_t>(row);
  return outside;
}

}  // namespace vernier::model
