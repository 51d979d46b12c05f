// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/solve.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "tools/compile/symbolic/calculus.h"
#include "tools/compile/symbolic/functions.h"
#include "tools/maths/decompositions.h"

namespace vernier::compile {
namespace {

/// A singular value this small relative to the largest counts as zero.
constexpr double kFlat = 1e-9;

using Matrix = std::vector<std::vector<NodeId>>;  // rows

NodeId product_sum(Graph& g, const std::vector<NodeId>& a, const std::vector<NodeId>& b) {
  std::vector<Term> terms;
  for (std::size_t i = 0; i < a.size(); ++i) terms.push_back({1, g.product(a[i], b[i])});
  return g.sum(0, terms);
}

/// Small matrices of nodes.
class Algebra {
 public:
  explicit Algebra(Graph& graph) : g(graph), samples_(graph, kSamples) {}

  NodeId minor_of(const Matrix& m, std::size_t row, std::size_t column) {
    std::vector<std::size_t> r, c;
    for (std::size_t i = 0; i < m.size(); ++i) {
      if (i != row) r.push_back(i);
      if (i != column) c.push_back(i);
    }
    if (r.empty()) return g.constant(1);
    if (r.size() == 1) return m[r[0]][c[0]];
    return g.subtract(g.product(m[r[0]][c[0]], m[r[1]][c[1]]), g.product(m[r[0]][c[1]], m[r[1]][c[0]]));
  }
  Matrix adjugate(const Matrix& m) {
    Matrix result(m.size(), std::vector<NodeId>(m.size()));
    for (std::size_t i = 0; i < m.size(); ++i)
      for (std::size_t j = 0; j < m.size(); ++j)
        result[i][j] = simplified(g.scale((i + j) % 2 == 0 ? 1 : -1, minor_of(m, j, i)));
    return result;
  }
  NodeId determinant(const Matrix& m, const Matrix& adjugate) {
    std::vector<Term> terms;
    for (std::size_t j = 0; j < m.size(); ++j) terms.push_back({1, g.product(m[0][j], adjugate[j][0])});
    return simplified(g.sum(0, terms));
  }
  NodeId dot(const std::vector<NodeId>& a, const std::vector<NodeId>& b) { return product_sum(g, a, b); }
  /// Returns a number if the node is constant: cos^2 + sin^2 and the like.
  NodeId simplified(NodeId node) {
    if (g.constant_value(node)) return node;
    const auto value = sampled_constant(samples_, node);
    return value ? g.constant(*value) : node;
  }
  const Eigen::ArrayXd& sampled(NodeId node) { return samples_.of(node); }

  Graph& g;

