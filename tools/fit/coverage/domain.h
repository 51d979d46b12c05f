// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Domains of validity of learned terms. A term that was learned on features is not valid outside its
/// training data. The machine file contains such a term as `weight*term`, an ordinary expression with
/// ordinary hidden statics. Model, fit, compile and board therefore need no special code. weight = product
/// over the domain's quantities Q of max(0,1-max(0,max(D_Q_low-Q,Q-D_Q_high))/D_Q_fade). The weight is 1
/// within the range of training and decreases to 0 over the fade. D is the domain's name.
std::string domain_weight(const std::string& domain, const std::vector<std::string>& quantities);

/// Name, value and unit of the hidden statics of a new domain. The hidden statics are open (+-1e9) until a
/// fit closes them.
struct DomainStatic {
  std::string name, unit;
  double value = 0;
};
std::vector<DomainStatic> open_domain(
    const std::string& domain, const std::vector<std::pair<std::string, std::string>>& quantity_and_unit);

/// Range of one quantity in one domain of a machine. The code finds the hidden statics by their names.
struct DomainRange {
  std::string domain, quantity;
  model::Symbol symbol;
  double low = 0, high = 0, fade = 0;
  bool open = false;  // not trained yet
};
std::vector<DomainRange> domain_ranges(const model::Machine& machine);

/// Returns the text with every open range closed around the fit rows of a measurement. The limits are the
/// lowest and highest value of the quantity. The fade is a tenth of the distance between the limits (of the
/// value, if the quantity did not vary). Closed ranges are not changed.
std::string close_domains(const std::string& text, const model::Machine& machine,
                          const model::Measurement& measurement);

/// Position of rows relative to a domain.
struct DomainUse {
  DomainRange range;
  double least = 0, most = 0;       // of the quantity over all rows
  std::size_t faded = 0, gone = 0;  // rows where the weight is below 1, and 0
};
std::vector<DomainUse> domain_use(const model::Machine& machine, const model::Measurement& measurement);

}  // namespace vernier::fit
