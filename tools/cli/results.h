#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/fit/fit.h"

namespace vernier {

/// The keys that `fit` and `compare` share (FORMATS section 3).
nlohmann::ordered_json fit_json(const FitResult& result, const Measurement& measurement);
nlohmann::ordered_json compare_json(const Machine& machine, const Measurement& measurement,
                                    const Eigen::VectorXd& residual);

/// Everything that the report draws: rows, columns, observations, circles, worst rows. `result` gets a
/// "detail" member.
void add_detail(nlohmann::ordered_json& result, const Machine& machine, const Measurement& measurement,
                const Eigen::VectorXd& residual);

/// ISO 230-4 numbers of every circular test among the rows (a list, empty where there is none).
nlohmann::ordered_json circular_json(const Machine& machine, const Measurement& measurement);

/// A number for people: four significant digits, "-" for none.
std::string number_or_dash(const std::optional<double>& value, const char* unit);

}  // namespace vernier
