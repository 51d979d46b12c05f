// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <random>
#include <string>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::support {

using namespace vernier::model;

/// A machine with everything that the format offers: two branches, sixdof and DH, linear, cubic and periodic
/// tables, two BaseShifts, an input, lag, rotary axes. All errors are non-zero.
Machine full_machine();

/// A measurement of `rows` random poses of full_machine() with every kind of observation; readings are 0 and
/// u is 1 um.
Measurement full_measurement(const Machine& machine, std::size_t rows, std::mt19937_64& random);

/// Expects that the derivatives of all predictions by the free parameters agree with differences, and that
/// linearising predicts what predicting does.
void expect_derivatives(const Machine& machine, const Measurement& measurement,
                        const ParameterSet& parameters);

/// Three-axis bridge, tables of `stations` stations on every axis with all columns free, squareness, three
/// set-ups.
std::string bridge_text(std::size_t stations);

}  // namespace vernier::support
