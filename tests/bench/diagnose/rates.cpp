// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/diagnose/rates.h"
#include "tests/support/hidden_survey_key.h"
#include "tests/support/hidden_survey_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace vernier::bench {
namespace {

using support::SurveyClass;

using Group = std::map<std::string, std::vector<const Case*>>;

void print_group(const std::string& title, const Group& groups) {
  fmt::print("\n{:<44} {:>5}  {:<26} {:<26} {}\n", title, "n", "as asked", "wrong name", "outcomes");
  for (const auto& [name, cases] : groups) {
    Tally tally;
    std::size_t good = 0, wrong = 0;
    for (const Case* one : cases) {
      ++tally.count[static_cast<std::size_t>(one->judgement.outcome)];
      good += is_good(*one) ? 1U : 0U;
      wrong += is_wrong_name(*one) ? 1U : 0U;
    }
    std::string list;
    for (std::size_t o = 0; o < kOutcomes; ++o)
      if (tally.count[o] > 0)
        list += fmt::format("{} {}  ", outcome_name(static_cast<Outcome>(o)), tally.count[o]);
    fmt::print("{:<44} {:>5}  {:<26} {:<26} {}\n", name, cases.size(), share_text(good, cases.size()),
               share_text(wrong, cases.size()), list);
  }
}

Group by(const std::vector<Case>& cases, const std::function<std::string(const Case&)>& name) {
  Group groups;
  for (const Case& one : cases) groups[name(one)].push_back(&one);
  return groups;
}

std::string class_and_ratio(const Case& one) {
  std::string text = support::class_name(one.spec.kind);
  if (one.spec.kind != SurveyClass::kNoise) text += fmt::format(", effect/noise {:g}", one.spec.ratio);
  if (one.spec.kind == SurveyClass::kSingle) {
    text += one.can_tell ? ", data can tell" : ", data cannot tell";
    text += fmt::format(", {} feed{}", one.spec.feeds, one.spec.feeds == 1 ? "" : "s");
  }
  return text;
}

void print_held_out(const std::vector<Case>& cases) {
  std::vector<double> ratios;
  for (const Case& one : cases)
    if (one.held_out) ratios.push_back(*one.held_out);
  if (ratios.empty()) return;
  std::sort(ratios.begin(), ratios.end());
  const auto within =
      static_cast<std::size_t>(std::upper_bound(ratios.begin(), ratios.end(), 1.02) - ratios.begin());
  fmt::print(
      "\nheld-out rms after diagnose, add, fit over that with the true term: <= 1.02 in {} of {} named; "
      "median "
      "{:.4f}, 95 % {:.4f}, worst {:.4f}\n",
      share_text(within, ratios.size()), ratios.size(), ratios[ratios.size() / 2],
      ratios[std::min(ratios.size() - 1, ratios.size() * 95 / 100)], ratios.back());
}

void print_failures(const std::vector<Case>& cases, std::size_t most) {
  std::size_t printed = 0, all = 0;
  for (const Case& one : cases) {
    const bool far_off = one.held_out && *one.held_out > 1.02;
    if (is_good(one) && one.trouble.empty() && !far_off) continue;
    if (++all > most) continue;
    if (printed++ == 0) fmt::print("\nnot as asked:\n");
    fmt::print("case {} {} {} ratio {:g} -> {}\n  hidden: {}\n  said:   {}\n", one.number,
               support::family_name(one.spec.family), support::class_name(one.spec.kind), one.spec.ratio,
               outcome_name(one.judgement.outcome), one.hidden, one.judgement.said);
    if (far_off) fmt::print("  held-out ratio {:.3f}\n", *one.held_out);
    if (!one.trouble.empty()) fmt::print("  trouble: {}\n", one.trouble);
    fmt::print("  {}\n", again(one));
  }
  if (all > most) fmt::print("... and {} more (--failures)\n", all - most);
}

}  // namespace

