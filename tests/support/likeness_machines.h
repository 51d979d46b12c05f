// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tests/support/hidden_survey_draw.h"

namespace vernier::support {

/// A machine in the likeness of one that people survey: its file drawn anew for each seed.
struct LikenessMachine {
  const char* name;
  std::string (*file)(Draw& draw);  // every axis with min and max
  double u_mm, feed;                // as Geometry; of an angle u_mm / 1 m
  /// Effects that a real one has, in the ids of FORMATS.
  std::vector<std::string> effects;
};

/// Six-joint robots of published makes, star directions of alt-azimuth and equatorial mounts, the bed of a
/// printer probed, a turntable under an autocollimator, a worm gear train, an arm on a torso that leans.
const std::vector<LikenessMachine>& likeness_machines();

/// A hidden term of such a machine, worked out by hand from its own geometry: text with k1, and the places
/// that share it.
struct LikenessTerm {
  std::string axis;  // that it is about; empty: several
  struct At {
    int n;
    std::string dof, text;
  };
  std::vector<At> at;
};
/// Terms of joint-compliance or gravity-sag on the machine of that name.
std::vector<LikenessTerm> gravity_terms(const std::string& machine, const std::string& effect,
                                        const std::string& file);

}  // namespace vernier::support
