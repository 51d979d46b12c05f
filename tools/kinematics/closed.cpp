// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/kinematics/closed.h"

#include <algorithm>

#include "tools/maths/decompositions.h"

namespace vernier::kinematics {
namespace {

/// Degree of an expression in the linear axes; anything above first degree is kNotAffine.
constexpr int kNotAffine = 2;

class DegreeOf {
 public:
  explicit DegreeOf(const model::Machine& machine) : machine_(machine) {}

  int operator()(const model::Expr& expr) const {
    std::vector<int> args;
    for (const model::ExprPtr& arg : expr.args) args.push_back((*this)(*arg));
    const int most = args.empty() ? 0 : *std::max_element(args.begin(), args.end());
    switch (expr.op) {
      case model::Op::kSymbol:
        return symbol(expr.symbol);
      case model::Op::kNegate:
      case model::Op::kAdd:
      case model::Op::kSubtract:
        return most;
      case model::Op::kMultiply:
        return std::min(args[0] + args[1], kNotAffine);
      case model::Op::kDivide:
        return args[1] == 0 ? args[0] : kNotAffine;
      default:
        return most == 0 ? 0 : kNotAffine;
    }
  }

 private:
  int symbol(const model::Symbol& symbol) const {
    if (symbol.kind == model::SymbolKind::kAxis) return machine_.axes[symbol.index].rotary ? 0 : 1;
    if (symbol.kind != model::SymbolKind::kTableValue) return 0;
    const model::Table* table = machine_.table_of(symbol.index / 6);
    if (table == nullptr || machine_.axes[symbol.index / 6].rotary) return 0;
    const auto zero = [&](const model::Station& station) { return station.value[symbol.index % 6] == 0; };
    return std::all_of(table->stations.begin(), table->stations.end(), zero) ? 0 : kNotAffine;
  }

  const model::Machine& machine_;
};

bool is_affine(const model::Machine& machine) {
  const DegreeOf degree(machine);
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const model::Transform& transform : *branch)
      for (std::size_t i = 0; i < transform.dof_count(); ++i) {
        const bool length = transform.kind == model::TransformKind::kSixDof ? i < 3 : i == 1 || i == 2;
        if (degree(*transform.dof[i]) > (length ? 1 : 0)) return false;
      }
  return true;
}

}  // namespace

std::optional<ClosedSolution> closed_solution(const model::Machine& machine, const model::States& at) {
  ClosedSolution result;
  result.axes = linear_axes(machine);
  if (result.axes.empty() || result.axes.size() > 3 || !is_affine(machine)) return std::nullopt;
  const std::size_t count = result.axes.size();
  model::States states = model::select_states(at, std::vector<std::size_t>(count + 1, 0));
  constexpr double kSpan = 1024;  // mm; a power of two, so that a division by it has no rounding
  for (std::size_t k = 0; k < count; ++k) {
    states.axis[result.axes[k]].setZero();
    states.axis[result.axes[k]][static_cast<Eigen::Index>(k + 1)] = kSpan;
  }
  const model::Poses poses = model::forward(machine, states);
  result.origin = poses.position.col(0);
  result.jacobian =
      (poses.position.rightCols(static_cast<Eigen::Index>(count)).colwise() - result.origin) / kSpan;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(result.jacobian);
  const double least = svd.singularValues()[static_cast<Eigen::Index>(count) - 1];
  if (!(least * InverseOptions{}.most_condition > svd.singularValues()[0])) return std::nullopt;
  result.condition = svd.singularValues()[0] / least;
  return result;
}

Eigen::MatrixXd solve_closed(const ClosedSolution& solution, const Eigen::Matrix3Xd& points) {
  const Eigen::MatrixXd jacobian = solution.jacobian;
  const Eigen::MatrixXd offset = points.colwise() - solution.origin;
  return maths::least_squares(jacobian, offset);
}

}  // namespace vernier::kinematics
