// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <span>
#include <string_view>

namespace vernier::importer {

/// A kind of `vernier import` (kinds.inc).
struct ImportKind {
  const char* name;
  const char* reads;   // for the help
  const char* ending;  // of files that this kind reads without further options; "": none
};

/// All kinds, in the order of the help.
std::span<const ImportKind> import_kinds();
/// The kind that reads a file by the ending of its name, in small or capital letters; null: no kind.
const ImportKind* import_kind_of(std::string_view file);

}  // namespace vernier::importer
