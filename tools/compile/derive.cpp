#include "tools/compile/derive.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/compile/dual.h"

namespace vernier {
namespace {

constexpr double kRad = std::numbers::pi / 180;
using Vector = std::array<NodeId, 3>;

/// One elementary step along the chain, as the point meets it: a turn about a coordinate axis, or a shift
/// along it.
struct Step {
  bool turn;
  int axis;  // 0..2: X Y Z
  Dual by;   // deg or mm
  std::string where;
};

/// Carries a point through the chain: its nominal place, and what the actual chain adds to it.
class Walk {
 public:
  Walk(Derivation& derivation, double neglect_mm)
      : d_(derivation), g_(derivation.graph), neglect_mm_(neglect_mm) {
    nominal_.fill(g_.constant(0));
    deviation_.fill(g_.constant(0));
  }

  void take(const Step& step) {
    if (step.turn) {
      deviate_by_turn(step);
      turn_nominal(step);
    } else {
      const auto axis = static_cast<std::size_t>(step.axis);
      add_deviation(only(axis, step.by.delta));
      nominal_[axis] = g_.add(nominal_[axis], step.by.nominal);
    }
  }
  /// From here on no linear axis moves: nominal turns no longer turn the deviation (they turn the axes
  /// alike).
  void freeze() { frozen_ = true; }

  const Vector& nominal() const { return nominal_; }
  const Vector& deviation() const { return deviation_; }

 private:
  Vector only(std::size_t axis, NodeId value) {
    Vector v;
    v.fill(g_.constant(0));
    v[axis] = value;
    return v;
  }
  Vector plus(const Vector& a, const Vector& b) {
    return {g_.add(a[0], b[0]), g_.add(a[1], b[1]), g_.add(a[2], b[2])};
  }
  double norm_of(const Vector& v) const {
    double sum = 0;
    for (const NodeId id : v) sum += g_[id].range.magnitude() * g_[id].range.magnitude();
    return std::sqrt(sum);
  }

  // Cosine and sine; exact where the angle is a multiple of 90 deg, so that a machine built of right angles
  // stays sparse.
  std::pair<NodeId, NodeId> direction_of(NodeId angle_deg) {
    const auto value = g_.constant_value(angle_deg);
    if (!value) return {g_.function(Function::kCos, angle_deg), g_.function(Function::kSin, angle_deg)};
    const double quarter = *value / 90;
    if (quarter != std::round(quarter))
      return {g_.constant(std::cos(*value * kRad)), g_.constant(std::sin(*value * kRad))};
    const int q = ((static_cast<int>(std::fmod(quarter, 4)) % 4) + 4) % 4;
    constexpr std::array<double, 4> kCosine = {1, 0, -1, 0}, kSine = {0, 1, 0, -1};
    return {g_.constant(kCosine[static_cast<std::size_t>(q)]),
            g_.constant(kSine[static_cast<std::size_t>(q)])};
  }

  Vector turned(const Vector& v, int axis, NodeId angle_deg) {
    const auto [c, s] = direction_of(angle_deg);
    const auto a = static_cast<std::size_t>((axis + 1) % 3), b = static_cast<std::size_t>((axis + 2) % 3);
    Vector out = v;
    out[a] = g_.subtract(g_.product(c, v[a]), g_.product(s, v[b]));
    out[b] = g_.add(g_.product(s, v[a]), g_.product(c, v[b]));
    return out;
  }

  void turn_nominal(const Step& step) {
    if (g_.is_zero(step.by.nominal)) return;
    nominal_ = turned(nominal_, step.axis, step.by.nominal);
    if (frozen_) {
      turns_.push_back(step);
    } else {
      deviation_ = turned(deviation_, step.axis, step.by.nominal);
    }
  }

  Vector deviation_here() {
    Vector v = deviation_;
    for (const Step& step : turns_) v = turned(v, step.axis, step.by.nominal);
    return v;
  }
  void add_deviation(Vector v) {
    for (auto step = turns_.rbegin(); step != turns_.rend(); ++step)
      v = turned(v, step->axis, g_.scale(-1, step->by.nominal));
    deviation_ = plus(deviation_, v);
  }

