// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace vernier::sheet {

/// What a number format of a spreadsheet shows beside the digits of the stored number (ECMA-376 part 1,
/// section 18.8.31).
struct NumberFormat {
  std::string text;         // "mm", "x 0,1 µm"; empty: none
  bool percent = false;     // the number times 100
  bool thousands = false;   // the number divided by 1000 or more: "0.0,"
  bool other_sign = false;  // another sign than the stored one, or none for a negative number

  bool plain() const { return text.empty() && !percent && !thousands && !other_sign; }
};

/// Reads a number format: "0.000\" mm\"", "0.0;[Red]-0.0", "0%". A format of dates has no meaning here.
NumberFormat number_format(std::string_view code);

/// The code of a built-in number format that shows another number (section 18.8.30); empty for others.
std::string_view built_in_format(unsigned id);

}  // namespace vernier::sheet
