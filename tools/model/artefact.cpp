// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/artefact.h"

#include <algorithm>

#include "tools/format/units.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::model {

std::optional<ArtefactType> artefact_type_named(std::string_view word) {
  const auto* const found = std::find(kArtefactTypes.begin(), kArtefactTypes.end(), word);
  if (found == kArtefactTypes.end()) return std::nullopt;
  return static_cast<ArtefactType>(found - kArtefactTypes.begin());
}

std::size_t Artefact::dimension() const {
  return type == ArtefactType::kPoint ? 3 : type == ArtefactType::kLine ? 2 : 1;
}

std::optional<double> length_in_mm(std::string_view text) {
  const std::string all = text::trimmed(std::string(text));
  const std::size_t end = all.find_first_not_of("0123456789.+-eE");
  const auto number = text::parse_number(all.substr(0, end));
  if (!number) return std::nullopt;
  if (end == std::string::npos) return number;
  const auto unit = format::find_unit(text::trimmed(all.substr(end)));
  if (!unit || unit->dimension != format::Dimension::kLength) return std::nullopt;
  return *number * unit->factor;
}

}  // namespace vernier::model
