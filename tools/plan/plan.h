// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/effects/catalogue.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/plan/rival.h"

namespace vernier::plan {

struct PlanOptions {
  double confidence = 0.95;           // that the chi^2 difference names the right one
  std::optional<std::size_t> points;  // exactly so many; none: as few as the confidence needs
  std::size_t most_points = 60;       // more are no plan
  std::size_t most_bystanders = 4;    // other effects that a diagnosis would weigh beside the two
  std::size_t offers = 1000;          // rows to choose from
};

/// One direction: how far the rival's best refit stays away while `truth` is true, in units of u^2.
struct Separation {
  double now = 0, planned = 0, needed = 0;
};

/// The next measurement.
struct Plan {
  FittedRival a, b;
  model::Machine machine;   // that `rows` is bound to
  model::Measurement rows;  // planned rows in time order, readings 0; empty: nothing helps
  Separation a_true, b_true;
  double lead_of_a = 0;                    // by how much B explains the rows so far worse than A (BIC)
  bool told_already = false;               // that, or what they could show, is enough to name one of them
  bool separable = false;                  // the planned rows reach what the confidence needs
  std::vector<std::string> not_settable;   // inputs that a rival uses and nobody can set
  std::vector<std::string> ruled_out;      // other effects that explain the rows so far, and will no more
  std::vector<std::string> not_ruled_out;  // ... and that no such plan tells from the two
  std::string sentence;                    // for people
  const Separation& worse() const;
};

/// Which rows, measured next, would tell two named effects apart? `a`, `b`: ids or add strings (see
/// fit_rival). The effects must outlive the plan. Throws InputError. tool.
Plan plan_next(const std::string& text, const model::Machine& machine, const model::Measurement& measurement,
               const std::string& a, const std::string& b, const std::vector<effects::Effect>& effects,
               const PlanOptions& options = {});

/// The plan's sentence and what it needs to be carried out, for the list of a diagnosis. Empty where there is
/// nothing to say about the pair. tool.
std::vector<std::string> next_measurement(const std::string& text, const model::Machine& machine,
                                          const model::Measurement& measurement, const std::string& a,
                                          const std::string& b, const std::vector<effects::Effect>& effects,
                                          const PlanOptions& options = {});

}  // namespace vernier::plan
