// SPDX-License-Identifier: GPL-3.0-or-later
// Data types for the symbolic error equation of a chain.
#pragma once
#include <ginac/ginac.h>

#include <array>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::derive {

/// One error of the machine: a table value at the pose, the difference of a static from its nominal value, or
/// a scale factor. In the equation, the error is a number in the unit `unit`.
struct ErrorParameter {
  GiNaC::realsymbol symbol;
  std::string name;        // name by ISO 230 for table values (EXX); name of a static, or d_NAME if its
                           // nominal value is not 0
  std::string source;      // name as in the machine file: lXx, AL, scalefactor of X
  model::Symbol key;       // kTableValue, kStatic, or kAxis for a scale factor
  std::string unit;        // mm, rad, or the unit of the static
  double file_units = 1;   // factor from `unit` to the unit of the machine file: 180/pi if the file has deg
  double magnitude = 0;    // largest assumed absolute value, in `unit`
  bool from_file = false;  // true: the magnitude comes from the machine file (largest table value, or value -
                           // nominal)
};

/// A quantity of the nominal chain that remains a symbol: axis position (mm, rad), input, length, motion.
struct NominalSymbol {
  GiNaC::realsymbol symbol;
  std::string name;
  model::Symbol key;
  std::string unit;
  double file_units = 1;  // factor from `unit` to the unit of the machine file: 180/pi for a rotary axis
};

/// A subexpression without a derivative, which becomes one symbol: a comparison, sign, abs, min, max, lag.
struct OpaqueSymbol {
  GiNaC::realsymbol symbol;
  model::ExprPtr expr;  // expression at nominal values
  std::vector<GiNaC::ex> args;
};

/// A long sum of lengths in the nominal chain (for example tool offsets) that one symbol replaces.
struct Abbreviation {
  GiNaC::realsymbol symbol;
  GiNaC::ex value;  // mm
};

/// Sensitivity to one error: first-order deviation of the tool point in workpiece coordinates (mm) and
/// rotation vector of the tool (rad), dX dY dZ, dA dB dC per unit of the parameter.
using Sensitivity = std::array<GiNaC::ex, 6>;

/// An elementary motion of the chain, in the order from the workpiece to the tool: along or about x, y or z.
/// `value`: amount of the motion including all errors, mm or rad. If all errors are 0, `value` is the amount
/// in the nominal chain.
struct ElementaryMotion {
  bool rotation = false;
  int axis = 0;
  GiNaC::ex value;
  bool workpiece = false;  // branch, index of the transform, and degree of freedom
  std::size_t link = 0, dof = 0;
};

/// The error equation of a chain to first order: deviation = sum over parameters of sensitivity * parameter.
struct ErrorEquation {
  model::Machine machine;
  std::vector<ErrorParameter> parameters;
  std::vector<NominalSymbol> nominal;
  std::vector<OpaqueSymbol> opaque;
  std::vector<Abbreviation> abbreviations;
  std::vector<ElementaryMotion> motions;
  std::array<GiNaC::ex, 3> position;     // nominal tool point in workpiece coordinates, mm
  std::array<GiNaC::ex, 3> tool_axis;    // nominal direction of the tool's z in workpiece coordinates
  std::vector<Sensitivity> sensitivity;  // one sensitivity for each parameter
  std::vector<std::string> notes;        // conventions that were used, and parameters that act only in second
                                         // order
};

/// Assumed sizes of errors whose size is not in the machine file (tables of zeros, statics at their nominal
/// value).
struct ErrorSizes {
  double length_mm = 0.1;
  double angle_rad = 1e-3;
  double number = 1e-3;  // for numbers without unit and for other units, in their own unit
};

}  // namespace vernier::derive
