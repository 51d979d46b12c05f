// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/fit/fit.h"

namespace vernier::fit {

/// Something that the readings left open and the convention settled.
struct Decision {
  std::vector<std::string> parameters;  // a table's column by one name: `table.Z.rX`
  double reach_um =
      0;  // how far it may move the tool at the edge of the measured box, one standard uncertainty
  std::string sentence;
};

/// What the convention decided, largest reach first, at most `most`. Set-ups are left out: where the
/// measuring frame stands is nobody's error. tool.
std::vector<Decision> decisions_of(const FitResult& result, std::size_t most = 10);

}  // namespace vernier::fit
