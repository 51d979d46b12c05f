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
        cell = text::number_text(found->second.position(*value));
  }
  return other;
}

/// Tries all countings.
class Search {
 public:
  Search(const ImportTable& table, const model::Machine& machine, const std::vector<std::string>& axes,
         ToolPlace place)
      : table_(table), machine_(machine), axes_(axes), place_(place) {}

  /// Countings with at most `most_reversed` other signs, and other zeros of `zeros` joints.
  std::vector<OtherCounting> run(std::size_t zeros, std::size_t most_reversed) const {
    std::vector<OtherCounting> tried;
    for (std::uint32_t signs = zeros == 0 ? 1 : 0; signs < 1U << axes_.size(); ++signs) {
      if (static_cast<std::size_t>(std::popcount(signs)) > most_reversed) continue;
      Countings countings;
      for (std::size_t a = 0; a < axes_.size(); ++a)
        if ((signs >> a & 1U) != 0) countings[axes_[a]].reversed = true;
      add_zeros(countings, 0, zeros, tried);
    }
    return tried;
  }

 private:
  /// Adds the countings with other zeros of `zeros` of the joints from `first` on.
  void add_zeros(const Countings& countings, std::size_t first, std::size_t zeros,
                 std::vector<OtherCounting>& tried) const {
    constexpr double kZeros_deg[] = {90, -90, 180};
    if (zeros == 0) return add(countings, tried);
    for (std::size_t a = first; a < axes_.size(); ++a) {
      const auto unit = format::find_unit(table_.find(axes_[a])->unit);
      if (!unit || unit->dimension != format::Dimension::kAngle) continue;
      for (const double zero_deg : kZeros_deg) {
        Countings shifted = countings;
        shifted[axes_[a]].zero = zero_deg / unit->factor;
        add_zeros(shifted, a + 1, zeros - 1, tried);
      }
    }
  }

  void add(const Countings& countings, std::vector<OtherCounting>& tried) const {
    const Eigen::VectorXd off = distances_from_nominal(counted(table_, countings), machine_, place_);
    if (off.size() > 0) tried.push_back({countings, off.maxCoeff()});
  }

  const ImportTable& table_;
  const model::Machine& machine_;
  const std::vector<std::string>& axes_;
  ToolPlace place_;
};

/// The counting of fewest axes among those that agree about as well as the best one.
std::optional<OtherCounting> clearest(const std::vector<OtherCounting>& tried, double limit_mm,
                                      double given_mm) {
  constexpr double kBetter = 10;  // times, than as given: a wrong sign is hundreds of mm
  constexpr double kAlike = 2;    // times the best distance
  double best_mm = given_mm;
  for (const OtherCounting& one : tried) best_mm = std::min(best_mm, one.farthest_mm);
  if (best_mm > std::max(limit_mm, given_mm / kBetter)) return std::nullopt;
  const double alike_mm = std::max(limit_mm, kAlike * best_mm);
  const OtherCounting* found = nullptr;
  std::size_t equal = 0;
  for (const OtherCounting& one : tried) {
    if (one.farthest_mm > alike_mm || (found != nullptr && one.axes.size() > found->axes.size())) continue;
    equal = found != nullptr && one.axes.size() == found->axes.size() ? equal + 1 : 1;
    found = &one;
  }
  return equal == 1 ? std::optional(*found) : std::nullopt;
}

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

std::optional<OtherCounting> counting_that_agrees(const ImportTable& table, const model::Machine& machine,
                                                  const std::vector<std::string>& axes, ToolPlace place,
                                                  double limit_mm, double given_mm) {
  if (axes.empty() || axes.size() > kMostReversed) return std::nullopt;
  constexpr std::size_t kZeros = 2, kFewReversed = 2;  // beside two zeros, so that the search takes a second
  const Search search(table, machine, axes, place);
  for (std::size_t zeros = 0; zeros <= kZeros; ++zeros)
    if (const auto found =
            clearest(search.run(zeros, zeros < kZeros ? axes.size() : kFewReversed), limit_mm, given_mm))
      return found;
  return std::nullopt;
}

}  // namespace vernier::importer
