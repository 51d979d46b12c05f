// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/axis_motion.h"

#include <algorithm>
#include <cmath>

namespace vernier::offline {

using Eigen::Index, Eigen::VectorXd;

VectorXd ProgramMove::at(double share) const { return arc ? arc->at(share) : from + share * (to - from); }

AxisMotion::AxisMotion(const model::Machine& machine, const model::States& at)
    : machine_(machine), at_(at), turn_(machine.axes.size(), std::nan("")), sense_(machine.axes.size(), 0) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    detail_.push_back(model::detail_along(machine, i, at));
}

std::vector<double> AxisMotion::stretches(const ProgramMove& move) const {
  std::vector<double> ends = {0};
  // Number of positions at which the direction of an axis is evaluated, half a degree of a circle each;
  // halvings to the last digit.
  constexpr int kLooks = 720, kHalvings = 40;
  for (std::size_t i = 0; move.arc && i < machine_.axes.size(); ++i) {
    const auto axis = static_cast<Index>(i);
    const auto slope = [&](double s) {
      constexpr double kStep = 1e-7;  // of the move, for a difference
      return move.at(s + kStep)[axis] - move.at(s - kStep)[axis];
    };
    // An evaluated position may be on the reversal itself, without a slope: the last position with a slope
    // counts.
    double last = 0, last_slope = 0;
    for (int k = 0; k <= kLooks; ++k) {
      double low = last, high = (k + 0.5) / (kLooks + 1);
      const double here = slope(high), before = last_slope;
      if (here == 0) continue;
      last = high, last_slope = here;
      if (before * here >= 0) continue;
      for (int n = 0; n < kHalvings; ++n)
        (before * slope((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
      ends.push_back(low);
    }
  }
  ends.push_back(1);
  std::sort(ends.begin(), ends.end());
  return ends;
}

void AxisMotion::set_out(const VectorXd& from, const VectorXd& to) {
  for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
    const double way = to[static_cast<Index>(i)] - from[static_cast<Index>(i)];
    const double sense = std::abs(way) > 1e-9 ? (way > 0 ? 1 : -1) : sense_[i];
    if (sense != sense_[i] && sense_[i] != 0) turn_[i] = from[static_cast<Index>(i)];
    sense_[i] = sense;
  }
}

model::States AxisMotion::along(const ProgramMove& move, const std::vector<double>& shares) const {
  model::States states = model::select_states(at_, std::vector<std::size_t>(shares.size(), 0));
  constexpr double kStep = 1e-6;  // of the move, for a difference
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const auto row = static_cast<Index>(k);
    const double s = std::clamp(shares[k], kStep, 1 - kStep);
    const VectorXd point = move.at(shares[k]),
                   slope = (move.at(s + kStep) - move.at(s - kStep)) / (2 * kStep);
    double path = 0;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i)
      if (!machine_.axes[i].rotary) path += slope[static_cast<Index>(i)] * slope[static_cast<Index>(i)];
    path = std::sqrt(path);
    states.feed[row] = move.feed;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const double way = slope[static_cast<Index>(i)];
      states.axis[i][row] = point[static_cast<Index>(i)];
      states.velocity[i][row] = path > 0 ? move.feed / 60 * way / path : 0;
      // At a reversal the slope is 0 and its sign random: the direction is that of the whole stretch.
      states.direction[i][row] = sense_[i];
      if (std::isfinite(turn_[i])) states.since[i][row] = std::abs(point[static_cast<Index>(i)] - turn_[i]);
    }
  }
  return states;
}

std::vector<double> AxisMotion::looks(const ProgramMove& move, double from, double to,
                                      double deviation_mm) const {
  const int count = even_looks(move, from, to, deviation_mm);
  std::vector<double> shares;
  for (int k = 0; k <= count; ++k) shares.push_back(from + (to - from) * k / count);
  constexpr int kParts = 256;  // of the stretch; each is looked at closely if it meets a sharp one
  VectorXd last = move.at(from);
  for (int k = 1; k <= kParts; ++k) {
    const double begin = from + (to - from) * (k - 1) / kParts, end = from + (to - from) * k / kParts;
    const VectorXd next = move.at(end);
    double parts = 0;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const double a = last[static_cast<Index>(i)], b = next[static_cast<Index>(i)];
      for (const model::Detail::Sharp& sharp : detail_[i].sharp)
        if (sharp.from <= std::max(a, b) && sharp.to >= std::min(a, b))
          parts = std::max(parts, std::abs(b - a) / sharp.spacing);
    }
    for (int n = 1; n < parts; ++n) shares.push_back(begin + (end - begin) * n / parts);
    last = next;
  }
  std::sort(shares.begin(), shares.end());
  shares.erase(std::unique(shares.begin(), shares.end()), shares.end());
  return shares;
}

int AxisMotion::even_looks(const ProgramMove& move, double from, double to, double deviation_mm) const {
  // Features that a table of stations does not hide between two evaluated positions; their number, and chords
  // for the length.
  constexpr double kStep_mm = 1, kStep_deg = 0.1;
  constexpr int kFewest = 8, kMost = 200000, kChords = 64;
  constexpr double kPerPeriod = 32, kPerStation = 4;
  double length = 0, turn = 0, bend = 0, detail = 0;
  VectorXd reached =
      VectorXd::Zero(static_cast<Index>(machine_.axes.size()));  // by each axis, along the move
  VectorXd last = move.at(from), way;
  for (int k = 1; k <= kChords; ++k) {
    const VectorXd next = move.at(from + (to - from) * k / kChords), step = next - last;
    double squares = 0;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const double one = step[static_cast<Index>(i)];
      reached[static_cast<Index>(i)] += std::abs(one);
      if (machine_.axes[i].rotary)
        turn += std::abs(one);
      else
        squares += one * one;
    }
    length += std::sqrt(squares);
    if (k > 1) bend = std::max(bend, (step - way).norm());
    way = step;
    last = next;
  }
  for (std::size_t i = 0; i < machine_.axes.size(); ++i)
    detail = std::max(detail, reached[static_cast<Index>(i)] *
                                  std::max(kPerPeriod / detail_[i].period, kPerStation / detail_[i].station));
  // A chord of n parts of this one has an error of its eighth over n^2.
  const double chords = move.arc ? kChords * std::sqrt(bend / deviation_mm) : 0;
  return static_cast<int>(std::clamp(std::max({length / kStep_mm, turn / kStep_deg, chords, detail}),
                                     static_cast<double>(kFewest), static_cast<double>(kMost)));
}

}  // namespace vernier::offline
