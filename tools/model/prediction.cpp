#include "tools/model/prediction.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tools/model/chain_rows.h"

namespace vernier {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr double kDeg = 180 / std::numbers::pi;

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Rotation vector of a rotation, rad; of the two around half a turn the one nearest to `like`.
Vector3d rotation_vector(const Matrix3d& rotation, const Vector3d& like) {
  const Eigen::AngleAxisd turn(rotation);
  const Vector3d vector = turn.angle() * turn.axis();
  const double angle = vector.norm();
  if (angle < 1e-9) return vector;
  const Vector3d other = vector * (1 - 2 * std::numbers::pi / angle);
  return (other - like).norm() < (vector - like).norm() ? other : vector;
}

/// d(rotation vector) = this * (small rotation applied from the left). Inverse left Jacobian of SO(3);
/// Chirikjian, Stochastic Models, Information Theory, and Lie Groups, vol. 2, section 10.4.
Matrix3d inverse_left_jacobian(const Vector3d& phi) {
  const double angle = phi.norm();
  const Matrix3d k = cross_matrix(phi);
  if (angle < 1e-4) return Matrix3d::Identity() - 0.5 * k + k * k / 12;
  const double factor = 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
  return Matrix3d::Identity() - 0.5 * k + factor * k * k;
}

/// A measured row seen through one model: predicted values and the directions in which they change.
class Row {
 public:
  Row(const Measurement& m, const BaseShift* shift, const Frame& pose) : m_(m), pose_(pose) {
    if (shift != nullptr) {
      base_ = sixdof_frame(shift->value);
      base_value_ = shift->value;
    }
    point_ = base_.rotation * pose.origin + base_.origin;
  }

  double predicted(const Observation& o, const std::array<double, 3>& measured_rotation_deg) {
    const auto at = static_cast<Eigen::Index>(o.row);
    switch (o.kind) {
      case ObservationKind::kX:
        return point_.x();
      case ObservationKind::kY:
        return point_.y();
      case ObservationKind::kZ:
        return point_.z();
      case ObservationKind::kLength:
        return (point_ - m_.centre.col(at)).norm();
      case ObservationKind::kD:
        return normal(at).dot(pose_.origin - m_.nominal_point.col(at));
      default:
        break;
    }
    const Vector3d like = Vector3d(measured_rotation_deg.data()) / kDeg;
    phi_ = rotation_vector(base_.rotation * pose_.rotation, like);
    return kDeg * phi_[static_cast<int>(o.kind) - static_cast<int>(ObservationKind::kRx)];
  }

  /// How the observation answers to a motion of the tool in the measuring frame: point . first + rotation .
  /// second.
  Twist gradient(const Observation& o) const {
    const auto at = static_cast<Eigen::Index>(o.row);
    Twist g;
    if (o.kind == ObservationKind::kLength) {
      const Vector3d arm = point_ - m_.centre.col(at);
      const double length = arm.norm();
      if (length > 0) g.point = arm / length;
    } else if (o.kind == ObservationKind::kD) {
      g.point = base_.rotation * normal(at);
    } else if (is_rotation(o.kind)) {
      const int k = static_cast<int>(o.kind) - static_cast<int>(ObservationKind::kRx);
      g.rotation = kDeg * inverse_left_jacobian(phi_).row(k).transpose();
    } else {
      g.point = Vector3d::Unit(static_cast<int>(o.kind));
    }
    return g;
  }

  std::array<Twist, 6> base_twists() const { return sixdof_twists(base_value_, point_); }
  const Matrix3d& base_rotation() const { return base_.rotation; }

 private:
  Vector3d normal(Eigen::Index at) const {
    const auto& n = m_.states.normal;
    return {n[0][at], n[1][at], n[2][at]};
  }

  const Measurement& m_;
  const Frame& pose_;
  Frame base_;
  std::array<double, 6> base_value_{};
  Vector3d point_, phi_ = Vector3d::Zero();
};

/// Observations of each row, as ranges (they are ordered by row).
std::vector<std::size_t> row_starts(const Measurement& m) {
  std::vector<std::size_t> start(m.rows() + 1, 0);
  for (const Observation& o : m.observations) ++start[o.row + 1];
  for (std::size_t i = 0; i < m.rows(); ++i) start[i + 1] += start[i];
  return start;
}

std::array<double, 3> measured_rotation(const Measurement& m, std::size_t first, std::size_t last) {
  std::array<double, 3> value{};
  for (std::size_t i = first; i < last; ++i)
    if (is_rotation(m.observations[i].kind))
      value[static_cast<std::size_t>(m.observations[i].kind) -
            static_cast<std::size_t>(ObservationKind::kRx)] = m.observations[i].value;
  return value;
}

std::vector<const BaseShift*> shifts_of_runs(const Machine& machine, const std::vector<std::string>& runs) {
  std::vector<const BaseShift*> shifts;
  for (const std::string& run : runs) {
    const auto found = base_shift_of(machine, run);
    shifts.push_back(found ? &machine.base_shifts[*found] : nullptr);
  }
  return shifts;
}

/// Where the derivatives of one machine go: which parameters a static, a table value or a BaseShift belongs
/// to.
class Wiring {
 public:
  Wiring(const Machine& machine, const ParameterSet& parameters) : machine_(machine) {
    active_.assign(machine.statics.size() + 6 * machine.axes.size(), 0);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const Parameter& p = parameters[i];
      if (p.kind == ParameterKind::kBaseShift) {
        base_[&machine.base_shifts[p.item]][p.column] = static_cast<int>(i) + 1;
        continue;
      }
      const std::size_t key = p.kind == ParameterKind::kStatic
                                  ? p.item
                                  : machine.statics.size() + machine.tables[p.item].axis * 6 + p.column;
      active_[key] = 1;
      if (first_.size() <= key) first_.resize(key + 1, -1);
      if (first_[key] < 0) first_[key] = static_cast<int>(i);
    }
    for (const Table& table : machine.tables) tables_.emplace(table.axis, StationTable(table));
  }

