// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "tools/fit/coverage/bow_of_plane.h"
#include "tools/fit/coverage/reading_direction.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/noise/contradicting_rows.h"
#include "tools/fit/sanity.h"
#include "tools/fit/size.h"
#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/maths/chance.h"
#include "tools/maths/median.h"
#include "tools/model/chain/travel.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Largest probability of such a residual by noise alone.
constexpr double kChanceOfSurvey = 0.001;
/// Limit of a residual in standard deviations. One bad reading is not a property of the machine.
constexpr double kMostSpreads = 5;

/// Squares of one direction's residuals, and of the noise in them.
struct Squares {
  double residual = 0, noise = 0;  // mm^2; the noise as far as the fit does not absorb it
  double chi = 0, freedom = 0;     // residual over u, and its expected value by noise alone
  std::size_t count = 0;
};

/// Squares of one role. The last of the four is for readings of no single direction.
std::array<Squares, 4> squares_of(const FitResult& result, const model::Measurement& m, bool check) {
  std::array<Squares, 4> all;
  std::array<std::vector<double>, 4> sizes;
  const double repeats_mm = 1e-3 * result.noise_um.value_or(0);
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < m.observations.size(); ++i) {
      const model::Observation& o = m.observations[i];
      if (model::is_rotation(o.kind) || (m.check[o.row] != 0) != check) continue;
      const Vector3d direction = reading_direction(result.machine, m, o);
      Index along = 3;
      if (direction.norm() > 0) direction.cwiseAbs().maxCoeff(&along);
      const double u = model::uncertainty_of(m, o) > 0 ? model::uncertainty_of(m, o) : repeats_mm;
      visit(static_cast<std::size_t>(along), i, u);
    }
  };
  each([&](std::size_t along, std::size_t i, double) {
    sizes[along].push_back(std::abs(result.residual[static_cast<Index>(i)]));
  });
  std::array<double, 4> spread{};
  for (std::size_t k = 0; k < 4; ++k) spread[k] = maths::robust_spread(sizes[k]);
  each([&](std::size_t along, std::size_t i, double u) {
    if (!(u > 0)) return;
    const double predicted =
        result.prediction_variance.size() > 0 ? result.prediction_variance[static_cast<Index>(i)] : 0;
    // In fit rows, the fit absorbs the share of the noise that its own prediction has. In check
    // rows, the uncertainty of the fit is added to the noise.
    const double weighed = u * result.factor_of(m.file[m.observations[i].row]);
    const double taken =
        std::min(1.0, predicted / (weighed * weighed * std::max(1.0, result.variance_factor)));
    const double unit = check ? u * u + predicted : u * u, left = check ? 1 : 1 - taken;
    const double most = kMostSpreads * std::max(u, spread[along]);
    const double square = std::pow(std::min(std::abs(result.residual[static_cast<Index>(i)]), most), 2);
    all[along].residual += square;
    all[along].noise += left * unit;
    all[along].chi += square / unit;
    all[along].freedom += left;
    ++all[along].count;
  });
  return all;
}

/// Returns the variance beyond the noise; 0 if chance explains it.
double excess(const Squares& one) {
  if (one.freedom < 1 || maths::chi_square_tail(one.chi, one.freedom) > kChanceOfSurvey / 3) return 0;
  return std::max(0.0, (one.residual - one.noise) / one.freedom);
}

/// Returns the share of the check rows whose commanded pose is that of a fit row.
double repeated_poses(const model::Measurement& m) {
  std::vector<model::Column> axes;
  for (std::size_t a = 0; a < m.states.axis.size(); ++a) axes.push_back(model::commanded(m, a));
  const auto pose = [&](std::size_t row) { return rounded_values(axes, row); };
  std::set<std::vector<std::int64_t>> fitted;
  for (std::size_t row = 0; row < m.rows(); ++row)
    if (m.check[row] == 0) fitted.insert(pose(row));
  std::size_t checks = 0, repeats = 0;
  for (std::size_t row = 0; row < m.rows(); ++row) {
    if (m.check[row] == 0) continue;
    ++checks;
    repeats += fitted.count(pose(row));
  }
  return checks > 0 ? static_cast<double>(repeats) / static_cast<double>(checks) : 0;
}