  bool small(double bound_mm, const std::string& what) {
    if (bound_mm > neglect_mm_) return false;
    if (bound_mm > 0) d_.neglected.push_back({what, bound_mm});
    return true;
  }

  // (R(delta) - 1) (nominal + deviation): sine and 1 - cosine of the small angle by their series, as far as
  // they matter.
  void deviate_by_turn(const Step& step) {
    if (g_.is_zero(step.by.delta)) return;
    const auto a = static_cast<std::size_t>((step.axis + 1) % 3),
               b = static_cast<std::size_t>((step.axis + 2) % 3);
    const double size = g_[step.by.delta].range.magnitude() * kRad;
    Vector point = nominal_;
    const Vector so_far = deviation_here();
    const Vector across = {g_.constant(0), so_far[a], so_far[b]};
    if (!small(2 * std::sin(std::min(size, 3.0) / 2) * norm_of(across),
               "turn of the deviation by " + step.where))
      point = plus(point, so_far);
    const double reach = norm_of({g_.constant(0), point[a], point[b]});
    const NodeId sine = sine_of(step, size, reach), bend = bend_of(step, size, reach);
    Vector moved;
    moved.fill(g_.constant(0));
    moved[a] = g_.sum(0, {{-1, g_.product(bend, point[a])}, {-1, g_.product(sine, point[b])}});
    moved[b] = g_.sum(0, {{1, g_.product(sine, point[a])}, {-1, g_.product(bend, point[b])}});
    add_deviation(moved);
  }

  NodeId sine_of(const Step& step, double size, double reach) {
    if (const auto angle = g_.constant_value(step.by.delta)) return g_.constant(std::sin(*angle * kRad));
    const NodeId angle = g_.scale(kRad, step.by.delta);
    if (small(std::pow(size, 3) / 6 * reach, "third order of " + step.where)) return angle;
    if (small(std::pow(size, 5) / 120 * reach, "fifth order of " + step.where))
      return g_.sum(0, {{1, angle}, {-1.0 / 6, g_.product(angle, g_.product(angle, angle))}});
    return g_.function(Function::kSin, step.by.delta);
  }
  NodeId bend_of(const Step& step, double size, double reach) {
    if (const auto angle = g_.constant_value(step.by.delta)) return g_.constant(1 - std::cos(*angle * kRad));
    if (small(size * size / 2 * reach, "second order of " + step.where)) return g_.constant(0);
    const NodeId angle = g_.scale(kRad, step.by.delta), square = g_.product(angle, angle);
    if (small(std::pow(size, 4) / 24 * reach, "fourth order of " + step.where)) return g_.scale(0.5, square);
    if (small(std::pow(size, 6) / 720 * reach, "sixth order of " + step.where))
      return g_.sum(0, {{0.5, square}, {-1.0 / 24, g_.product(square, square)}});
    return g_.sum(1, {{-1, g_.function(Function::kCos, step.by.delta)}});
  }

