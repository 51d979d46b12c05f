// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/out/square_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "tools/exchange/three_axes.h"
#include "tools/fit/fit.h"
#include "tools/model/fit_record.h"
#include "tools/model/parameters.h"
#include "tools/safety/safety_sheet.h"
#include "tools/text/words.h"

namespace vernier::commands {
namespace {

constexpr std::string_view kAboutZ = "EC0";  // an angle between axes about Z: what the square measures

}  // namespace

FitOfSquare fit_of_square(const model::Machine& machine) {
  const std::string open = safety::not_measured(machine);
  if (open.empty()) return {};
  const model::FitRecord& record = *machine.fitted;
  FitOfSquare fit;
  std::set<std::string> determined;
  for (std::size_t i = 0; i < std::min(record.parameters.size(), record.origins.size()); ++i)
    if (record.origins[i] == fit::origin_name(fit::Origin::kData))
      determined.insert(model::without_station(record.parameters[i]));
  const std::vector<std::string> not_measured = text::parts_of(open, ',');
  for (const std::string& parameter : record.parameters) {
    const std::string name = model::without_station(parameter);
    const bool table = name != parameter;
    const bool open_static =
        std::find(not_measured.begin(), not_measured.end(), name) != not_measured.end() &&
        !name.starts_with(kAboutZ);
    if ((table ? !determined.contains(name) : open_static) &&
        std::find(fit.hold.begin(), fit.hold.end(), name) == fit.hold.end())
      fit.hold.push_back(name);
  }
  for (const char* const axis : exchange::kLetters)
    if (axis != exchange::kLetters.back()) fit.free.push_back(fmt::format("scalefactor.{}", axis));
  return fit;
}

std::string remedy_of_unmeasured(const FitOfSquare& fit) {
  if (fit.hold.empty()) return "";
  return fmt::format(
      "To measure squareness and scales with the distances of a printed square, fit a machine file of "
      "vernier new --errors square, or fit the machine file from before the last fit again with --hold "
      "\"{}\" --free {}",
      fmt::join(fit.hold, ","), fmt::join(fit.free, ","));
}

bool square_is_open(const model::Machine& machine) {
  if (!machine.fitted) return false;
  const model::FitRecord& record = *machine.fitted;
  for (std::size_t i = 0; i < std::min(record.parameters.size(), record.origins.size()); ++i)
    if (record.parameters[i].starts_with(kAboutZ) &&
        record.origins[i] != fit::origin_name(fit::Origin::kData))
      return true;
  return false;
}

}  // namespace vernier::commands