  const std::vector<char>& active() const { return active_; }
  int first_parameter(std::size_t key) const { return first_[key]; }
  bool is_table(std::size_t key) const { return key >= machine_.statics.size(); }
  std::size_t axis_of(std::size_t key) const { return (key - machine_.statics.size()) / 6; }
  void weights(std::size_t axis, double raw, std::vector<std::pair<std::size_t, double>>& result) const {
    tables_.at(axis).weights(raw, result);
  }
  /// Six parameter numbers plus one (0: held), or nothing for a BaseShift without a free component.
  const std::array<int, 6>* base(const BaseShift* shift) const {
    const auto found = base_.find(shift);
    return found == base_.end() ? nullptr : &found->second;
  }

 private:
  const Machine& machine_;
  std::vector<char> active_;
  std::vector<int> first_;
  std::map<const BaseShift*, std::array<int, 6>> base_;
  std::map<std::size_t, StationTable> tables_;
};

}  // namespace

Eigen::VectorXd predict(const Machine& machine, const Measurement& m) {
  const ChainRows chain(machine, m.states);
  const auto shifts = shifts_of_runs(machine, m.states.run_names);
  const std::vector<std::size_t> start = row_starts(m);
  Eigen::VectorXd predicted(static_cast<Eigen::Index>(m.observations.size()));
  for (std::size_t i = 0; i < m.rows(); ++i) {
    if (start[i] == start[i + 1]) continue;
    const Frame pose = chain.pose(i);
    Row row(m, shifts[m.states.run[i]], pose);
    const auto rotation = measured_rotation(m, start[i], start[i + 1]);
    for (std::size_t k = start[i]; k < start[i + 1]; ++k)
      predicted[static_cast<Eigen::Index>(k)] = row.predicted(m.observations[k], rotation);
  }
  return predicted;
}

Linearisation linearise(const Machine& machine, const Measurement& m, const ParameterSet& parameters) {
  const Wiring wiring(machine, parameters);
  const ChainRows chain(machine, m.states, wiring.active());
  const auto shifts = shifts_of_runs(machine, m.states.run_names);
  const std::vector<std::size_t> start = row_starts(m);
  Linearisation result;
  result.predicted.resize(static_cast<Eigen::Index>(m.observations.size()));
  std::vector<int> outer{0}, columns;
  std::vector<double> values;
  std::vector<Twist> twists;
  std::vector<std::pair<int, Twist>> entries;  // parameter, twist of the tool in the measuring frame
  std::map<std::size_t, std::vector<std::pair<std::size_t, double>>> weights;
  for (std::size_t i = 0; i < m.rows(); ++i) {
    if (start[i] == start[i + 1]) continue;
    const BaseShift* shift = shifts[m.states.run[i]];
    const Frame pose = chain.pose(i, twists);
    Row row(m, shift, pose);
    entries.clear();
    weights.clear();
    for (std::size_t k = 0; k < twists.size(); ++k) {
      const std::size_t key = chain.keys()[k];
      const Twist twist{row.base_rotation() * twists[k].point, row.base_rotation() * twists[k].rotation};
      const int first = wiring.first_parameter(key);
      if (!wiring.is_table(key)) {
        entries.emplace_back(first, twist);
        continue;
      }
      const std::size_t axis = wiring.axis_of(key);
      auto [found, fresh] = weights.try_emplace(axis);
      if (fresh) wiring.weights(axis, m.states.axis[axis][static_cast<Eigen::Index>(i)], found->second);
      for (const auto& [station, weight] : found->second)
        entries.emplace_back(first + static_cast<int>(station),
                             Twist{weight * twist.point, weight * twist.rotation});
    }
    // Statics and stations come in the order in which the chain meets them; sparse rows want them sorted.
    std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const std::size_t machine_entries = entries.size();
    if (const auto* base = wiring.base(shift)) {
      const std::array<Twist, 6> six = row.base_twists();
      for (std::size_t c = 0; c < 6; ++c)
        if ((*base)[c] > 0) entries.emplace_back((*base)[c] - 1, six[c]);
    }
    const auto rotation = measured_rotation(m, start[i], start[i + 1]);
    for (std::size_t k = start[i]; k < start[i + 1]; ++k) {
      const Observation& o = m.observations[k];
      result.predicted[static_cast<Eigen::Index>(k)] = row.predicted(o, rotation);
      const Twist g = row.gradient(o);
      const bool uses_base = o.kind != ObservationKind::kD;  // d is given in workpiece coordinates
      for (std::size_t e = 0; e < entries.size(); ++e) {
        if (e >= machine_entries && !uses_base) break;
        columns.push_back(entries[e].first);
        values.push_back(g.point.dot(entries[e].second.point) + g.rotation.dot(entries[e].second.rotation));
      }
      outer.push_back(static_cast<int>(columns.size()));
    }
  }
  result.jacobian = Eigen::Map<const SparseRows>(
      static_cast<Eigen::Index>(m.observations.size()), static_cast<Eigen::Index>(parameters.size()),
      static_cast<Eigen::Index>(columns.size()), outer.data(), columns.data(), values.data());
  return result;
}

}  // namespace vernier
