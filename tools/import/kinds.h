// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <span>
#include <string_view>

namespace vernier::importer {

/// A kind of file that `vernier import` can read (kinds.inc).
struct ImportKind {
  const char* name;
  const char* reads;   // description of the files, for the help text
  const char* ending;  // ending of the file names that this kind reads without further options; "": there is
                       // no such ending
};

/// Returns all kinds of import, in the order of the help text.
std::span<const ImportKind> import_kinds();
/// Returns the kind that reads files with the ending of this name; null if no kind has this ending.
/// The file ending may be in capital or small letters.
const ImportKind* import_kind_of(std::string_view file);

}  // namespace vernier::importer