/// Returns the root of chi square over its degrees of freedom, of the fit rows' lengths.
double times_the_noise(const FitResult& result) {
  if (!result.after.rms_um || !result.noise_um || result.freedom <= 0) return 0;
  return *result.after.rms_um / *result.noise_um *
         std::sqrt(static_cast<double>(result.before.count) / result.freedom);
}

std::string unvaried_text(const model::FitRecord& record) {
  std::string text;
  constexpr std::size_t kMost = 3;  // number of names in a sentence
  for (std::size_t i = 0; i < record.unvaried.size() && i < kMost; ++i) {
    const model::FitRecord::Unvaried& one = record.unvaried[i];
    text += fmt::format("{}{} was determined ", i > 0 ? "; " : "", one.coefficient);
    text += one.follows.empty()
                ? fmt::format("at {} = {:.6g} only", one.variable, one.at)
                : fmt::format("only where {} changed together with {}", one.variable, one.follows);
  }
  if (record.unvaried.size() > kMost) text += fmt::format("; and {} more", record.unvaried.size() - kMost);
  return text + ". The effect was not measured at other values of these variables.";
}

std::string alternatives_text(const model::FitRecord& record) {
  const model::FitRecord::Alternative& one = record.alternatives.front();
  const std::string place = fmt::format("{} of transform {}", model::kSixDofNames[one.dof], one.transform);
  std::string text =
      one.axis.empty()
          ? fmt::format(
                "The readings do not distinguish the rotation {} from a shift, because only one tool was "
                "used.",
                place)
          : fmt::format(
                "The readings do not distinguish the cyclic error in {} from a cyclic error of period {:.4g} "
                "along {}.",
                place, one.period, one.axis);
  if (record.alternatives.size() > 1) text += fmt::format(" And {} more.", record.alternatives.size() - 1);
  return text;
}

