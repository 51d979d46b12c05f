// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tests/support/hidden_survey.h"
#include "tests/support/hidden_survey_draw.h"
#include "tools/model/machine.h"

namespace vernier::support {

using namespace vernier::model;
using namespace vernier::text;

/// Where an axis acts: transform, and the degree of freedom that is its motion.
struct AxisPlace {
  std::string name;
  bool rotary = false;
  double low = 0, high = 0;  // range of the survey, mm or deg
  bool workpiece = false;
  std::size_t order = 0;  // of the transform in its branch, from 0
  int n = 0;
  std::string dof;
  double sense = 1;  // of the motion of its transform against its reading
  /// Of the tool point as the workpiece sees it.
  double tool_sense() const { return workpiece ? -sense : sense; }
};

/// A transform that an error can be put into.
struct TransformPlace {
  bool workpiece = false;
  std::size_t order = 0;
  int n = 0;
  std::vector<std::string> dofs;
};

/// What the generator knows about a family.
struct Geometry {
  Family family = Family::kBridge;
  std::string text;  // the machine file that it starts from
  std::vector<AxisPlace> axes;
  std::vector<TransformPlace> transforms;
  double u_mm = 0;  // usual uncertainty of a reading
  double feed = 0;  // the fastest, mm/min
  /// Axes whose position changes a moment of gravity, and the angle that gives way ("": the axis itself).
  std::vector<std::pair<std::string, std::string>> bends;
  std::vector<std::pair<std::string, double>> held;  // columns of hidden axes and their value
  bool all_linear() const;
  const AxisPlace* axis(const std::string& name) const;
};
/// `seed`: of a machine that is drawn.
Geometry geometry_of(Family family, std::uint64_t seed = 1);
/// Effects that a machine in the likeness of a real one has; empty for the reference machines.
std::vector<std::string> effects_in_likeness(Family family);

/// Which errors the user's model leaves free.
enum class ModelKind : std::uint8_t { kTables, kStatics, kBare };

struct ModelOptions {
  ModelKind kind = ModelKind::kStatics;
  std::vector<std::string> runs;  // a BaseShift for each of these
  bool shift_per_run = true;
  bool hold_shift = false;                   // readings that do not see the datum
  std::string axis_without, column_without;  // a table column that is not freed
};

/// The user's machine file: free statics, station tables, BaseShift; all errors 0.
std::string model_text(const Geometry& geometry, const ModelOptions& options, Draw& draw);

/// True values of everything that is free in `text`: smooth tables, random statics, of about `size_mm`.
Machine true_values(const std::string& text, const Geometry& geometry, double size_mm, Draw& draw);

/// A term at a degree of freedom.
struct Place {
  bool workpiece = false;
  int n = 0;
  std::string dof, text;
};
struct TermStatic {
  std::string name;
  double value = 0;
};
struct TermInput {
  std::string name, unit;
  double reference = 0;
};
/// Writes terms into a machine file: text added to the degrees of freedom, statics and inputs declared.
std::string with_terms(const std::string& text, const std::vector<Place>& places,
                       const std::vector<TermStatic>& statics, const std::vector<TermInput>& inputs);

}  // namespace vernier::support
