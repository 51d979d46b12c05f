// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/machine.h"

namespace vernier::create {

/// What a reading of the survey is.
enum class Reading {
  kPoint,   // x y z: tracker, 3-D probe on a known sphere, camera
  kLength,  // length with cx cy cz: ball bar, telescoping bar
  kTouch,   // d along nx ny nz from px py pz: dial gauge, touch probe on a known surface
  kPose,    // x y z and rx ry rz: six-degree tracker
};

/// "point", "length", "touch", "pose". Throws InputError.
Reading reading_of(const std::string& name);

/// A measurement file to be filled in: remarks that explain each column, the header for this machine, and
/// positions that see its errors (every axis alone, forth and back; then poses all over the travel, every
/// fourth one a check row) with their measured cells empty. tool.
std::string survey_template(const model::Machine& machine, Reading reading);

/// Such a survey as a workbook (.xlsx): its rows on the first sheet, the remarks on the second. tool.
std::string survey_workbook(const std::string& survey);

}  // namespace vernier::create
