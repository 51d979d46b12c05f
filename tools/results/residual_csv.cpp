// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/residual_csv.h"

#include "tools/format/readings.h"
#include "tools/text/csv.h"
#include "tools/text/numbers.h"

namespace vernier::results {
std::string residual_csv(const model::Measurement& m, const Eigen::VectorXd& residual) {
  std::string text = "row,observation,value,prediction,residual,u,unit,role,run,file,line\n";
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    const double left = residual[static_cast<Eigen::Index>(i)];
    const double u = model::uncertainty_of(m, o);
    text += std::to_string(o.row + 1) + "," + format::name_of(o.kind) + "," + text::number_text(o.value) +
            "," + text::number_text(o.value - left) + "," + text::number_text(left) + "," +
            (u > 0 ? text::number_text(u) : "") + "," + (model::is_rotation(o.kind) ? "deg" : "mm") + "," +
            (m.check[o.row] != 0 ? "check" : "fit") + "," +
            text::csv_cell(m.states.run_names[m.states.run[o.row]]) + "," +
            text::csv_cell(m.files[m.file[o.row]]) + "," + std::to_string(m.line[o.row]) + "\n";
  }
  return text;
}

}  // namespace vernier::results
