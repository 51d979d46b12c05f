// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/screw_comp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tools/exchange/table_text.h"
#include "tools/kinematics/correction.h"
#include "tools/model/chain/periods.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/text/numbers.h"

namespace vernier::exchange {
namespace {

/// What files round: they are written to 1e-6 mm, so two trims may differ by as much.
constexpr double kRounding_mm = 1.01e-6;

std::vector<ScrewPoint> trims_at(const model::Machine& machine, std::size_t axis, const model::States& at,
                                 const std::vector<double>& positions) {
  const std::size_t count = positions.size();
  model::States states = model::select_states(at, std::vector<std::size_t>(2 * count, 0));
  for (std::size_t i = 0; i < 2 * count; ++i) {
    states.axis[axis][static_cast<Eigen::Index>(i)] = positions[i % count];
    states.direction[axis][static_cast<Eigen::Index>(i)] = i < count ? 1 : -1;
  }
  const model::Column offset = kinematics::first_order_offset(machine, states)[axis];
  std::vector<ScrewPoint> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(
        {positions[i], offset[static_cast<Eigen::Index>(i)], offset[static_cast<Eigen::Index>(i + count)]});
  return points;
}

std::vector<double> first_positions(const model::Machine& machine, std::size_t axis) {
  const model::Axis& one = machine.axes[axis];
  std::vector<double> result;
  if (const model::Table* table = machine.table_of(axis)) {
    for (const model::Station& station : table->stations) result.push_back(station.loc);
  } else {
    if (!one.min || !one.max)
      throw text::InputError({machine.file, one.line}, one.name,
                             "the export of this axis requires min and max in the machine file");
    result = {*one.min, *one.max};
  }
  if (one.min && *one.min < result.front()) result.insert(result.begin(), *one.min);
  if (one.max && *one.max > result.back()) result.push_back(*one.max);
  return result;
}

double rounded(double value) { return std::round(value * 1e6) / 1e6; }  // as files have it, mm

/// The lines of a file, put where the trims bend, against trims at positions all over the axis.
class LinePlacer {
 public:
  LinePlacer(const model::Machine& machine, std::size_t axis, const model::States& at)
      : machine_(machine), axis_(axis), at_(at) {
    const std::vector<double> first = first_positions(machine, axis);
    probes_ = look(first.front(), first.back());
    lines_ = trims_of(first);
    for (std::size_t i = 0; i + 1 < lines_.size(); ++i) worst_.push_back(worst_between(i));
  }

  /// Splits the worst segment until all are within the tolerance or the file is full.
  ScrewTable place(double tolerance_um) {
    while (lines_.size() < kMostScrewPoints && 1000 * worst() > tolerance_um && split_worst()) {
    }
    return {lines_, 1000 * worst(), probes_.size()};
  }

 private:
  double worst() const { return worst_.empty() ? 0 : *std::max_element(worst_.begin(), worst_.end()); }

  /// Trims at positions that are no multiple of a period: one in each of many equal parts, at a different
  /// position in each part (golden section).
  std::vector<ScrewPoint> look(double low, double high) const {
    constexpr double kFewest = 4096, kMost = 65536, kPerPeriod = 32, kPerStation = 8;
    constexpr double kGolden = 0.6180339887498949;
    const model::Detail detail = model::detail_along(machine_, axis_, at_);
    const double wanted = (high - low) * std::max(kPerPeriod / detail.period, kPerStation / detail.station);
    const auto count = static_cast<std::size_t>(std::clamp(wanted, kFewest, kMost));
    const double apart = (high - low) / static_cast<double>(count);
    std::vector<double> positions;
    for (std::size_t i = 0; i < count; ++i) {
      const double place = static_cast<double>(i) * kGolden;
      positions.push_back(low + (high - low) * (static_cast<double>(i) + place - std::floor(place)) /
                                    static_cast<double>(count));
    }
    for (const model::Detail::Sharp& sharp : detail.sharp)
      if (sharp.spacing < apart)
        for (double x = std::max(sharp.from, low); x <= std::min(sharp.to, high); x += sharp.spacing)
          positions.push_back(x);
    std::sort(positions.begin(), positions.end());
    return trims_of(positions);
  }