  Derivation& d_;
  Graph& g_;
  double neglect_mm_;
  Vector nominal_, deviation_;
  bool frozen_ = false;
  std::vector<Step> turns_;  // nominal turns since freeze()
};

/// The elementary steps of one transform in the order in which a point beyond it meets them.
std::vector<Step> steps_of(const Transform& t, const char* branch, Translator& translate) {
  std::vector<Step> steps;
  const auto push = [&](bool turn, int axis, std::size_t dof) {
    const std::string where =
        std::string(t.dof_name(dof)) + " of transform " + std::to_string(t.n) + " (" + branch + ")";
    steps.push_back({turn, axis, translate.translate(*t.dof[dof], t.text[dof], t.line), where});
  };
  if (t.kind == TransformKind::kSixDof) {
    for (int axis = 2; axis >= 0; --axis) push(true, axis, static_cast<std::size_t>(axis) + 3);
    for (int axis = 0; axis < 3; ++axis) push(false, axis, static_cast<std::size_t>(axis));
  } else {
    push(true, 0, 3);   // alpha
    push(false, 0, 2);  // a
    push(true, 2, 0);   // theta
    push(false, 2, 1);  // d
  }
  return steps;
}

std::vector<Step> all_steps(const Machine& machine, Translator& translate, Graph& graph) {
  std::vector<Step> steps;
  for (auto t = machine.tool.rbegin(); t != machine.tool.rend(); ++t)
    for (Step& step : steps_of(*t, "tool", translate)) steps.push_back(std::move(step));
  for (const Transform& t : machine.workpiece) {
    std::vector<Step> back = steps_of(t, "workpiece", translate);
    for (auto step = back.rbegin(); step != back.rend(); ++step) {
      step->by = {graph.scale(-1, step->by.nominal), graph.scale(-1, step->by.delta)};
      steps.push_back(std::move(*step));
    }
  }
  return steps;
}

void check_machine(const Machine& machine) {
  for (const Static& s : machine.statics)
    if (!s.hidden && !s.nominal)
      throw InputError({machine.file, s.line}, s.name,
                       "a free static without nominal cannot be compiled (fit writes it)");
  for (std::size_t i = 0; i < machine.axes.size(); ++i) axis_range(machine, i);
  if (machine.axes.size() > kMaxAxes || machine.inputs.size() > kMaxInputs)
    throw InputError({machine.file, 0}, machine.name, "more axes or inputs than an image holds");
}

/// Columns: how the nominal point moves per mm of each linear axis. Throws where that is not constant.
Eigen::Matrix3Xd directions(const Machine& machine, const Vector& point,
                            const std::vector<std::size_t>& linear, Translator& translate,
                            const Graph& graph) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(linear.size()));
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const NodeId axis = translate.channel(ChannelKind::kPosition, linear[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto slope = graph.constant_slope(point[c], axis);
      if (!slope)
        throw InputError(
            {machine.file, machine.axes[linear[i]].line}, machine.axes[linear[i]].name,
            "cannot be compiled: the direction or scale of this axis varies in the nominal chain");
      columns(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(i)) = *slope;
    }
  }
  return columns;
}

/// The last step that depends on a linear axis, as an index one beyond it.
std::size_t end_of_linear(const std::vector<Step>& steps, const std::vector<NodeId>& axes,
                          const Graph& graph) {
  std::size_t end = 0;
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (const NodeId axis : axes)
      if (graph.constant_slope(steps[i].by.nominal, axis) != 0.0) end = i + 1;
  return end;
}

}  // namespace

Derivation derive(const Machine& machine, double neglect_mm) {
  check_machine(machine);
  Derivation d;
  Translator translate(machine, d);
  const std::vector<Step> steps = all_steps(machine, translate, d.graph);
  std::vector<std::size_t> linear;
  std::vector<NodeId> channels;
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (!machine.axes[i].rotary) {
      linear.push_back(i);
      channels.push_back(translate.channel(ChannelKind::kPosition, i));
    }

  Walk walk(d, neglect_mm);
  const std::size_t end = end_of_linear(steps, channels, d.graph);
  for (std::size_t i = 0; i < end; ++i) walk.take(steps[i]);
  const Eigen::Matrix3Xd columns = directions(machine, walk.nominal(), linear, translate, d.graph);
  walk.freeze();
  for (std::size_t i = end; i < steps.size(); ++i) walk.take(steps[i]);

  if (linear.empty() || columns.norm() == 0)
    throw InputError({machine.file, 0}, machine.name,
                     "cannot be compiled: no linear axis moves the tool point");
  const Eigen::MatrixXd to_axes = columns.completeOrthogonalDecomposition().pseudoInverse();
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const Eigen::RowVector3d row = to_axes.row(static_cast<Eigen::Index>(i));
    if (row.norm() == 0) continue;
    std::vector<Term> terms;
    for (std::size_t c = 0; c < 3; ++c) {
      const double k = row[static_cast<Eigen::Index>(c)];
      terms.push_back({std::abs(k) < 1e-14 * row.norm() ? 0 : k, walk.deviation()[c]});
    }
    d.outputs.push_back({linear[i], d.graph.sum(0, terms), row.norm()});
  }
  return d;
}

}  // namespace vernier
