// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/plan/drawn_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/plan/offered_poses.h"

namespace vernier::bench {

using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::plan;

using Random = std::mt19937_64;

double between(double low, double high, Random& random) {
  return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(random);
}

Machine drawn_machine(Random& random) {
  std::array<char, 3> order = {'X', 'Y', 'Z'};
  std::shuffle(order.begin(), order.end(), random);
  std::string axes, tables, chain;
  for (std::size_t i = 0; i < 3; ++i) {
    const char axis = order[i];
    const double travel = std::round(between(200, 1200, random));
    axes += fmt::format("<{} min=\"0\" max=\"{}\"/>", axis, travel);
    std::string columns;
    for (const char* column : {"X", "Y", "Z", "rX", "rY", "rZ"})
      if (between(0, 1, random) < 0.6) columns += (columns.empty() ? "" : " ") + std::string(column);
    const int stations = static_cast<int>(between(3, 6.99, random));
    tables += fmt::format("<table axis=\"{}\" fit=\"{}\">", axis, columns);
    for (int k = 0; k < stations; ++k)
      tables += fmt::format("<station loc=\"{}\"/>", travel * k / (stations - 1));
    tables += "</table>";
    chain += "<sixdof";
    for (const char direction : {'X', 'Y', 'Z'})
      chain += fmt::format(" {}=\"l{}{}{}{}\"", direction, axis, static_cast<char>(direction + 32),
                           direction == axis ? "+" : "", direction == axis ? std::string(1, axis) : "");
    for (const char turn : {'X', 'Y', 'Z'})
      chain += fmt::format(" r{}=\"r{}{}{}\"", turn, axis, static_cast<char>(turn + 32),
                           i == 0 ? "" : fmt::format("+s{}{}", axis, turn));
    chain += "/>";
  }
  std::string statics;
  for (std::size_t i = 1; i < 3; ++i)
    for (const char turn : {'X', 'Y', 'Z'})
      statics += fmt::format("<s{}{} value=\"0\" nominal=\"0\" unit=\"deg\"/>", order[i], turn);
  return parse_machine("<machine name=\"drawn\"><variables><static>" + statics +
                           "<BaseShift/></static><machineaxes>" + axes + "</machineaxes><comptables>" +
                           tables + "</comptables></variables><transforms branch=\"tool\">" + chain +
                           "<sixdof Z=\"-150\"/></transforms></machine>",
                       "drawn.xml");
}

Machine true_machine(const Machine& machine, double expected_um, Random& random) {
  std::normal_distribution<double> normal(0, 1);
  Machine truth = machine;
  const Measurement rows = point_readings(offered_poses(machine, 400, 5000));
  const ParameterSet parameters(truth, {""});
  const Eigen::MatrixXd all(linearise(machine, rows, parameters).jacobian);
  Eigen::VectorXd values = parameters.get(truth);
  for (Eigen::Index j = 0; j < all.cols(); ++j) {
    const double size = all.col(j).norm() / std::sqrt(400.0);
    if (size > 0) values[j] = 1e-3 * expected_um / size * normal(random);
  }
  parameters.set(truth, values);
  return truth;
}

States first_of(const States& states, std::size_t count) {
  std::vector<std::size_t> which(count);
  for (std::size_t i = 0; i < count; ++i) which[i] = i;
  return select_states(states, which);
}

States iso_lines(const Machine& machine, std::size_t each) {
  std::vector<std::array<double, 3>> places;
  std::vector<double> senses;
  const auto walk = [&](const std::array<double, 3>& from, const std::array<double, 3>& to) {
    for (const double sense : {1.0, -1.0})
      for (std::size_t k = 0; k < each; ++k) {
        const double s = each == 1 ? 0.5 : static_cast<double>(k) / static_cast<double>(each - 1);
        std::array<double, 3> at{};
        for (std::size_t a = 0; a < 3; ++a) at[a] = from[a] + s * (to[a] - from[a]);
        places.push_back(at);
        senses.push_back(sense);
      }
  };
  for (std::size_t a = 0; a < 3; ++a) {
    std::array<double, 3> from{0.5, 0.5, 0.5}, to = from;
    from[a] = 0, to[a] = 1;
    walk(from, to);
  }
  for (int diagonal = 0; diagonal < 4; ++diagonal) {
    const double y = diagonal & 1, z = diagonal >> 1;
    walk({0, y, z}, {1, 1 - y, 1 - z});
  }
  States states = make_states(places.size(), 3, {});
  make_one_run(states, "");
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const auto at = static_cast<Eigen::Index>(i);
      const auto range = *work_range(machine, a);
      states.axis[a][at] = range[0] + places[i][a] * (range[1] - range[0]);
      states.direction[a][at] = senses[i];
    }
  return states;
}

States anywhere(const Machine& machine, std::size_t count, Random& random) {
  States states = make_states(count, machine.axes.size(), {});
  make_one_run(states, "");
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t a = 0; a < machine.axes.size(); ++a) {
      const auto at = static_cast<Eigen::Index>(i);
      states.axis[a][at] = between((*work_range(machine, a))[0], (*work_range(machine, a))[1], random);
      states.direction[a][at] = between(-1, 1, random) < 0 ? -1 : 1;
    }
  return states;
}

}  // namespace vernier::bench