  std::vector<ScrewPoint> trims_of(const std::vector<double>& positions) const {
    constexpr std::size_t kAtATime = 4096;  // states of a forward solution: what memory bears
    std::vector<ScrewPoint> all;
    for (std::size_t from = 0; from < positions.size(); from += kAtATime) {
      const auto to = std::min(from + kAtATime, positions.size());
      const std::vector<ScrewPoint> part = trims_at(machine_, axis_, at_,
                                                    {positions.begin() + static_cast<std::ptrdiff_t>(from),
                                                     positions.begin() + static_cast<std::ptrdiff_t>(to)});
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }

  /// How far the trims between two lines are from the straight line that the controller draws, mm.
  double worst_between(std::size_t segment) const {
    const ScrewPoint &a = lines_[segment], &b = lines_[segment + 1];
    const auto before = [](const ScrewPoint& probe, double x) { return probe.nominal < x; };
    double worst = 0;
    for (auto probe = std::lower_bound(probes_.begin(), probes_.end(), a.nominal, before);
         probe != probes_.end() && probe->nominal <= b.nominal; ++probe) {
      const double f = (probe->nominal - a.nominal) / (b.nominal - a.nominal);
      const auto off = [&](double ScrewPoint::*trim) {
        return std::abs((*probe).*trim - (1 - f) * rounded(a.*trim) - f * rounded(b.*trim));
      };
      worst = std::max({worst, off(&ScrewPoint::forward_trim), off(&ScrewPoint::reverse_trim)});
    }
    return worst;
  }

  /// False where the segment is too short to be split.
  bool split_worst() {
    const auto at = std::max_element(worst_.begin(), worst_.end()) - worst_.begin();
    const auto segment = static_cast<std::size_t>(at);
    const double a = lines_[segment].nominal, b = lines_[segment + 1].nominal, middle = rounded((a + b) / 2);
    if (!(middle > a && middle < b)) return false;
    lines_.insert(lines_.begin() + at + 1, trims_of({middle})[0]);
    worst_[segment] = worst_between(segment);
    worst_.insert(worst_.begin() + at + 1, worst_between(segment + 1));
    return true;
  }

  const model::Machine& machine_;
  std::size_t axis_;
  const model::States& at_;
  std::vector<ScrewPoint> probes_, lines_;
  std::vector<double> worst_;  // of each segment, mm
};

/// What would do instead.
std::string way_out(double reached_um) {
  for (const double wider : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
    if (reached_um <= wider)
      return fmt::format(
          "; use --tolerance {}, or use --component: the LinuxCNC component applies the whole machine file",
          wider);
  return "; use --component: the LinuxCNC component applies the whole machine file";
}

}  // namespace

ScrewTable screw_table(const model::Machine& machine, std::size_t axis, const model::States& at,
                       double tolerance_um) {
  ScrewTable table = LinePlacer(machine, axis, at).place(tolerance_um);
  if (table.points.size() > kMostScrewPoints || table.worst_um > tolerance_um)
    throw text::LimitNotMet(
        fmt::format("{}: {}: with {} lines (the controller stores {}) the error between the lines is {:.4g} "
                    "um, the tolerance is {} um{}",
                    machine.file, machine.axes[axis].name, table.points.size(), kMostScrewPoints,
                    table.worst_um, tolerance_um, way_out(table.worst_um)));
  return table;
}

std::string screw_text(const std::vector<ScrewPoint>& points, ScrewType type) {
  std::string text;
  for (const ScrewPoint& point : points) {
    const auto value = [&](double trim) {
      const double printed = type == ScrewType::kTrim ? trim : point.nominal - trim;
      return std::abs(printed) < 5e-7 ? 0.0 : printed;  // no "-0.000000"
    };
    text += fmt::format("{:.6f} {:.6f} {:.6f}\n", point.nominal, value(point.forward_trim),
                        value(point.reverse_trim));
  }
  return text;
}

std::vector<ScrewPoint> parse_screw(const std::string& text, const std::string& file, ScrewType type) {
  std::vector<ScrewPoint> points;
  std::istringstream lines(text);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    const text::Place place{file, number};
    std::istringstream words(line);
    std::vector<double> three;
    for (std::string word; words >> word;) {
      const auto value = text::parse_number(word);
      if (!value)
        throw text::InputError(place, word,
                               "this word is not a number; the controller stops reading at this line");
      three.push_back(*value);
    }
    if (three.size() != 3)
      throw text::InputError(place, line,
                             "a line must have the numbers nominal, forward, reverse; the controller stops "
                             "reading at this line");
    if (!points.empty() && three[0] <= points.back().nominal)
      throw text::InputError(place, line, "positions must increase");
    if (points.size() == kMostScrewPoints)
      throw text::InputError(
          place, line,
          fmt::format("the file has too many lines: the controller reads only {} lines", kMostScrewPoints));
    if (type == ScrewType::kActual)
      points.push_back({three[0], three[0] - three[1], three[0] - three[2]});
    else
      points.push_back({three[0], three[1], three[2]});
  }
  if (points.size() < 2) throw text::InputError({file, 0}, "", "a table needs at least two lines");
  return points;
}

std::string screw_into_machine(const std::string& text, const model::Machine& machine, std::size_t axis,
                               const std::vector<ScrewPoint>& points, const std::string& reversal) {
  const std::string& name = machine.axes[axis].name;
  const auto own =
      std::find_if(model::kSixDofNames.begin(), model::kSixDofNames.begin() + 3, [&](const char* letter) {
        return name.find(*letter) != std::string::npos;  // X, Xm, X1 …
      });
  if (own == model::kSixDofNames.begin() + 3)
    throw text::InputError({machine.file, 0}, name,
                           "the name of this axis contains no X, Y or Z, so the column of its table is "
                           "unknown: rename the axis");
  std::vector<double> positions;
  for (const ScrewPoint& point : points) positions.push_back(point.nominal);
  model::Table table = empty_table(machine, axis, positions);
  table.interpolation = model::Interpolation::kLinear;
  const double half = (points[0].reverse_trim - points[0].forward_trim) / 2;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs((points[i].reverse_trim - points[i].forward_trim) / 2 - half) > kRounding_mm)
      throw text::InputError({}, text::number_text(points[i].nominal),
                             "the reversal differs between positions, but the term of the machine file has "
                             "one value for all positions");
    table.stations[i].value[static_cast<std::size_t>(own - model::kSixDofNames.begin())] =
        nine_decimals(-(points[i].forward_trim + points[i].reverse_trim) / 2);
  }
  model::Machine next = machine;
  if (!reversal.empty()) {
    const auto index = machine.find_static(reversal);
    if (!index) throw text::InputError({machine.file, 0}, reversal, "the machine has no static of this name");
    next.statics[*index].value = nine_decimals(half);
  }
  check_used(machine, table);
  const std::string result = set_table(model::update_machine_text(text, next, false), next, table);
  const model::Machine back = model::parse_machine(result, machine.file);
  const std::vector<ScrewPoint> again = trims_at(back, axis, model::make_states(1, back), positions);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double off = std::max(std::abs(again[i].forward_trim - points[i].forward_trim),
                                std::abs(again[i].reverse_trim - points[i].reverse_trim));
    if (off > kRounding_mm)
      throw text::InputError({machine.file, 0}, name,
                             fmt::format("the resulting machine file would not reproduce the trims of the "
                                         "file: the difference is {:.4g} um at {} (a reversal error needs "
                                         "--reversal STATIC; all other errors of this axis must be 0)",
                                         1000 * off, points[i].nominal));
  }
  return result;
}

}  // namespace vernier::exchange