 private:
  Samples samples_;
};

bool is_constant(const Graph& g, const AxisColumn& column) {
  return std::all_of(column.direction.begin(), column.direction.end(),
                     [&](NodeId id) { return g.constant_value(id).has_value(); });
}

std::vector<Term> row_terms(const Eigen::RowVectorXd& row, const std::vector<NodeId>& nodes) {
  std::vector<Term> terms;
  for (std::size_t c = 0; c < nodes.size(); ++c) {
    const double k = row[static_cast<Eigen::Index>(c)];
    terms.push_back({std::abs(k) < 1e-14 * row.norm() ? 0 : k, nodes[c]});
  }
  return terms;
}

Solver solve_by_numbers(Derivation& d, const std::vector<AxisColumn>& columns, const NodeVector& deviation) {
  Eigen::Matrix3Xd j(3, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      j(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(i)) =
          *d.graph.constant_value(columns[i].direction[c]);
  const Eigen::MatrixXd to_axes = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(j).pseudoInverse();
  std::vector<Eigen::RowVector3d> rows;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Eigen::RowVector3d row = to_axes.row(static_cast<Eigen::Index>(i));
    if (row.norm() == 0) continue;
    rows.push_back(row);
    const auto along = [&](const NodeVector& v) {
      return d.graph.sum(0, row_terms(row, {v.begin(), v.end()}));
    };
    const NodeId value = along(deviation);
    for (EffectPart& part : d.parts) part.outputs.push_back(along(part.deviation));
    d.outputs.push_back({columns[i].axis,
                         value,
                         {std::abs(row[0]), std::abs(row[1]), std::abs(row[2])},
                         row.norm(),
                         j.col(static_cast<Eigen::Index>(i)).norm()});
  }
  return [rows](Graph& g, const NodeVector& v) {
    Solved x;
    for (const Eigen::RowVector3d& row : rows)
      x.values.push_back(g.sum(0, row_terms(row, {v.begin(), v.end()})));
    return x;
  };
}

/// The components of a vector in the directions that the axes span.
std::vector<NodeId> components(Graph& g, const Eigen::Matrix3Xd& basis, const NodeVector& v) {
  std::vector<NodeId> along;
  for (Eigen::Index i = 0; i < basis.cols(); ++i)
    along.push_back(g.sum(0, row_terms(basis.col(i).transpose(), {v.begin(), v.end()})));
  return along;
}

/// Columns and deviation in the directions that the axes span.
struct Reduced {
  Eigen::Matrix3Xd basis;
  Matrix rows;  // rank x axes, columns scaled to at most 1
  std::vector<NodeId> deviation;
  std::vector<std::vector<NodeId>> parts;
  std::vector<double> lever;  // mm per axis unit that a column was divided by
};

Reduced reduce(Derivation& d, Algebra& algebra, const std::vector<AxisColumn>& columns,
               const NodeVector& deviation, const Eigen::Matrix3Xd& basis) {
  Graph& g = d.graph;
  Reduced r;
  r.basis = basis;
  r.parts.resize(d.parts.size());
  for (const AxisColumn& column : columns)
    r.lever.push_back(std::exp2(std::ceil(std::log2(std::max(1e-9, column.norm)))));
  for (Eigen::Index i = 0; i < basis.cols(); ++i) {
    const Eigen::RowVector3d direction = basis.col(i).transpose();
    const auto along = [&](const NodeVector& v) {
      return g.sum(0, row_terms(direction, {v.begin(), v.end()}));
    };
    r.deviation.push_back(along(deviation));
    for (std::size_t p = 0; p < d.parts.size(); ++p) r.parts[p].push_back(along(d.parts[p].deviation));
    std::vector<NodeId> row;
    for (std::size_t k = 0; k < columns.size(); ++k)
      row.push_back(algebra.simplified(g.scale(1 / r.lever[k], along(columns[k].direction))));
    r.rows.push_back(row);
  }
  return r;
}

/// Square and regular over the whole ranges: x = J^-1 deviation. Returns an empty function if that
/// is not proved.
Solver solve_square(Derivation& d, Algebra& algebra, const std::vector<AxisColumn>& columns,
                    const Reduced& r) {
  if (r.rows.size() != columns.size()) return {};
  Graph& g = d.graph;
  const Matrix adjugate = algebra.adjugate(r.rows);
  NodeId determinant = algebra.determinant(r.rows, adjugate);
  const double sign = algebra.sampled(determinant)[0] < 0 ? -1 : 1;
  determinant = g.scale(sign, determinant);
  const double low = lower_bound_of(g, determinant, kBoxes);
  if (low < kFlat) return {};
  if (!g.constant_value(determinant) && g[determinant].range.low < low)
    determinant = g.choice(NodeKind::kMax, determinant, g.constant(low * (1 - 1e-6)));
  const NodeId reciprocal = g.function(Function::kReciprocal, determinant);
  Matrix inverse;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std::vector<NodeId> row;
    double norm = 0;
    std::array<double, 3> sizes{};
    for (const NodeId entry : adjugate[i]) {
      row.push_back(algebra.simplified(g.scale(sign / r.lever[i], g.product(entry, reciprocal))));
      const double size = g[row.back()].range.magnitude();
      norm += size * size;
      sizes[row.size() - 1] = size;
    }
    norm = std::sqrt(norm);
    if (row.size() < 3) sizes = {norm, norm, norm};  // in a basis of its own
    d.outputs.push_back({columns[i].axis, algebra.dot(row, r.deviation), sizes, norm, columns[i].norm});
    for (std::size_t p = 0; p < d.parts.size(); ++p)
      d.parts[p].outputs.push_back(algebra.dot(row, r.parts[p]));
    inverse.push_back(std::move(row));
  }
  return [inverse, basis = r.basis](Graph& graph, const NodeVector& v) {
    Solved x;
    x.components = components(graph, basis, v);
    for (const std::vector<NodeId>& row : inverse) x.values.push_back(product_sum(graph, row, x.components));
    return x;
  };
}

/// A number with few binary digits, slightly above another: as a limit it has no error in any format.
double above(double magnitude) {
  constexpr int kDigits = 16;  // binary: the limit is at most 2^-15 above, and exact in every format
  int exponent = 0;
  const double mantissa = std::frexp(magnitude, &exponent);
  return std::ldexp(std::ceil(std::ldexp(mantissa, kDigits)), exponent - kDigits);
}

NodeId limited(Graph& g, NodeId node, double magnitude) {
  if (g[node].range.magnitude() <= 1.25 * magnitude) return node;
  magnitude = above(magnitude);
  if (g[node].range.low < -magnitude) node = g.choice(NodeKind::kMax, node, g.constant(-magnitude));
  return g[node].range.high > magnitude ? g.choice(NodeKind::kMin, node, g.constant(magnitude)) : node;
}

/// Returns det(J J') with a lower limit, and adds the note about its consequences.
NodeId held_determinant(Derivation& d, Algebra& algebra, NodeId determinant, double& floor) {
  Graph& g = d.graph;
  const Eigen::ArrayXd seen = algebra.sampled(determinant);
  floor = kFloorShare * seen.maxCoeff();
  double low = g[determinant].range.low;
  if (low < floor && seen.minCoeff() > floor) low = lower_bound_of(g, determinant, kBoxes) * (1 - 1e-6);
  if (low > floor) {
    floor = low;
  } else {
    d.fading = static_cast<double>((seen < floor).count()) / static_cast<double>(seen.size());
    d.notes.push_back(
        fmt::format("the corrected axes cannot move the tool point in every direction in some poses: near "
                    "these poses (about {:.1f} % of the declared ranges) the correction is reduced",
                    100 * *d.fading));
  }
  if (g[determinant].range.low >= floor) return determinant;
  return g.choice(NodeKind::kMax, determinant, g.constant(floor));
}

/// Right side of (K K')^-1: the components of a vector in the directions. For the nearest point, K
/// times them.
std::vector<NodeId> right_side(Graph& g, const LeastSquares& least, const std::vector<NodeId>& components) {
  if (!least.nearest) return components;
  std::vector<NodeId> along;
  for (const std::vector<NodeId>& row : least.jacobian)
    along.push_back(limited(g, product_sum(g, row, components), std::sqrt(least.trace) * least.spread_mm));
  return along;
}

/// Returns (K K')^-1 times a right side.
std::vector<NodeId> weights_of(Graph& g, const LeastSquares& least, const std::vector<NodeId>& right) {
  const double size = least.largest * least.spread_mm * (least.nearest ? std::sqrt(least.trace) : 1);
  std::vector<NodeId> weights;
  for (const std::vector<NodeId>& row : least.adjugate)
    weights.push_back(g.product(least.reciprocal, limited(g, product_sum(g, row, right), size)));
  return weights;
}

/// Returns the motions of the axes: K' times the weights, or the weights themselves for the
/// nearest point.
std::vector<NodeId> motions_of(Graph& g, const LeastSquares& least, const std::vector<NodeId>& weights) {
  std::vector<NodeId> motions;
  for (std::size_t k = 0; k < least.lever.size(); ++k) {
    std::vector<NodeId> column;
    for (const std::vector<NodeId>& row : least.jacobian)
      if (!least.nearest) column.push_back(row[k]);
    motions.push_back(
        g.scale(1 / least.lever[k], least.nearest ? weights[k] : product_sum(g, column, weights)));
  }
  return motions;
}

Matrix transposed(const Matrix& m) {
  Matrix result(m[0].size(), std::vector<NodeId>(m.size()));
  for (std::size_t i = 0; i < m.size(); ++i)
    for (std::size_t k = 0; k < m[i].size(); ++k) result[k][i] = m[i][k];
  return result;
}

// x = K' (K K')^-1 deviation. The columns are scaled alike, so that no axis moves the tool point
// more than another. Known lengths reduce the overestimate of intervals: a rotation keeps a
// length, but not a component's interval.
Solver solve_least(Derivation& d, Algebra& algebra, const std::vector<AxisColumn>& columns,
                   const Reduced& r) {
  Graph& g = d.graph;
  LeastSquares least;
  least.nearest = r.rows.size() > columns.size();
  least.lever = r.lever;
  least.spread_mm = d.spread_mm;
  Matrix jacobian = r.rows;
  for (std::size_t k = 0; k < columns.size(); ++k)
    least.trace += columns[k].norm * columns[k].norm / (r.lever[k] * r.lever[k]);
  for (std::vector<NodeId>& row : jacobian)
    for (std::size_t k = 0; k < columns.size(); ++k)
      row[k] = limited(g, row[k], columns[k].norm / r.lever[k]);
  least.jacobian = least.nearest ? transposed(jacobian) : jacobian;
  const std::size_t rank = least.jacobian.size();
  Matrix square(rank, std::vector<NodeId>(rank));
  for (std::size_t i = 0; i < rank; ++i)
    for (std::size_t k = i; k < rank; ++k)
      square[i][k] = square[k][i] =
          limited(g, algebra.simplified(algebra.dot(least.jacobian[i], least.jacobian[k])),
                  i == k ? least.trace : least.trace / 2);
  // Of adj(J J'): the product of its two largest singular values, whose sum is at most the trace.
  least.largest = rank == 3 ? least.trace * least.trace / 4 : rank == 2 ? least.trace : 1;
  least.square = square;
  least.adjugate = algebra.adjugate(square);
  for (std::vector<NodeId>& row : least.adjugate)
    for (NodeId& entry : row) entry = limited(g, entry, least.largest);
  const NodeId determinant = algebra.determinant(square, least.adjugate);
  // A determinant is at most that of equal singular values with the same sum.
  const double most = std::pow(least.trace / static_cast<double>(rank), static_cast<double>(rank));
  least.determinant = limited(g, held_determinant(d, algebra, determinant, least.floor), most);
  least.reciprocal = g.function(Function::kReciprocal, least.determinant);
  least.deviation = right_side(g, least, r.deviation);
  least.weights = weights_of(g, least, least.deviation);
  least.gain = (rank == 3   ? least.trace / 2
                : rank == 2 ? std::sqrt(least.trace)
                            : 1) /
               std::sqrt(least.floor);
  const std::vector<NodeId> motions = motions_of(g, least, least.weights);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const double gain = least.gain / r.lever[k];
    d.outputs.push_back({columns[k].axis, motions[k], {gain, gain, gain}, gain, columns[k].norm});
  }
  for (std::size_t p = 0; p < d.parts.size(); ++p)
    d.parts[p].outputs = motions_of(g, least, weights_of(g, least, right_side(g, least, r.parts[p])));
  d.least_squares = least;
  return [least, basis = r.basis](Graph& graph, const NodeVector& v) {
    std::vector<NodeId> seen = components(graph, basis, v);
    for (NodeId& component : seen) component = limited(graph, component, least.spread_mm);
    Solved x;
    x.components = right_side(graph, least, seen);
    x.weights = weights_of(graph, least, x.components);
    x.values = motions_of(graph, least, x.weights);
    return x;
  };
}

}  // namespace

