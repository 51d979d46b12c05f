// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Domains of validity of learned terms. A term that was learned on features is worth nothing where it was
/// not trained; it is written `weight*term`, an ordinary expression over ordinary hidden statics, so that
/// model, fit, compile and board need nothing special:
///   weight = product over the domain's quantities Q of max(0,1-max(0,max(D_Q_low-Q,Q-D_Q_high))/D_Q_fade)
/// 1 within the range of training, 0 beyond it by the fade, D the domain's name.
std::string domain_weight(const std::string& domain, const std::vector<std::string>& quantities);

/// Name, value and unit of the hidden statics that a new domain brings: open (+-1e9), until a fit closes
/// them.
struct DomainStatic {
  std::string name, unit;
  double value = 0;
};
std::vector<DomainStatic> open_domain(
    const std::string& domain, const std::vector<std::pair<std::string, std::string>>& quantity_and_unit);

/// One quantity of one domain of a machine: the hidden statics are found by their names.
struct DomainRange {
  std::string domain, quantity;
  model::Symbol symbol;
  double low = 0, high = 0, fade = 0;
  bool open = false;  // not trained yet
};
std::vector<DomainRange> domain_ranges(const model::Machine& machine);

/// The text with every open range closed around the fit rows of a measurement: lowest and highest value of
/// the quantity, fade a tenth of their distance (of the value, where it did not vary). Ranges that are closed
/// stay. tool.
std::string close_domains(const std::string& text, const model::Machine& machine,
                          const model::Measurement& measurement);

/// How rows stand to a domain. tool.
struct DomainUse {
  DomainRange range;
  double least = 0, most = 0;       // of the quantity over all rows
  std::size_t faded = 0, gone = 0;  // rows where the weight is below 1, and 0
};
std::vector<DomainUse> domain_use(const model::Machine& machine, const model::Measurement& measurement);

}  // namespace vernier::fit
