// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/families.h"

#include <cctype>
#include <utility>

namespace vernier::diagnose {
namespace {

/// Returns the terms of a candidate without their locations. Numbers take the place of the names of the
/// unknowns, which are different for each candidate.
std::string terms_of(const effects::Candidate& candidate) {
  std::map<std::string, std::size_t> number;
  std::string all;
  for (const effects::CandidateUnknown& unknown : candidate.unknowns) {
    number.emplace(unknown.name, number.size());
    all += unknown.kind == effects::UnknownKind::kLinear ? 'k' : 's';
  }
  const auto is_of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (const effects::CandidateTerm& term : candidate.terms) {
    all += '\n';
    for (std::size_t at = 0; at < term.text.size();) {
      std::size_t end = at;
      while (end < term.text.size() && is_of_word(term.text[end])) ++end;
      const std::string word = term.text.substr(at, end > at ? end - at : 1);
      const auto found = number.find(word);
      all += found == number.end() ? word : "#" + std::to_string(found->second);
      at += word.size();
    }
  }
  return all;
}

RowFunctions functions_of(const ScannedCandidate& item, ColumnMaker& maker) {
  RowFunctions functions;
  functions.points = grid_points(item.grid);
  for (std::size_t i = 0; i < functions.points.size(); ++i) {
    const std::vector<Eigen::MatrixXd> here = maker.functions(item.candidate, functions.points[i]);
    if (i == 0) {
      functions.unknowns = here.at(0).cols();
      const Eigen::Index all = functions.unknowns * static_cast<Eigen::Index>(functions.points.size());
      functions.of_term.assign(here.size(), Eigen::MatrixXd(here[0].rows(), all));
    }
    for (std::size_t t = 0; t < here.size(); ++t)
      functions.of_term[t].middleCols(static_cast<Eigen::Index>(i) * functions.unknowns, functions.unknowns) =
          here[t];
  }
  return functions;
}

}  // namespace

std::vector<std::vector<double>> grid_points(const std::vector<std::vector<double>>& lists) {
  std::vector<std::vector<double>> points(1);
  for (const std::vector<double>& list : lists) {
    std::vector<std::vector<double>> next;
    for (const auto& point : points)
      for (const double value : list) {
        next.push_back(point);
        next.back().push_back(value);
      }
    points = std::move(next);
  }
  return points;
}

void Families::extend() {
  for (; assigned_ < candidates_.size(); ++assigned_) {
    const ScannedCandidate& item = candidates_[assigned_];
    auto& of_terms = known_[terms_of(item.candidate)];
    const auto [place, is_new] = of_terms.try_emplace(item.grid, families_.size());
    if (is_new) families_.emplace_back();
    families_[place->second].members.push_back(assigned_);
  }
}

std::shared_ptr<const RowFunctions> Families::functions(std::size_t family, ColumnMaker& maker) {
  Family& one = families_[family];
  if (one.stored != nullptr) return one.stored;
  auto made = std::make_shared<const RowFunctions>(functions_of(candidates_[one.members.front()], maker));
  Eigen::Index numbers = 0;
  for (const Eigen::MatrixXd& values : made->of_term) numbers += values.size();
  if (room_.fetch_sub(numbers) >= numbers)
    one.stored = made;
  else
    room_ += numbers;
  return made;
}

}  // namespace vernier::diagnose
