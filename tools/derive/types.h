// SPDX-License-Identifier: GPL-3.0-or-later
// The error equation of a chain in symbols: values, no algorithm.
#pragma once
#include <ginac/ginac.h>

#include <array>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::derive {

/// One error of the machine: a table value (at the pose), the deviation of a static from its nominal, or a
/// scale factor. In the equation the error is a number in `unit`.
struct ErrorParameter {
  GiNaC::realsymbol symbol;
  std::string name;       // ISO 230 for table values (EXX), the static's name, d_NAME if its nominal is not 0
  std::string source;     // as in the machine file: lXx, AL, scalefactor of X
  model::Symbol key;      // kTableValue, kStatic, or kAxis for a scale factor
  std::string unit;       // mm, rad, or the static's own unit
  double file_units = 1;  // machine-file units per `unit`: 180/pi if the file has deg
  double magnitude = 0;   // largest assumed absolute value, in `unit`
  bool from_file = false;  // the magnitude is the machine's own (largest table value, value - nominal)
};

/// A quantity of the nominal chain that stays a symbol: axis position (mm, rad), input, length, motion.
struct NominalSymbol {
  GiNaC::realsymbol symbol;
  std::string name;
  model::Symbol key;
  std::string unit;
  double file_units = 1;  // machine-file units per `unit`: 180/pi for a rotary axis
};

/// A subexpression without a derivative, which becomes one symbol: a comparison, sign, abs, min, max, lag.
struct OpaqueSymbol {
  GiNaC::realsymbol symbol;
  model::ExprPtr expr;  // at nominal values
  std::vector<GiNaC::ex> args;
};

/// A long length of the nominal chain (for example a sum of tool offsets), which becomes one symbol.
struct Abbreviation {
  GiNaC::realsymbol symbol;
  GiNaC::ex value;  // mm
};

/// First-order deviation of the tool point in workpiece coordinates (mm) and rotation vector of the tool
/// (rad) by one error: dX dY dZ, dA dB dC per unit of the parameter.
using Sensitivity = std::array<GiNaC::ex, 6>;

/// An elementary motion of the chain from the workpiece to the tool: along or about x, y or z. `value`: mm or
/// rad including all errors. With all errors 0, `value` is the value of the nominal chain.
struct ElementaryMotion {
  bool rotation = false;
  int axis = 0;
  GiNaC::ex value;
  bool workpiece = false;  // branch, transform, degree of freedom
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
  std::vector<Sensitivity> sensitivity;  // by parameter
  std::vector<std::string> notes;        // conventions that were used; parameters of second order only
};

/// Sizes of errors whose size is not in the machine file (zero tables, statics at their nominal).
struct ErrorSizes {
  double length_mm = 0.1;
  double angle_rad = 1e-3;
  double number = 1e-3;  // pure numbers and other units, in their own unit
};

}  // namespace vernier::derive
