// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/error_equation.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "tools/derive/chain_links.h"
#include "tools/derive/symbol_book.h"
#include "tools/derive/tidy.h"

namespace vernier::derive {
namespace {

using GiNaC::ex;

/// The chain at errors 0, from the workpiece to the tool.
class NominalChain {
 public:
  explicit NominalChain(std::vector<ElementaryMotion> nominal) : motions_(std::move(nominal)) {}

  /// Returns the velocity of the tool point (mm) and of the tool's rotation (rad) per unit of
  /// motion j, in workpiece coordinates.
  Sensitivity velocity(std::size_t j) const {
    // The frame just before the run of rotations about one axis that ends at j. The axis of j is
    // the same there, and the angles of rotations about it can still be added.
    std::size_t start = j;
    const ElementaryMotion& motion = motions_[j];
    if (motion.rotation)
      for (std::size_t k = j; k-- > 0;) {
        if (!motions_[k].rotation) continue;
        if (motions_[k].axis != motion.axis) break;
        start = k;
      }
    const SymbolicVector axis = unit_vector(motion.axis);
    const RotationProduct below = turns(0, start);
    if (!motion.rotation) return with(below * axis, {0, 0, 0});
    return with(below * cross(axis, lever(start, j)), below * axis);
  }

  SymbolicVector tool_point() const { return lever(0, 0); }

  SymbolicVector tool_axis() const { return turns(0, motions_.size()) * unit_vector(2); }

 private:
  RotationProduct turns(std::size_t first, std::size_t last) const {
    RotationProduct product;
    for (std::size_t k = first; k < last; ++k)
      if (motions_[k].rotation) product.turn(motions_[k].axis, motions_[k].value);
    return product;
  }

  /// From a point on the axis of motion j to the tool point, oriented as the frame before motion `start`.
  SymbolicVector lever(std::size_t start, std::size_t j) const {
    RotationProduct orientation = turns(start, j);
    SymbolicVector sum = {0, 0, 0};
    for (std::size_t k = j; k < motions_.size(); ++k) {
      const ElementaryMotion& m = motions_[k];
      if (m.rotation) {
        orientation.turn(m.axis, m.value);
        continue;
      }
      const SymbolicVector direction = orientation * unit_vector(m.axis);
      for (std::size_t i = 0; i < 3; ++i) sum[i] = (sum[i] + direction[i] * m.value).expand();
    }
    return sum;
  }

  static Sensitivity with(const SymbolicVector& point, const SymbolicVector& rotation) {
    return {point[0], point[1], point[2], rotation[0], rotation[1], rotation[2]};
  }

  std::vector<ElementaryMotion> motions_;
};

/// Returns the slope of a motion by an error, at errors 0. Throws if there is no slope.
ex nominal_slope(const model::Machine& machine, const ElementaryMotion& motion,
                 const ErrorParameter& parameter, const SymbolBook& book, const GiNaC::exmap& no_errors) {
  const model::Transform& transform = transform_of(machine, motion);
  ex slope;
  try {
    slope = motion.value.diff(parameter.symbol).subs(no_errors, GiNaC::subs_options::no_pattern);
  } catch (const std::exception&) {
    throw text::InputError(
        {machine.file, transform.line}, transform.text[motion.dof],
        fmt::format(
            "this term has no derivative with respect to {} at errors 0, so that the first-order error "
            "equation does not exist",
            parameter.name));
  }
  const std::string word = book.rough_word(slope);
  if (!word.empty())
    throw text::InputError({machine.file, transform.line}, transform.text[motion.dof],
                           parameter.name + " acts inside " + word + ", which has no derivative");
  return slope;
}

/// The motions at errors 0; long lengths become abbreviations.
std::vector<ElementaryMotion> nominal_motions(const model::Machine& machine,
                                              const std::vector<ElementaryMotion>& motions,
                                              const GiNaC::exmap& no_errors, SymbolBook& book,
                                              std::vector<Abbreviation>& abbreviations) {
  constexpr std::size_t kLongSum = 3;  // number of terms above which a sum gets a name
  std::vector<ElementaryMotion> nominal = motions;
  for (ElementaryMotion& m : nominal) {
    const model::Transform& transform = transform_of(machine, m);
    try {
      m.value = expand_inside(m.value.subs(no_errors, GiNaC::subs_options::no_pattern));
    } catch (const std::exception& error) {
      throw text::InputError(
          {machine.file, transform.line}, transform.text[m.dof],
          std::string("an expression of the machine file has no value in the nominal chain: ") +
              error.what());
    }
    if (m.rotation || term_count(m.value) < kLongSum) continue;
    const std::string name =
        std::string(m.workpiece ? "w" : "t") + transform.dof_name(m.dof) + std::to_string(transform.n);
    abbreviations.push_back({GiNaC::realsymbol(book.free_name(name, name + "_")), m.value});
    m.value = abbreviations.back().symbol;
  }
  return nominal;
}

void add_to(Sensitivity& sum, const ex& slope, const Sensitivity& velocity) {
  for (std::size_t i = 0; i < 6; ++i) sum[i] += slope * velocity[i];
}

}  // namespace

const model::Transform& transform_of(const model::Machine& machine, const ElementaryMotion& motion) {
  return (motion.workpiece ? machine.workpiece : machine.tool)[motion.link];
}

ErrorEquation derive(const model::Machine& machine, const ErrorSizes& sizes) {
  ErrorEquation equation;
  equation.machine = machine;
  SymbolBook book(equation.machine);
  equation.motions = elementary_motions(equation.machine, book);
  book.settle_units(equation.motions);
  book.settle_sizes(sizes);

  GiNaC::exmap no_errors;
  for (const ErrorParameter& p : book.parameters) no_errors[p.symbol] = 0;
  const NominalChain chain(
      nominal_motions(equation.machine, equation.motions, no_errors, book, equation.abbreviations));
  equation.sensitivity.assign(book.parameters.size(), Sensitivity{0, 0, 0, 0, 0, 0});
  for (std::size_t j = 0; j < equation.motions.size(); ++j) {
    std::optional<Sensitivity> velocity;
    for (std::size_t p = 0; p < book.parameters.size(); ++p) {
      if (!equation.motions[j].value.has(book.parameters[p].symbol)) continue;
      const ex slope =
          nominal_slope(equation.machine, equation.motions[j], book.parameters[p], book, no_errors);
      if (slope.is_zero()) continue;
      if (!velocity) velocity = chain.velocity(j);
      add_to(equation.sensitivity[p], slope, *velocity);
    }
  }
  for (std::size_t p = 0; p < book.parameters.size(); ++p) {
    bool any = false;
    for (ex& component : equation.sensitivity[p]) {
      component = tidy(component);
      any = any || !component.is_zero();
    }
    if (!any) book.notes.push_back(book.parameters[p].name + " acts in second order only");
  }
  equation.position = chain.tool_point();
  equation.tool_axis = chain.tool_axis();
  for (ex& component : equation.position) component = tidy(component);
  for (ex& component : equation.tool_axis) component = tidy(component);
  equation.parameters = std::move(book.parameters);
  equation.nominal = std::move(book.nominal);
  equation.opaque = std::move(book.opaque);
  equation.notes = std::move(book.notes);
  return equation;
}

std::array<ex, 3> tool_axis_sensitivity(const ErrorEquation& equation, std::size_t parameter) {
  const Sensitivity& s = equation.sensitivity[parameter];
  SymbolicVector change = cross({s[3], s[4], s[5]}, equation.tool_axis);
  for (ex& component : change) component = tidy(component);
  return change;
}

}  // namespace vernier::derive
