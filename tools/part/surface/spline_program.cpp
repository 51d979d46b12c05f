// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/surface/spline_program.h"

#include <fmt/format.h>

#include "tools/part/surface/s_part.h"

namespace vernier::part {
namespace {

using Eigen::Vector3d;

/// Three decimals at most, as the tables have them.
std::string written(double value_mm) {
  std::string text = fmt::format("{:.3f}", value_mm);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

/// Control points of the curve at a height: those of both edges mixed, as the surface is ruled.
Vector3d control_at(const RuledSurface& flank, std::size_t i, double z_mm) {
  const double share = z_mm / kPartHeightMm;
  return (1 - share) * flank.bottom.control()[i] + share * flank.top.control()[i];
}

std::string place(const Vector3d& path, const Vector3d& axis) {
  return fmt::format("X{} Y{} Z{} XH={} YH={} ZH={}", written(path.x()), written(path.y()), written(path.z()),
                     written(axis.x()), written(axis.y()), written(axis.z()));
}

}  // namespace

std::string spline_program(double path_z_mm, double axis_z_mm) {
  std::string text;
  for (const RuledSurface& flank : s_part()) {
    const std::size_t count = flank.bottom.control().size();
    const double span_mm = flank.bottom.length_mm() / static_cast<double>(flank.bottom.spans());
    const auto at = [&](std::size_t i) {
      return place(control_at(flank, i, path_z_mm), control_at(flank, i, axis_z_mm));
    };
    // The side of the tool, once: it holds for the second flank.
    text += fmt::format("ORICURVE\nG1 {}{}\nBSPLINE SD=3\n", text.empty() ? "G42 " : "", at(0));
    for (std::size_t i = 1; i < count; ++i) {
      const bool inner = i > 1 && i + 1 < count;
      text += at(i) + (inner ? fmt::format(" PL={:.4f} ;arc{}\n", span_mm, i - 1) : " PL=0\n");
    }
  }
  return text;
}

}  // namespace vernier::part
