// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/propose/enumerate.h"

namespace vernier::diagnose {

/// A product of recorded quantities at one degree of freedom, for example k*X*(T-20).
struct Product {
  effects::DofPlace place;
  model::ExprPtr term;
  std::vector<std::string> inputs, units;
};

/// Builds candidates that are not in the catalogue: products of recorded quantities. If `extend` is empty,
/// enumerate_products returns all products of one or two recorded quantities at every location of the chain.
/// If `extend` is not empty, enumerate_products returns each product of `extend` with one additional factor.
std::vector<ScannedCandidate> enumerate_products(const Evidence& evidence,
                                                 const std::vector<Product>& extend);

}  // namespace vernier::diagnose
