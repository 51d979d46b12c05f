// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/kinds.h"

#include "tools/text/words.h"

namespace vernier::importer {
namespace {

constexpr ImportKind kImportKinds[] = {
#define X(id, name, reads, ending) {name, reads, ending},
#include "tools/import/kinds.inc"
#undef X
};

}  // namespace

std::span<const ImportKind> import_kinds() { return kImportKinds; }

const ImportKind* import_kind_of(std::string_view file) {
  for (const ImportKind& kind : kImportKinds)
    if (*kind.ending != '\0' && text::in_small_letters(file).ends_with(kind.ending)) return &kind;
  return nullptr;
}

}  // namespace vernier::importer
