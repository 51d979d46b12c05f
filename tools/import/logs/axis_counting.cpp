// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/axis_counting.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#include "tools/format/units.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using Countings = std::map<std::string, AxisCounting>;

constexpr std::size_t kMostReversed = 8;  // axes: 256 choices of a sign

/// The table with the positions that a counting gives.
ImportTable counted(const ImportTable& table, const Countings& countings) {
  ImportTable other = table;
  for (ImportTable::Column& column : other.columns) {
    const auto found = countings.find(column.name);
    if (found == countings.end() || found->second.is_that_of_machine()) continue;
    for (std::string& cell : column.cells)
      if (const auto value = text::parse_number(cell))
        cell = text::number_text((found->second.reversed ? -*value : *value) + found->second.zero);
  }
  return other;
}

/// Tries countings from few changed joints to many, and remembers those that agree.
class Search {
 public:
  Search(const ImportTable& table, const model::Machine& machine, const std::vector<std::string>& axes,
         ToolPlace place, double limit_mm)
      : table_(table), machine_(machine), axes_(axes), place_(place), limit_mm_(limit_mm) {}

  Countings run() {
    for (std::size_t zeros = 0; zeros < 2; ++zeros)
      for (std::size_t reversed = zeros == 0 ? 1 : 0; reversed <= axes_.size(); ++reversed) {
        std::vector<Countings> agreeing;
        for (std::uint32_t signs = 0; signs < 1U << axes_.size(); ++signs)
          if (static_cast<std::size_t>(std::popcount(signs)) == reversed)
            try_signs(signs, zeros > 0, agreeing);
        if (!agreeing.empty()) return agreeing.size() == 1 ? agreeing.front() : Countings{};
      }
    return {};
  }

 private:
  void try_signs(std::uint32_t signs, bool with_zero, std::vector<Countings>& agreeing) const {
    Countings countings;
    for (std::size_t a = 0; a < axes_.size(); ++a) countings[axes_[a]].reversed = (signs >> a & 1U) != 0;
    if (!with_zero) {
      if (agrees(countings)) agreeing.push_back(countings);
      return;
    }
    constexpr double kZeros_deg[] = {90, -90, 180};
    for (const std::string& axis : axes_) {
      const ImportTable::Column* const column = table_.find(axis);
      const auto unit = format::find_unit(column->unit);
      if (!unit || unit->dimension != format::Dimension::kAngle) continue;
      for (const double zero_deg : kZeros_deg) {
        Countings shifted = countings;
        shifted[axis].zero = zero_deg / unit->factor;
        if (agrees(shifted)) agreeing.push_back(shifted);
      }
    }
  }

  bool agrees(const Countings& countings) const {
    const Eigen::VectorXd off = distances_from_nominal(counted(table_, countings), machine_, place_);
    return off.size() > 0 && off.maxCoeff() <= limit_mm_;
  }

  const ImportTable& table_;
  const model::Machine& machine_;
  const std::vector<std::string>& axes_;
  ToolPlace place_;
  double limit_mm_;
};

}  // namespace

std::vector<CountedHeading> counted_headings(const std::string& words) {
  const std::string bare = text::trimmed(words);
  std::vector<CountedHeading> readings = {{bare, {}}};
  if (bare.starts_with('-')) readings.push_back({text::trimmed(bare.substr(1)), {true, 0}});
  for (std::size_t i = 0, count = readings.size(); i < count; ++i) {
    const CountedHeading whole = readings[i];
    const std::size_t at = whole.heading.find_last_of("+-");
    if (at == std::string::npos || at == 0) continue;
    if (const auto zero = text::parse_number(text::trimmed(whole.heading.substr(at + 1))))
      readings.push_back({text::trimmed(whole.heading.substr(0, at)),
                          {whole.counting.reversed, whole.heading[at] == '-' ? -*zero : *zero}});
  }
  return readings;
}

std::string in_words(const CountedHeading& heading) {
  const AxisCounting& counting = heading.counting;
  return fmt::format("{}{}{}", counting.reversed ? "-" : "", heading.heading,
                     counting.zero == 0 ? "" : fmt::format("{:+.10g}", counting.zero));
}

std::map<std::string, AxisCounting> counting_that_agrees(const ImportTable& table,
                                                         const model::Machine& machine,
                                                         const std::vector<std::string>& axes,
                                                         ToolPlace place, double limit_mm) {
  if (axes.empty() || axes.size() > kMostReversed) return {};
  Countings found = Search(table, machine, axes, place, limit_mm).run();
  std::erase_if(found, [](const auto& one) { return one.second.is_that_of_machine(); });
  return found;
}

}  // namespace vernier::importer
