// SPDX-License-Identifier: GPL-3.0-or-later
// Words that name two points: "AB", "P1-P2", "A -> C".
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vernier::importer {

/// Names of the two points of a distance.
using PointPair = std::pair<std::string, std::string>;

/// True for the name of a distance in a heading or before the names of its points: "Strecke", "Diagonale".
bool names_a_length(const std::string& word);

/// True for the heading of a column with the first (`first`), or the second point of each distance: "von" and
/// "nach", "Punkt 1" and "Punkt 2".
bool heads_end_of_pair(const std::string& heading, bool first);

/// Returns the two points that a cell names: "AB", "A-B", "A – B", "A B", "P1-P2", "P1P2", "A->C", "Diagonale
/// AC", "AC (long)". `known`: names of points that the user stated. `sure`: the heading says that the column
/// has pairs of points, so that two digits ("12"), small letters, and long names are pairs too. nullopt: the
/// cell names no two points. Two letters without a sign between them are A to W only: XY is a plane.
std::optional<PointPair> two_points(const std::string& cell, const std::vector<std::string>& known,
                                    bool sure);

/// True if a cell names two points by letters alone: "AB", "A-B".
bool names_two_points(const std::string& cell);

}  // namespace vernier::importer
