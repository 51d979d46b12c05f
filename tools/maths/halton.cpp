// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/halton.h"

namespace vernier::maths {

double radical_inverse(std::size_t index, std::size_t base) {
  double result = 0, digit = 1;
  for (; index > 0; index /= base) {
    digit /= static_cast<double>(base);
    result += digit * static_cast<double>(index % base);
  }
  return result;
}

}  // namespace vernier::maths
