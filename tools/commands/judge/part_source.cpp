// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/judge/part_kinds.h"
#include "tools/kinematics/at.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/words.h"
#include "tools/tolerance/program_features.h"

namespace vernier::commands::part_cli {
namespace {

/// A list of features has a header with its columns; a part program has blocks.
bool is_list(const std::string& path, const std::string& text) {
  if (path.ends_with(".csv")) return true;
  for (const std::string& line : text::parts_of(text, '\n'))
    if (const std::string words = text::trimmed(line); !words.empty() && words[0] != '#')
      return words.find("feature") != std::string::npos && words.find(',') != std::string::npos;
  return false;
}

}  // namespace

tolerance::PlacedPart placed_part(const PartSource& source, const model::Machine& machine) {
  const std::string text = text::read_file(source.path);
  const model::States at = kinematics::state_at(machine, source.at);
  if (is_list(source.path, text)) {
    if (!source.zero.empty())
      throw text::InputError(
          {}, "--zero",
          "PART is a list of features, but this option is only for a part program: use --place");
    for (const auto& [value, name] :
         {std::pair(source.position_mm, "--position"), std::pair(source.size_mm, "--size"),
          std::pair(source.form_mm, "--form")})
      if (value > 0)
        throw text::InputError(
            {}, name,
            "this option is only for a part program; a list of features has columns for these values");
    tolerance::PartDrawing part = tolerance::parse_part(text, source.path);
    part = tolerance::placed_at(part, kinematics::placement(source.place, "--place"));
    return tolerance::place_part(machine, part, at);
  }
  if (!source.place.empty())
    throw text::InputError({}, "--place",
                           "this option is only for a list of features; for a part program use --zero");
  tolerance::ProgramOptions options;
  const model::States zero = kinematics::state_at(machine, source.zero);
  std::vector<char> known;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    options.zero.push_back(zero.axis[i][0]);
    known.push_back(("," + source.at).find("," + machine.axes[i].name + "=") != std::string::npos ? 1 : 0);
  }
  if (source.position_mm > 0) options.position_mm = source.position_mm;
  if (source.form_mm > 0) options.form_mm = source.form_mm;
  if (source.size_mm > 0) options.size_mm = {-source.size_mm, source.size_mm};
  return tolerance::program_part(machine, text, source.path, at, known, options);
}

}  // namespace vernier::commands::part_cli
