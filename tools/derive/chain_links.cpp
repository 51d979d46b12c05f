// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/chain_links.h"

#include <algorithm>
#include <string>
#include <utility>

#include "tools/derive/numbers.h"
#include "tools/derive/symbol_book.h"
#include "tools/derive/tidy.h"

namespace vernier::derive {
namespace {

using GiNaC::ex;

/// Order of the degrees of freedom of a transform, from the side of the base.
struct LinkStep {
  std::size_t dof;
  bool rotation;
  int axis;
};
constexpr std::array<LinkStep, 6> kSixDofSteps = {
    {{0, false, 0}, {1, false, 1}, {2, false, 2}, {3, true, 0}, {4, true, 1}, {5, true, 2}}};
constexpr std::array<LinkStep, 4> kDhSteps = {{{1, false, 2}, {0, true, 2}, {2, false, 0}, {3, true, 0}}};

ex motion_value(const model::Machine& machine, const model::Transform& transform, const LinkStep& step,
                SymbolBook& book) {
  try {
    const ex value = book.value(*transform.dof[step.dof]);
    return step.rotation ? expand_inside(to_rad(value)) : expand_inside(value);
  } catch (const std::exception& error) {  // for example a pole of GiNaC
    throw text::InputError({machine.file, transform.line}, transform.text[step.dof],
                           std::string("cannot be derived: ") + error.what());
  }
}

void append(const model::Machine& machine, bool workpiece, SymbolBook& book,
            std::vector<ElementaryMotion>& motions) {
  const std::vector<model::Transform>& branch = workpiece ? machine.workpiece : machine.tool;
  for (std::size_t link = 0; link < branch.size(); ++link) {
    const model::Transform& transform = branch[link];
    const bool dh = transform.kind == model::TransformKind::kDh;
    const LinkStep* const first = dh ? kDhSteps.data() : kSixDofSteps.data();
    for (const LinkStep* step = first; step != first + transform.dof_count(); ++step) {
      const ex value = motion_value(machine, transform, *step, book);
      if (!value.is_zero())
        motions.push_back({step->rotation, step->axis, value, workpiece, link, step->dof});
    }
  }
}

}  // namespace

SymbolicVector unit_vector(int axis) {
  SymbolicVector v = {0, 0, 0};
  v[static_cast<std::size_t>(axis)] = 1;
  return v;
}

SymbolicVector cross(const SymbolicVector& a, const SymbolicVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

SymbolicVector turned(const SymbolicVector& v, int axis, const ex& angle_rad) {
  const auto i = static_cast<std::size_t>((axis + 1) % 3), j = static_cast<std::size_t>((axis + 2) % 3);
  const ex c = cosine(angle_rad), s = sine(angle_rad);
  SymbolicVector result = v;
  result[i] = (c * v[i] - s * v[j]).expand();
  result[j] = (s * v[i] + c * v[j]).expand();
  return result;
}

void RotationProduct::turn(int axis, const ex& angle_rad) {
  if (angle_rad.is_zero()) return;
  if (turns_.empty() || turns_.back().axis != axis) {
    turns_.push_back({axis, angle_rad});
    return;
  }
  turns_.back().angle = (turns_.back().angle + angle_rad).expand();
  if (turns_.back().angle.is_zero()) turns_.pop_back();
}

SymbolicVector RotationProduct::operator*(const SymbolicVector& v) const {
  SymbolicVector result = v;
  for (auto it = turns_.rbegin(); it != turns_.rend(); ++it) result = turned(result, it->axis, it->angle);
  return result;
}

std::vector<ElementaryMotion> elementary_motions(const model::Machine& machine, SymbolBook& book) {
  std::vector<ElementaryMotion> motions;
  append(machine, true, book, motions);
  std::reverse(motions.begin(), motions.end());
  for (ElementaryMotion& motion : motions) motion.value = (-motion.value).expand();
  append(machine, false, book, motions);
  return motions;
}

}  // namespace vernier::derive
