// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/doubts/between_runs.h"

#include <algorithm>
#include <map>
#include <optional>

#include "tools/diagnose/doubts/shape.h"

namespace vernier::diagnose {
namespace {

/// The section of each reading, from 0 in the order of the rows.
using Sections = std::vector<Eigen::Index>;

/// Each run is a section.
Sections runs_of(const Evidence& evidence) {
  const std::vector<std::size_t>& run = evidence.measurement().states.run;
  std::map<std::size_t, Eigen::Index> numbers;
  for (const std::size_t row : evidence.rows()) numbers.emplace(run[row], 0);
  Eigen::Index next = 0;
  for (auto& [label, number] : numbers) number = next++;
  Sections sections;
  for (const std::size_t row : evidence.rows()) sections.push_back(numbers.at(run[row]));
  return sections;
}

/// The reading at which two constant values describe a quantity best. No value: the quantity does not step
/// there.
std::optional<std::size_t> step_of(const Eigen::ArrayXd& quantity) {
  constexpr double kIsStep = 0.5;  // of the range: a quantity that changes gradually has no such difference
  const auto count = static_cast<double>(quantity.size());
  const double all = quantity.sum();
  double best = 0, sum = 0;
  Eigen::Index at = 0;
  for (Eigen::Index i = 1; i < quantity.size(); ++i) {
    sum += quantity[i - 1];
    const auto before = static_cast<double>(i), after = count - before;
    const double apart = sum / before - (all - sum) / after;
    if (const double between = before * after * apart * apart; between > best) best = between, at = i;
  }
  if (at == 0 ||
      std::abs(quantity[at] - quantity[at - 1]) < kIsStep * (quantity.maxCoeff() - quantity.minCoeff()))
    return std::nullopt;
  return static_cast<std::size_t>(at);
}

/// The runs, each divided where an input of the effect steps within it.
Sections runs_and_steps_of(const Evidence& evidence, const effects::Candidate& candidate) {
  Sections sections = runs_of(evidence);
  for (const std::string& name : candidate.choice.inputs) {
    const auto input = evidence.machine().find_input(name);
    if (!input) continue;
    const auto step = step_of(evidence.at_readings(evidence.measurement().states.input[*input]));
    if (!step || sections[*step] != sections[*step - 1]) continue;
    const Eigen::Index divided = sections[*step];
    for (std::size_t i = 0; i < sections.size(); ++i)
      if (sections[i] > divided || (sections[i] == divided && i >= *step)) ++sections[i];
  }
  return sections;
}

/// The columns of the effect if its inputs and the time never changed, separately for each section. No
/// columns if there is one section. `width`: number of columns of one section.
Eigen::MatrixXd one_size_for_each(const Sections& sections, const Evidence& evidence,
                                  const effects::Candidate& candidate, const std::vector<double>& scanned,
                                  Eigen::Index& width) {
  const Eigen::Index count = sections.empty() ? 0 : *std::max_element(sections.begin(), sections.end()) + 1;
  if (count < 2) return {};
  model::States constant = evidence.measurement().states;
  for (std::size_t k = 0; k < constant.input.size(); ++k)
    constant.input[k].setConstant(evidence.reference_of(k) + 1);  // where an effect of this input is not 0
  constant.time.setConstant(evidence.time_range().high);
  const Eigen::MatrixXd all = ColumnMaker(evidence).raw_at(candidate, scanned, constant);
  width = all.cols();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(all.rows(), count * width);
  for (Eigen::Index i = 0; i < all.rows(); ++i)
    columns.row(i).segment(sections[static_cast<std::size_t>(i)] * width, width) = all.row(i);
  return columns;
}

/// The largest decrease of the BIC by one step from a section on, alone or beside a constant size.
/// `of_sections`: whitened columns of each section, `width` columns a section.
double decrease_by_step(const Evidence& evidence, const Eigen::MatrixXd& of_sections, Eigen::Index width,
                        const Eigen::MatrixXd& beside) {
  double best = 0;
  const auto of_section = [&](Eigen::Index section) {
    return of_sections.middleCols(section * width, width);
  };
  const Eigen::Index sections = of_sections.cols() / width;
  // The columns from a section on, and those of all sections.
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(of_sections.rows(), 2 * width);
  for (Eigen::Index section = 0; section < sections; ++section) both.rightCols(width) += of_section(section);
  for (Eigen::Index first = sections - 1; first > 0; --first) {
    both.leftCols(width) += of_section(first);
    // The section of the step is one of a few: its choice costs less than a reading.
    best = std::max({best, bic_decrease(evidence, both.leftCols(width), beside, 0),
                     bic_decrease(evidence, both, beside, 0)});
  }
  return best;
}

/// An effect that an input or the time drives, as it is compared with a change between the runs.
struct Compared {
  Eigen::MatrixXd of_sections;  // whitened columns of the change, `width` columns a section
  Eigen::Index width = 0;
  Eigen::MatrixXd beside;  // columns of the other effects
  double least = 0;        // decrease of the BIC from which a change explains the readings as well
};

std::optional<Compared> compared(const Evidence& evidence, const Pool& pool,
                                 const std::vector<std::size_t>& items, std::size_t position, double distance,
                                 const Sections& sections) {
  const std::size_t item = items[position];
  const auto in_time = [&](std::size_t one) {
    return pool.candidate(one).choice.runs.empty() &&
           change_in_time(drivers_of(evidence.machine(), pool.candidate(one)));
  };
  if (!in_time(item)) return std::nullopt;
  const effects::Candidate& candidate = pool.candidate(item);
  Compared change;
  Eigen::MatrixXd& constant = change.of_sections;
  constant = one_size_for_each(sections, evidence, candidate, pool[item].scored.scanned, change.width);
  if (constant.cols() == 0 || !constant.allFinite() || !(constant.norm() > 0)) return std::nullopt;
  evidence.whiten(constant);
  std::vector<std::size_t> others;
  Eigen::MatrixXd named(constant.rows(), 0);
  std::size_t scanned = 0;
  for (const std::size_t one : items) {
    const auto& place = pool.candidate(one).choice.place;
    const bool alike = one == item || (in_time(one) && place && candidate.choice.place &&
                                       moves_alike(evidence, *place, *candidate.choice.place));
    if (!alike) {
      others.push_back(one);
      continue;
    }
    const Eigen::MatrixXd columns = evidence.columns(pool.candidate(one), pool[one].scored.scanned);
    named.conservativeResize(Eigen::NoChange, named.cols() + columns.cols());
    named.rightCols(columns.cols()) = columns;
    scanned += pool[one].scored.scanned.size();
  }
  change.beside = pool.columns(others);
  change.least = bic_decrease(evidence, named, change.beside, scanned) - distance;
  return change;
}

}  // namespace

bool sizes_of_runs_explain(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t position, double distance) {
  const auto change = compared(evidence, pool, items, position, distance, runs_of(evidence));
  return change && bic_decrease(evidence, change->of_sections, change->beside, 0) > change->least;
}

bool one_step_explains(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                       std::size_t position, double distance) {
  const effects::Candidate& candidate = pool.candidate(items[position]);
  // A recorded heat or load can step as the machine did. The number of visits steps with each run anyway.
  if (candidate.choice.inputs.empty()) return false;
  const auto change =
      compared(evidence, pool, items, position, distance, runs_and_steps_of(evidence, candidate));
  return change &&
         decrease_by_step(evidence, change->of_sections, change->width, change->beside) > change->least;
}

}  // namespace vernier::diagnose
