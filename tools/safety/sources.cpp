// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/safety/sources.h"

#include <cmath>

#include "tools/model/chain/chain.h"

namespace vernier::safety {
namespace {

constexpr double kNothing_mm = 1e-12;  // rounding of a chain of metres

}  // namespace

std::vector<Source> error_sources(const model::Machine& machine, const model::States& states) {
  const model::Machine nominal = model::nominal_machine(machine);
  const Eigen::Matrix3Xd at_nominal = model::forward(nominal, states).position;
  std::vector<Source> sources;
  const auto take = [&](const std::string& name, bool is_table, const model::Machine& with) {
    const Eigen::Matrix3Xd moved = model::forward(with, states).position - at_nominal;
    Source source{name, is_table, moved.rowwise().mean(), 0, 0};
    const auto count = static_cast<double>(moved.cols());
    source.rms_mm = std::sqrt(moved.squaredNorm() / count);
    source.varying_rms_mm = std::sqrt((moved.colwise() - source.mean_mm).squaredNorm() / count);
    if (source.rms_mm > kNothing_mm) sources.push_back(std::move(source));
  };
  for (std::size_t i = 0; i < machine.statics.size(); ++i) {
    if (machine.statics[i].value == nominal.statics[i].value) continue;
    model::Machine with = nominal;
    with.statics[i].value = machine.statics[i].value;
    take(machine.statics[i].name, false, with);
  }
  for (std::size_t t = 0; t < machine.tables.size(); ++t)
    for (std::size_t c = 0; c < 6; ++c) {
      model::Machine with = nominal;
      bool any = false;
      for (std::size_t s = 0; s < machine.tables[t].stations.size(); ++s) {
        with.tables[t].stations[s].value[c] = machine.tables[t].stations[s].value[c];
        any = any || machine.tables[t].stations[s].value[c] != 0;
      }
      if (any)
        take("table." + machine.axes[machine.tables[t].axis].name + "." + model::kSixDofNames[c], true, with);
    }
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    if (machine.axes[i].scale_factor == 0) continue;
    model::Machine with = nominal;
    with.axes[i].scale_factor = machine.axes[i].scale_factor;
    take("scalefactor." + machine.axes[i].name, false, with);
  }
  return sources;
}

bool acts(const model::Machine& machine, const model::Symbol& symbol) {
  bool found = false;
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const model::Transform& transform : *branch)
      for (std::size_t d = 0; d < transform.dof_count(); ++d)
        model::walk(*transform.dof[d], [&](const model::Expr& node) {
          if (node.op != model::Op::kSymbol) return;
          found =
              found || node.symbol == symbol ||
              (symbol.kind == model::SymbolKind::kAxis &&
               node.symbol.kind == model::SymbolKind::kTableValue && node.symbol.index / 6 == symbol.index);
        });
  return found;
}

}  // namespace vernier::safety