/// Returns the tips whose radius the fit did not change although it acts on the machine: tips that touched an
/// artefact of known radius or place. An unknown radius or place follows the tip.
std::string exact_tips(const FitResult& result, const model::Measurement& m) {
  std::set<std::string> names;
  for (const model::Thing& thing : m.things) {
    const model::Artefact& artefact = thing.artefact;
    if (artefact.tip.empty() || !(artefact.radius || artefact.place)) continue;
    const bool is_free = std::any_of(result.parameters.begin(), result.parameters.end(),
                                     [&](const model::Parameter& one) { return one.name == artefact.tip; });
    if (!is_free) names.insert(artefact.tip);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Returns the names of the touched artefacts for which `is_exact` is true.
template <class IsExact>
std::string names_where(const model::Measurement& m, const IsExact& is_exact) {
  std::set<std::string> names;
  for (const model::Thing& thing : m.things)
    if (is_exact(thing.artefact)) names.insert(thing.label);
  return fmt::format("{}", fmt::join(names, ", "));
}
std::string exact_radii(const model::Measurement& m) {
  return names_where(m, [](const model::Artefact& one) { return one.radius && one.u_radius <= 0; });
}
std::string exact_directions(const model::Measurement& m) {
  return names_where(m, [](const model::Artefact& one) { return one.direction.has_value(); });
}

/// Returns the inputs in units of length that differ between the touches, as those of two tools.
std::string varied_lengths(const model::Machine& machine, const model::Measurement& m) {
  std::set<std::string> names;
  if (m.things.empty()) return {};
  for (std::size_t i = 0; i < machine.inputs.size(); ++i) {
    const auto unit = format::find_unit(machine.inputs[i].unit);
    if (!unit || unit->dimension != format::Dimension::kLength || i >= m.states.input.size()) continue;
    const model::Column& values = m.states.input[i];
    if (values.size() > 0 && values.maxCoeff() > values.minCoeff()) names.insert(machine.inputs[i].name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The normal of a touched plane in workpiece coordinates, as the fit estimated it.
Vector3d normal_of(const FitResult& result, const std::string& plane) {
  for (const ThingEstimate& thing : result.things)
    if (thing.name == plane && !thing.in_measuring_frame && thing.direction) return *thing.direction;
  return Vector3d::UnitZ();
}

/// Returns the names of the planes of unknown position that a probe beside the tool point touched, if no
/// other reading determines a bow of the axes over the plane. Then a bow of the plane gives nearly the same
/// readings as an axis that is not straight: the bow is at the touched point, the error of the axis at its
/// position.
std::string planes_of_probe(const FitResult& result, const model::Measurement& m) {
  std::set<std::string> names;
  for (std::size_t row = 0; row < m.rows(); ++row) {
    const std::size_t thing = m.thing_of(row);
    if (m.check[row] != 0 || thing == model::kNoThing ||
        m.things[thing].artefact.type != model::ArtefactType::kPlane || m.things[thing].in_measuring_frame())
      continue;
    for (const char* const column : format::columns::kProbe)
      if (const auto input = result.machine.find_input(column))
        if (m.states.input[*input][static_cast<Index>(row)] != 0) names.insert(m.things[thing].label);
  }
  std::erase_if(names, [&](const std::string& name) {
    return bow_is_read(result.machine, m, name, normal_of(result, name));
  });
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Findings about lengths that give the machine its size and whose own errors no reading of this fit shows.
void add_exact_lengths(const FitResult& result, const model::Measurement& m,
                       std::vector<model::FitRecord::Finding>& list) {
  constexpr const char* kCode = "taken-as-exact";
  if (const std::string tips = exact_tips(result, m); !tips.empty())
    list.push_back(
        {kCode, 0,
         fmt::format("The radius of the tip ({0}) was taken as exact. Its error changes every touched "
                     "radius, and through it the scales of the machine. To include its standard "
                     "uncertainty u in mm, add --free {0} --prior {0}=u.",
                     tips)});
  if (const std::string names = exact_directions(m); !names.empty())
    list.push_back({kCode, 0,
                    fmt::format("The direction of {} was taken as exact: an error of 1 mrad in it acts as an "
                                "error of 1 mrad of the machine.",
                                names)});
  if (const std::string names = varied_lengths(result.machine, m); !names.empty())
    list.push_back(
        {kCode, 0,
         fmt::format("The values of {} were taken as exact: an error of their difference acts as an "
                     "error of the machine.",
                     names)});
  if (!result.size || !result.size->known) return;
  if (const std::string names = exact_radii(m); result.size->from == "known radius" && !names.empty())
    list.push_back(
        {kCode, 0,
         fmt::format("The radius of {} was taken as exact: an error of 1 % in it is an error of 1 % "
                     "in the size of the machine. To include its uncertainty, state uradius.",
                     names)});
  // Without a standard uncertainty no free parameter changes the size: the scales of linear axes are known.
  if (result.size->from == "machine" && result.size->relative_std > 0)
    list.push_back({kCode, 0, size_sentence(*result.size)});
  if (result.size->from == "board")
    list.push_back(
        {kCode, 0,
         "The size of the board was taken as exact: an error of 1 % in it is an error of 1 % in the "
         "size of the machine."});
}

/// A sentence about the directions of which model_discrepancy() knows nothing; empty if there are none.
std::string unread_in_words(const FitResult& result, const model::Measurement& m) {
  const auto fitted = squares_of(result, m, false), checked = squares_of(result, m, true);
  if (fitted[3].count + checked[3].count > 0) return {};  // readings of no single direction
  std::vector<std::string> names;
  for (std::size_t k = 0; k < 3; ++k)
    if (fitted[k].count + checked[k].count == 0) names.emplace_back(1, "xyz"[k]);
  if (names.empty()) return {};
  return fmt::format(" No reading is along {}: the mean of the other directions is assumed there.",
                     fmt::join(names, " or "));
}

/// Readings of an arm that agree with its nominal chain to the rounding of a display: the control computed
/// them from the joints.
void add_computed_positions(const FitResult& result, const model::Measurement& m,
                            std::vector<model::FitRecord::Finding>& list) {
  constexpr std::size_t kArm = 5;      // turning axes
  constexpr std::size_t kFewest = 30;  // readings: fewer can be fitted by the set-up
  constexpr double kRounding_um = 1;   // of a display in um; the errors of arms are hundreds of um
  const auto turning = std::count_if(result.machine.axes.begin(), result.machine.axes.end(),
                                     [](const model::Axis& axis) { return axis.rotary; });
  if (static_cast<std::size_t>(turning) < kArm || m.observations.size() < kFewest || !result.before.rms_um ||
      *result.before.rms_um >= kRounding_um)
    return;
  list.push_back(
      {"computed-positions", *result.before.rms_um,
       fmt::format("The readings agree with the nominal machine within {:.2g} um: probably they are "
                   "the positions that the control computes from its joints, and no measurement.",
                   *result.before.rms_um)});
}

/// The axes with one position in all rows of the fit: how the other errors change along them was not
/// measured.
void add_axes_that_stood(const model::Machine& machine, const model::FitRecord& record,
                         std::vector<model::FitRecord::Finding>& list) {
  std::string positions;
  std::size_t stood = 0, moved = 0;
  for (const model::FitRecord::Range& range : record.measured) {
    if (!machine.find_axis(range.name)) continue;
    if (range.max > range.min) {
      ++moved;
      continue;
    }
    ++stood;
    positions += fmt::format("{}{} at {:g}", positions.empty() ? "" : ", ", range.name, range.min);
  }
  if (stood == 0 || moved == 0) return;
  list.push_back(
      {kStoodStill, static_cast<double>(stood),
       fmt::format("{} stood still in all rows ({}): the correction of the other axes is known at this "
                   "position only.",
                   stood == 1 ? "One axis" : fmt::format("{} axes", stood), positions)});
}

/// The rows with a position outside the travel that the machine file states: the file is of another machine,
/// or the positions have another zero or unit.
void add_rows_outside_travel(const model::Machine& machine, const model::Measurement& m,
                             std::vector<model::FitRecord::Finding>& list) {
  std::string axes;
  std::size_t most = 0;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const std::size_t outside = model::rows_outside_travel(machine.axes[a], m.states.axis[a]);
    if (outside == 0) continue;
    most = std::max(most, outside);
    axes += fmt::format("{}{} ({:g} to {:g}) in {} rows", axes.empty() ? "" : ", ", machine.axes[a].name,
                        *machine.axes[a].min, *machine.axes[a].max, outside);
  }
  if (most == 0) return;
  list.push_back(
      {kOutsideTravel, static_cast<double>(most),
       fmt::format("Positions are outside the travel of the machine file: {}, of {} rows. The file "
                   "describes another machine, or the positions have another zero or unit: correct "
                   "min and max of the axis, or take the file of this machine.",
                   axes, m.rows())});
}

}  // namespace

bool repeats_in_other_runs(const model::Measurement& m) {
  if (!m.states.setup.of.empty() || m.states.run_names.size() < 2) return false;
  model::Measurement one = m;
  one.states.setup.of.assign(m.states.count, 0);
  one.states.setup.names = {"1"};
  return noise_um(one) || noise_urad(one);
}

Vector3d model_discrepancy(const FitResult& result, const model::Measurement& m) {
  const auto fitted = squares_of(result, m, false), checked = squares_of(result, m, true);
  Vector3d variance = Vector3d::Zero();
  double seen = 0, sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (fitted[k].count + checked[k].count == 0) continue;
    variance[static_cast<Index>(k)] = std::max(excess(fitted[k]), excess(checked[k]));
    sum += variance[static_cast<Index>(k)];
    ++seen;
  }
  // Readings of no single direction (ball bar, distances) count for all directions alike.
  const double any = std::max(excess(fitted[3]), excess(checked[3]));
  for (std::size_t k = 0; k < 3; ++k) {
    double& own = variance[static_cast<Index>(k)];
    if (fitted[k].count + checked[k].count == 0) own = seen > 0 ? sum / seen : 0;
    own = std::max(own, any);
  }
  return variance.cwiseSqrt();
}

std::vector<model::FitRecord::Finding> findings_of(const FitResult& result, const model::FitRecord& record,
                                                   const model::Measurement& m) {
  std::vector<model::FitRecord::Finding> list;
  if (!result.converged) list.push_back({"not-converged", 1, "The fit did not converge."});
  if (result.size && !result.size->known)
    list.push_back({kSizeUnknown, result.size->relative_std, size_sentence(*result.size)});
  if (!result.absurd.empty()) list.push_back({"absurd", 1, result.absurd});
  if (const std::string far = far_from_nominal(result.machine, result.parameters, m, result.reach_mm);
      !far.empty())
    list.push_back({"far-from-nominal", 1, far});
  add_exact_lengths(result, m, list);
  const std::string planes = planes_of_probe(result, m);
  if (!planes.empty())
    list.push_back({kFlatnessAssumed, 0,
                    fmt::format("{} was taken as flat, and no other reading shows its bow: a bow of it "
                                "counts as an error of the "
                                "axes, at the position of the axes and not where the probe touched.",
                                planes)});
  add_computed_positions(result, m, list);
  add_axes_that_stood(result.machine, record, list);
  add_rows_outside_travel(result.machine, m, list);
  if (const auto rows = contradicting_rows(m); !rows.empty())
    list.push_back({"contradicting-rows", rows.front().apart_um, contradiction_in_words(m, rows)});
  const Vector3d lack_um(1e3 * record.discrepancy_mm[0], 1e3 * record.discrepancy_mm[1],
                         1e3 * record.discrepancy_mm[2]);
  if (lack_um.maxCoeff() > 0) {
    constexpr double kPlainly = 1.1;  // times the noise: visible with two digits
    const double times = times_the_noise(result);
    const std::string what = times > kPlainly
                                 ? fmt::format("The residual is {:.2g} times the noise", times)
                                 : "The residuals along one direction, or the residuals of the check rows "
                                   "(held-out rows), are larger than the noise of their readings";
    list.push_back({"something-missing", times,
                    fmt::format("{}: the model lacks an effect of {:.3g}, {:.3g}, {:.3g} um in x, y, z.{}",
                                what, lack_um.x(), lack_um.y(), lack_um.z(), unread_in_words(result, m))});
  }
  if (!result.noise_um && result.before.rms_um)
    list.push_back({"noise-unknown", 0,
                    repeats_in_other_runs(m)
                        ? kRepeatsInOtherRuns
                        : "The readings have no standard uncertainty u and no repeats, so the fit cannot "
                          "distinguish a missing effect from the noise of the readings."});
  if (result.check_ratio && *result.check_ratio > 1)
    list.push_back({"no-gain", *result.check_ratio,
                    fmt::format("The fit does not improve the machine: the residual of the check rows is "
                                "{:.3g} times that of the nominal machine.",
                                *result.check_ratio)});
  // The residual alone does not distinguish a disturbance from an effect that the model does not contain.
  if (!record.disturbance.empty())
    list.push_back(
        {"disturbed", record.disturbed,
         "Possibly the survey was disturbed: " + record.disturbance + ". " +
             (planes.empty() ? std::string("A missing effect (such as a backlash) can look")
                             : fmt::format("The shape of {}, which was taken as flat, or a missing "
                                           "effect (such as a backlash) can look",
                                           planes)) +
             " like this disturbance: vernier diagnose compares the causes."});
  if (const double share = repeated_poses(m); share >= 0.5)
    list.push_back({"check-not-independent", share,
                    fmt::format("{:.0f} % of the check rows repeat poses of fit rows: these check rows "
                                "cannot show errors between the poses.",
                                100 * share)});
  if (!record.unvaried.empty())
    list.push_back({"not-varied", static_cast<double>(record.unvaried.size()), unvaried_text(record)});
  if (!record.alternatives.empty())
    list.push_back(
        {"not-distinguished", static_cast<double>(record.alternatives.size()), alternatives_text(record)});
  return list;
}

}  // namespace vernier::fit
