// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/term_discovery.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <array>
#include <cmath>

#include "tests/support/hidden_survey_draw.h"

namespace vernier::support {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::array<double, 3> kLow = {0, 0, -300}, kHigh = {600, 400, 0};  // mm
constexpr Index kStations = 5;
constexpr double kGeometryUm = 3.3, kNoiseUm = 1;

/// Slow weather of unit size about zero: a few waves over the survey and a random walk.
VectorXd weather(Index rows, Draw& draw) {
  VectorXd v(rows);
  const double phase = draw.uniform(0, 6.283), waves = draw.uniform(1, 4);
  double walk = 0;
  for (Index i = 0; i < rows; ++i) {
    walk += draw.normal() / std::sqrt(static_cast<double>(rows));
    v[i] = std::sin(6.283 * waves * static_cast<double>(i) / static_cast<double>(rows) + phase) + walk;
  }
  v.array() -= v.mean();
  return v / std::sqrt(v.squaredNorm() / static_cast<double>(rows));
}

VectorXd white(Index rows, Draw& draw) {
  VectorXd v(rows);
  for (Index i = 0; i < rows; ++i) v[i] = draw.normal();
  return v;
}

void make_inputs(TermDiscovery& data, Index rows, Draw& draw) {
  data.input_names = {"T",    "T_near", "T_room", "humidity", "pressure", "current",
                      "load", "acc",    "supply", "coolant",  "shift",    "flow"};
  data.inputs.resize(rows, 12);
  const VectorXd t = weather(rows, draw);
  // Correlation 0.94 with T each: alone, either explains nearly nine tenths of what T does.
  data.inputs.col(0) = 20.5 + 2 * t.array();
  data.inputs.col(1) = 20.8 + 2 * (t + 0.36 * weather(rows, draw)).array();
  data.inputs.col(2) = 19.9 + 2 * (t + 0.36 * weather(rows, draw)).array();
  for (Index c = 3; c < 12; ++c)
    data.inputs.col(c) = 10 + (c % 2 == 0 ? white(rows, draw) : weather(rows, draw)).array();
}

/// Hat functions of the stations, a constant included.
void make_geometry(TermDiscovery& data, Index rows, Draw& draw) {
  data.position.resize(3, rows);
  data.geometry_basis = Eigen::MatrixXd::Zero(rows, 3 * kStations);
  for (Index i = 0; i < rows; ++i)
    for (Index a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      const double part = draw.uniform() * (kStations - 1);
      const double q = kLow[k] + (kHigh[k] - kLow[k]) * part / (kStations - 1);
      data.position(a, i) = std::round(q * 1e4) / 1e4;
      const auto cell = static_cast<Index>(part);
      data.geometry_basis(i, kStations * a + cell) = 1 - (part - static_cast<double>(cell));
      data.geometry_basis(i, kStations * a + cell + 1) = part - static_cast<double>(cell);
    }
  data.geometry_um = data.geometry_basis * white(3 * kStations, draw);
  data.geometry_um.array() -= data.geometry_um.mean();
  data.geometry_um *= kGeometryUm / std::sqrt(data.geometry_um.squaredNorm() / static_cast<double>(rows));
}

}  // namespace

TermDiscovery make_term_discovery(std::uint64_t seed, double sigmas, Index rows) {
  Draw draw(seed * 0x9E3779B97F4A7C15ULL + 1);
  TermDiscovery data;
  make_inputs(data, rows, draw);
  make_geometry(data, rows, draw);
  const VectorXd term = (data.inputs.col(0).array() - 20) * data.position.row(0).transpose().array();
  // x itself, so the unknown reference, is in the geometry's span.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> geometry(data.geometry_basis);
  data.bound = kNoiseUm / (term - data.geometry_basis * geometry.solve(term)).norm();
  data.coefficient = draw.sign() * sigmas * data.bound;
  data.reading_um = data.geometry_um + data.coefficient * term + kNoiseUm * white(rows, draw);
  return data;
}

TermDiscoveryFiles term_discovery_files(const TermDiscovery& data) {
  TermDiscoveryFiles files;
  std::string axes, tables;
  for (std::size_t a = 0; a < 3; ++a) {
    const char name = "XYZ"[a];
    axes += fmt::format("<{} min=\"{}\" max=\"{}\"/>", name, kLow[a], kHigh[a]);
    tables += fmt::format("<table axis=\"{}\" fit=\"X\">", name);
    for (Index s = 0; s < kStations; ++s)
      tables += fmt::format("<station loc=\"{}\"/>",
                            kLow[a] + (kHigh[a] - kLow[a]) * static_cast<double>(s) / (kStations - 1));
    tables += "</table>";
  }
  files.model = fmt::format(
      "<machine name=\"term-discovery\"><variables><static><BaseShift X=\"0\" "
      "Hide=\"true\"/></static><machineaxes>{}"
      "</machineaxes><comptables>{}</comptables></variables><transforms branch=\"tool\"><sixdof n=\"1\" "
      "X=\"X+lXx+lYx+lZx\" Y=\"Y\" Z=\"Z\"/></transforms></machine>\n",
      axes, tables);
  files.csv = "X[mm],Y[mm],Z[mm]";
  for (std::size_t c = 0; c < data.input_names.size(); ++c)
    files.csv += "," + data.input_names[c] + (c < 3 ? "[degC]" : "");
  files.csv += ",x[mm],u[mm]\n";
  for (Index i = 0; i < data.position.cols(); ++i) {
    for (Index a = 0; a < 3; ++a) files.csv += fmt::format("{:.4f},", data.position(a, i));
    for (Index c = 0; c < data.inputs.cols(); ++c) files.csv += fmt::format("{:.6f},", data.inputs(i, c));
    files.csv += fmt::format("{:.7f},0.001\n", data.position(0, i) + data.reading_um[i] / 1000);
  }
  return files;
}

}  // namespace vernier::support