Span span_of(const Derivation& d, const std::vector<AxisColumn>& columns) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  Span span;
  if (n == 0) return span;
  Samples samples(d.graph, kSamples);
  Eigen::Matrix3Xd all(3, n * kSamples);
  for (Eigen::Index i = 0; i < n; ++i) {
    const AxisColumn& column = columns[static_cast<std::size_t>(i)];
    const double size = std::max(1e-9, column.norm);
    for (std::size_t c = 0; c < 3; ++c)
      for (Eigen::Index s = 0; s < kSamples; ++s)
        all(static_cast<Eigen::Index>(c), s * n + i) = samples.of(column.direction[c])[s] / size;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(all, Eigen::ComputeThinU);
  span.rank = static_cast<int>((svd.singularValues().array() > kFlat * svd.singularValues()[0]).count());
  span.basis = Eigen::Matrix3Xd::Identity(3, 3);
  if (span.rank < 3) {
    span.basis = svd.matrixU().leftCols(span.rank);
    for (double& v : span.basis.reshaped())
      if (std::abs(v) < 1e-12) v = 0;
  }
  span.everywhere = true;
  for (Eigen::Index s = 0; s < kSamples; ++s) {
    const Eigen::MatrixXd here = span.basis.transpose() * all.middleCols(s * n, n);
    const Eigen::MatrixXd square = here * here.transpose();
    span.everywhere = span.everywhere && square.determinant() > kFloorShare * kFloorShare;
  }
  return span;
}

Solver solve_axes(Derivation& d) {
  const std::vector<AxisColumn>& columns = d.columns;
  const NodeVector& deviation = d.deviation;
  if (std::all_of(columns.begin(), columns.end(),
                  [&](const AxisColumn& c) { return is_constant(d.graph, c); }))
    return solve_by_numbers(d, columns, deviation);
  Algebra algebra(d.graph);
  const Span span = span_of(d, columns);
  const Reduced r = reduce(d, algebra, columns, deviation, span.basis);
  if (Solver solver = solve_square(d, algebra, columns, r)) return solver;
  return solve_least(d, algebra, columns, r);
}

}  // namespace vernier::compile
