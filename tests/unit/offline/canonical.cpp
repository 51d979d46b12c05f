// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/offline/canonical.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace vernier::offline_test {
namespace {

using Eigen::Vector3d;

std::string output_of(const std::string& command) {
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("no pipe");
  std::string text;
  std::array<char, 4096> part{};
  for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), n);
  if (::pclose(pipe) != 0)
    throw std::runtime_error(command + ":\n" +
                             text.substr(text.size() - std::min<std::size_t>(text.size(), 400)));
  return text;
}

/// "12 N..... ARC_FEED(1.0000, 2.0000)": the name and the numbers.
struct Call {
  std::string name;
  std::vector<double> numbers;
  std::string words;
};
Call call_of(const std::string& line) {
  Call call;
  const auto open = line.find('('), name = line.rfind(' ', open);
  if (open == std::string::npos) return call;
  call.name = line.substr(name + 1, open - name - 1);
  call.words = line.substr(open + 1, line.rfind(')') - open - 1);
  std::istringstream parts(call.words);
  for (std::string part; std::getline(parts, part, ',');)
    call.numbers.push_back(std::strtod(part.c_str(), nullptr));
  return call;
}

CanonicalMove arc_of(const Call& call, CanonicalMove move, const Vector3d& at) {
  const int normal = 3 - move.first - move.second;
  move.from = at;
  move.to[move.first] = call.numbers[0], move.to[move.second] = call.numbers[1],
  move.to[normal] = call.numbers[5];
  Vector3d centre = Vector3d::Zero();
  centre[move.first] = call.numbers[2], centre[move.second] = call.numbers[3];
  move.centre = centre;
  const double a0 = at[move.first] - centre[move.first], b0 = at[move.second] - centre[move.second];
  const double a1 = move.to[move.first] - centre[move.first], b1 = move.to[move.second] - centre[move.second];
  const double sense = call.numbers[4] > 0 ? 1 : -1;
  move.turn = std::atan2(a0 * b1 - b0 * a1, a0 * a1 + b0 * b1);
  if (sense * move.turn <= 0) move.turn += sense * 2 * M_PI;
  return move;
}

}  // namespace

Vector3d CanonicalMove::at(double share) const {
  Vector3d place = from + share * (to - from);
  if (!centre) return place;
  const double a = from[first] - (*centre)[first], b = from[second] - (*centre)[second];
  const double end = std::hypot(to[first] - (*centre)[first], to[second] - (*centre)[second]);
  const double radius = std::hypot(a, b) + share * (end - std::hypot(a, b));
  const double angle = std::atan2(b, a) + share * turn;
  place[first] = (*centre)[first] + radius * std::cos(angle);
  place[second] = (*centre)[second] + radius * std::sin(angle);
  return place;
}

double CanonicalMove::length() const {
  if (!centre) return (to - from).norm();
  const double radius = std::hypot(from[first] - (*centre)[first], from[second] - (*centre)[second]);
  const int normal = 3 - first - second;
  return std::hypot(radius * turn, to[normal] - from[normal]);
}

bool has_interpreter() { return std::system("command -v rs274 >/dev/null 2>&1") == 0; }

std::vector<CanonicalMove> interpreted(const std::string& program) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("vernier_canonical_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string file = (folder / "program.ngc").string();
  std::ofstream(file) << program;
  const std::string text = output_of("cd '" + folder.string() + "' && rs274 -g program.ngc 2>&1");
  std::filesystem::remove_all(folder);
  std::vector<CanonicalMove> moves;
  CanonicalMove now;
  Vector3d at = Vector3d::Zero();
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const Call call = call_of(line);
    if (call.name == "SELECT_PLANE") {
      const bool xz = call.words == "CANON_PLANE_XZ", yz = call.words == "CANON_PLANE_YZ";
      now.first = xz ? 2 : yz ? 1 : 0, now.second = xz ? 0 : yz ? 2 : 1;
    }
    if (call.name == "SET_FEED_RATE") now.feed = call.numbers.at(0);
    if (call.name == "STRAIGHT_TRAVERSE" || call.name == "STRAIGHT_FEED") {
      CanonicalMove move = now;
      move.traverse = call.name == "STRAIGHT_TRAVERSE";
      move.from = at, move.to = Vector3d(call.numbers.at(0), call.numbers.at(1), call.numbers.at(2));
      moves.push_back(move);
    } else if (call.name == "ARC_FEED") {
      moves.push_back(arc_of(call, now, at));
    } else {
      continue;
    }
    at = moves.back().to;
  }
  return moves;
}

}  // namespace vernier::offline_test
