// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/similar.h"

#include <algorithm>
#include <cctype>

namespace vernier::text {

std::size_t letters_apart(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  for (std::size_t k = 0; k <= b.size(); ++k) cost[0][k] = k;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const bool same = small(a[i - 1]) == small(b[k - 1]);
      cost[i][k] = std::min({cost[i - 1][k] + 1, cost[i][k - 1] + 1, cost[i - 1][k - 1] + (same ? 0 : 1)});
      if (i > 1 && k > 1 && small(a[i - 1]) == small(b[k - 2]) && small(a[i - 2]) == small(b[k - 1]))
        cost[i][k] = std::min(cost[i][k], cost[i - 2][k - 2] + 1);
    }
  return cost[a.size()][b.size()];
}

std::optional<std::string> word_meant(std::string_view word, const std::vector<std::string>& known) {
  std::optional<std::string> best;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& one : known) {
    std::size_t apart = letters_apart(word, one);
    // A prefix of a longer word.
    if (word.size() >= 3 && one.starts_with(word)) apart = std::min<std::size_t>(apart, 1);
    if (apart >= least || apart >= one.size()) continue;
    least = apart;
    best = one;
  }
  return best;
}

}  // namespace vernier::text
