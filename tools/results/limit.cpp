// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/limit.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::results {
namespace {

/// Squares of what counts together: the coordinates of a row, or one other reading.
using Together = std::map<std::pair<std::size_t, std::size_t>, double>;

Together together_of(const model::Measurement& m, const Eigen::VectorXd& residual, bool rotation,
                     bool check) {
  Together together;
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    if (model::is_rotation(o.kind) != rotation || (m.check[o.row] != 0) != check) continue;
    const auto kind = static_cast<std::size_t>(o.kind);
    const std::size_t group = kind < 6 ? 0 : 1 + kind;
    together[{o.row, group}] += std::pow(residual[static_cast<Eigen::Index>(i)], 2);
  }
  return together;
}

double u_of(const model::Measurement& m, std::size_t row, bool rotation) {
  const auto at = static_cast<Eigen::Index>(row);
  const double angle = rotation && m.angle_uncertainty.size() > 0 ? m.angle_uncertainty[at] : 0;
  const double u = angle > 0 ? angle : m.uncertainty[at];
  if (!(u > 0))
    throw text::InputError({m.files[m.file[row]], m.line[row]}, format::columns::kUncertainty,
                           "the limit is in units of u, but this row has no standard uncertainty u");
  return u;
}

}  // namespace

ResidualLimit residual_limit(const std::string& words) {
  ResidualLimit limit;
  limit.words = words;
  std::string rest = words;
  if (rest.starts_with("rms=")) limit.rms = true, rest = rest.substr(4);
  const std::size_t end = std::min(rest.find_first_not_of("0123456789."), rest.size());
  const auto number = text::parse_number(rest.substr(0, end));
  const std::string unit = rest.substr(end);
  const auto found = format::find_unit(unit);
  limit.of_u = unit == format::columns::kUncertainty;
  limit.rotation = found && found->dimension == format::Dimension::kAngle;
  if (!number || !(*number > 0) ||
      !(limit.of_u || limit.rotation || (found && found->dimension == format::Dimension::kLength)))
    throw text::InputError({}, words,
                           "a limit is of the form 2u, 25um, 0.2mm or 0.025deg; rms=1.5u tests the rms");
  limit.value = *number * (limit.of_u ? 1 : found->factor);
  return limit;
}

nlohmann::ordered_json judge_residuals(const model::Measurement& m, const Eigen::VectorXd& residual,
                                       const ResidualLimit& limit) {
  Together together = together_of(m, residual, limit.rotation, true);
  const bool check = !together.empty();
  if (!check) together = together_of(m, residual, limit.rotation, false);
  if (together.empty())
    throw text::InputError(
        {}, limit.words,
        limit.rotation ? "the measurement has no orientation reading" : "no reading of a length");
  constexpr double kPrinted = 1e3;  // um, mdeg
  double shares = 0, squares = 0, worst = -1;
  std::size_t beyond = 0, worst_row = 0;
  for (const auto& [group, square] : together) {
    const double allowed = limit.of_u ? limit.value * u_of(m, group.first, limit.rotation) : limit.value;
    const double share = std::sqrt(square) / allowed;
    shares += share * share, squares += square;
    if (share > 1) ++beyond;
    if (share > worst) worst = share, worst_row = group.first;
  }
  const auto count = static_cast<double>(together.size());
  const double rms_share = std::sqrt(shares / count);
  const double allowed = limit.of_u ? limit.value * u_of(m, worst_row, limit.rotation) : limit.value;
  return {{"limit", limit.words},
          {"of", limit.rms ? "rms" : "largest"},
          {"role", check ? "check" : "fit"},
          {"rows", together.size()},
          {"beyond", beyond},
          {"unit", limit.rotation ? "mdeg" : "um"},
          {"rms", std::sqrt(squares / count) * kPrinted},
          {"share_of_limit", limit.rms ? rms_share : worst},
          {"worst",
           {{"file", m.files[m.file[worst_row]]},
            {"line", m.line[worst_row]},
            {"value", worst * allowed * kPrinted},
            {"limit", allowed * kPrinted}}},
          {"pass", limit.rms ? rms_share <= 1 : beyond == 0}};
}

}  // namespace vernier::results
