// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_outside.h"

#include <fmt/format.h>

#include <algorithm>

#include "tests/support/hidden_survey_forms.h"
#include "tests/support/hidden_survey_inputs.h"

namespace vernier::support {
namespace {

/// Unit interval over an axis' range, as text.
std::string unit_of(const AxisPlace& a) {
  return fmt::format("({}-({:g}))/{:g}", a.name, a.low, a.high - a.low);
}

std::string random_field(const Geometry& g, Draw& draw) {
  std::string text = "(";
  for (int wave = 0; wave < 4; ++wave) {
    std::string phase = fmt::format("{:.1f}", draw.uniform(0, 360));
    for (const AxisPlace& a : g.axes) phase += fmt::format("{:+.1f}*{}", draw.uniform(-400, 400), unit_of(a));
    text += fmt::format("{:+.3f}*cos({})", draw.normal(), phase);
  }
  return text + ")";
}

/// 4 to 8 waves whose length goes as 1/q: half of them, and more, have half-waves below an eighth of the
/// axis. Called straightness or positioning error (smooth functions of q, FORMATS section 4) it would be a
/// wrong name.
std::string chirp(const Geometry& g, Draw& draw) {
  const AxisPlace& a = draw.pick(g.axes);
  return fmt::format("sin({:.0f}*({})^2+{:.0f})", draw.uniform(1500, 3000), unit_of(a), draw.uniform(0, 360));
}

std::string bump(const Geometry& g, Draw& draw) {
  const std::size_t i = draw.index(g.axes.size());
  const std::size_t j = g.axes.size() > 1 ? (i + 1 + draw.index(g.axes.size() - 1)) % g.axes.size() : i;
  return fmt::format("exp(-(({}-{:.2f})/{:.2f})^2-(({}-{:.2f})/{:.2f})^2)", unit_of(g.axes[i]),
                     draw.uniform(0.25, 0.75), draw.uniform(0.12, 0.25), unit_of(g.axes[j]),
                     draw.uniform(0.25, 0.75), draw.uniform(0.12, 0.25));
}

std::string four_factors(const Geometry& g, const std::vector<LoggedColumn>& columns, Draw& draw) {
  std::string text = fmt::format("({}-20)*cos({:.0f}*{})", columns[draw.index(4)].name,
                                 draw.uniform(200, 500), unit_of(draw.pick(g.axes)));
  for (int i = 0; i < 2; ++i)
    text += fmt::format("*({}-{:.2f})", unit_of(draw.pick(g.axes)), draw.uniform(0.3, 0.7));
  return "(" + text + ")";
}

}  // namespace

Form outside_form(const Geometry& g, const std::vector<LoggedColumn>& columns, Draw& draw) {
  // A smooth field over one axis is an error along that axis, which the catalogue holds.
  const std::size_t shape = g.axes.size() > 1 ? draw.index(4) : draw.chance(0.5) ? 1 : 3;
  const char* const names[] = {"outside:field", "outside:four-factors", "outside:bump", "outside:chirp"};
  Form form;
  form.cause.effect = names[shape];
  std::vector<const TransformPlace*> tips;
  for (const TransformPlace& t : g.transforms)
    if (std::any_of(t.dofs.begin(), t.dofs.end(), [](const auto& d) { return !is_angle(d); }))
      tips.push_back(&t);
  const TransformPlace& tip = *(shape == 0 ? tips.back() : draw.pick(tips));
  std::vector<std::string> dofs;
  for (const std::string& dof : tip.dofs)
    if (!is_angle(dof)) dofs.push_back(dof);
  if (shape != 0) dofs = {draw.pick(dofs)};
  for (const std::string& dof : dofs) {
    const std::string text = shape == 0   ? random_field(g, draw)
                             : shape == 1 ? four_factors(g, columns, draw)
                             : shape == 2 ? bump(g, draw)
                                          : chirp(g, draw);
    form.places.push_back({tip.workpiece, tip.n, dof, "k1*" + text});
  }
  if (shape == 1)
    for (const LoggedColumn& c : columns)
      if (form.places.front().text.find(c.name) != std::string::npos) form.inputs.push_back(c.name);
  form.coefficients = {1};
  return form;
}

}  // namespace vernier::support