std::string again(const Case& one) {
  return fmt::format(
      "diagnose_rates --exact-seed {} --family {} --class {} --ratio {:g} --feeds {} --rows {} --runs {}{}{} "
      "--keep DIR",
      one.spec.seed, support::family_name(one.spec.family), support::class_name(one.spec.kind),
      one.spec.ratio, one.spec.feeds, one.spec.rows, one.spec.runs,
      one.spec.noise == support::NoiseLaw::kWhite
          ? ""
          : std::string(" --noise ") + support::noise_law_name(one.spec.noise),
      one.spec.effect.empty() ? "" : " --effect " + one.spec.effect);
}

nlohmann::json cases_json(const std::vector<Case>& cases) {
  nlohmann::json list = nlohmann::json::array();
  for (const Case& one : cases)
    list.push_back({{"case", one.number},
                    {"seed", one.spec.seed},
                    {"family", support::family_name(one.spec.family)},
                    {"class", support::class_name(one.spec.kind)},
                    {"noise", support::noise_law_name(one.spec.noise)},
                    {"effect", one.spec.effect},
                    {"ratio", one.spec.ratio},
                    {"feeds", one.spec.feeds},
                    {"can_tell", one.can_tell},
                    {"hidden", one.hidden},
                    {"outcome", outcome_name(one.judgement.outcome)},
                    {"said", one.judgement.said},
                    {"seconds", one.seconds},
                    {"trouble", one.trouble},
                    {"held_out_ratio", one.held_out ? nlohmann::json(*one.held_out) : nlohmann::json()}});
  return list;
}

std::size_t Tally::total() const { return std::accumulate(count.begin(), count.end(), std::size_t{0}); }

std::string share_text(std::size_t part, std::size_t all) {
  if (all == 0) return "-";
  // Wilson, JASA 22 (1927) 209-212: holds near 0 and 1 too.
  const auto n = static_cast<double>(all);
  const double p = static_cast<double>(part) / n, z = 1.96, z2 = z * z / n;
  const double middle = (p + z2 / 2) / (1 + z2);
  const double half = z / (1 + z2) * std::sqrt(p * (1 - p) / n + z2 / (4 * n));
  return fmt::format("{:5.1f} % ({:.1f} .. {:.1f})", 100 * p, 100 * std::max(0.0, middle - half),
                     100 * std::min(1.0, middle + half));
}

bool is_good(const Case& one) {
  const Outcome o = one.judgement.outcome;
  switch (one.spec.kind) {
    case SurveyClass::kOutside:
      return !is_wrong_name(one) && o != Outcome::kError;
    case SurveyClass::kConfusable:
      return o == Outcome::kAmbiguous || o == Outcome::kUnexplained;
    case SurveyClass::kSingle:
      // What the data cannot tell may be left open; what they can tell must be named.
      if (!one.can_tell)
        return o == Outcome::kRight || o == Outcome::kAmbiguous || o == Outcome::kUnexplained;
      return o == Outcome::kRight;
    default:
      return o == Outcome::kRight;
  }
}

bool is_wrong_name(const Case& one) {
  // `custom` is labelled as no named physics, but for the outside class the issue counts any name.
  return one.judgement.outcome == Outcome::kWrong;
}

void print_rates(const std::vector<Case>& cases, std::size_t most_failures) {
  print_group("class", by(cases, class_and_ratio));
  const auto effect = [](const Case& one) {
    return one.spec.effect.empty() ? std::string(support::class_name(one.spec.kind)) : one.spec.effect;
  };
  print_group("effect", by(cases, [&](const Case& one) {
                return effect(one) + fmt::format(", ratio {:g}", one.spec.ratio);
              }));
  print_group("family", by(cases, [](const Case& one) {
                return std::string(support::family_name(one.spec.family)) +
                       fmt::format(", ratio {:g}", one.spec.ratio);
              }));
  print_group("family x effect, not all as asked", [&] {
    Group all = by(cases, [&](const Case& one) {
      return support::family_name(one.spec.family) + std::string(" ") + effect(one);
    });
    std::erase_if(all, [](const auto& g) {
      return std::all_of(g.second.begin(), g.second.end(), [](const Case* one) { return is_good(*one); });
    });
    return all;
  }());
  print_held_out(cases);
  print_failures(cases, most_failures);
}

}  // namespace vernier::bench
