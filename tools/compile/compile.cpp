// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/compile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tables/checksum.h"
#include "tools/compile/bound.h"
#include "tools/compile/derive.h"
#include "tools/compile/image_writer.h"
#include "tools/compile/lower.h"
#include "tools/compile/print.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier::compile {
namespace {

// Initial neglect limit, and the finest that is tried to meet a budget.
constexpr double kNeglect_mm = 5e-6, kFinestNeglect_mm = 5e-9;
// Each evaluation reduces the remaining error by the slope of the errors, far below a hundredth.
constexpr int kMostEvaluations = 3;

const OutputBound& worst(const std::vector<OutputBound>& bounds) {
  return *std::max_element(bounds.begin(), bounds.end(),
                           [](const auto& a, const auto& b) { return a.total_um < b.total_um; });
}

Contribution largest_term(const OutputBound& bound) {
  const double second = bound.second_order_um.value_or(0);
  if (bound.contributions.empty() || second > bound.contributions.front().bound_um)
    return {"second order of the correction", "linearisation", second};
  return bound.contributions.front();
}

CompiledMachine compile_once(const model::Machine& machine, std::uint32_t tick_us, double neglect_mm,
                             int evaluations) {
  CompiledMachine result;
  const Derivation d = derive(machine, neglect_mm, evaluations);
  result.program = lower(machine, d, tick_us);
  result.shares = lower_shares(machine, d, result.program);
  result.switching = d.switching;
  result.notes = d.notes;
  if (result.shares.left_out > 0)
    result.notes.push_back(fmt::format(
        "the contributions of {} of {} effects do not fit into the image, so the board does not show them",
        result.shares.left_out, result.shares.left_out + result.shares.shares.size()));
  result.least_squares = d.least_squares;
  result.orientation = d.orientation;
  result.bounds = bounds_of(machine, d, result.program);
  result.tilt = tilt_bound_of(d, result.program);
  result.evaluations = 1 + static_cast<int>(d.before.size());
  result.operations_of_one = result.program.instructions.size();
  return result;
}

/// Is the remaining error of the Newton steps too large? Without a bound for them, two steps are
/// used.
bool needs_another(const CompiledMachine& so_far, const CompileOptions& options) {
  if (so_far.tilt && so_far.tilt->second_order_deg > options.most_second_order_deg) return true;
  const double most = std::min(options.most_second_order_um, options.budget_um.value_or(INFINITY));
  return std::any_of(so_far.bounds.begin(), so_far.bounds.end(), [&](const OutputBound& b) {
    if (b.deviation_deg || b.deviation_um == 0) return false;
    return b.second_order_um ? *b.second_order_um > most : so_far.evaluations < 2;
  });
}

/// Compiles with more evaluations. If an image has no space for them, the machine stays as it was,
/// with a note.
CompiledMachine compile_again(const model::Machine& machine, std::uint32_t tick_us, double neglect_mm,
                              int evaluations, CompiledMachine before) {
  try {
    CompiledMachine again = compile_once(machine, tick_us, neglect_mm, evaluations);
    again.operations_of_one = before.operations_of_one;
    return again;
  } catch (const text::InputError& reason) {
    before.notes.push_back(
        fmt::format("the second order of the correction is not corrected, because evaluation {} of the "
                    "deviation does not fit into the image: {}",
                    evaluations, reason.what()));
    return before;
  }
}

}  // namespace

std::uint64_t hash_of(const std::string& text) {
  return fnv1a(reinterpret_cast<const std::uint8_t*>(text.data()), static_cast<std::uint32_t>(text.size()));
}

CompiledMachine compile_machine(const model::Machine& machine, const std::string& machine_text,
                                const CompileOptions& options) {
  const auto over = [&](const CompiledMachine& c) {
    return options.budget_um && worst(c.bounds).total_um > *options.budget_um;
  };
  CompiledMachine result = compile_once(machine, options.tick_us, kNeglect_mm, 1);
  const std::size_t operations_of_one = result.operations_of_one;
  while (result.evaluations < kMostEvaluations && needs_another(result, options)) {
    const int more = result.evaluations + 1;
    result = compile_again(machine, options.tick_us, kNeglect_mm, more, std::move(result));
    if (result.evaluations < more) break;
  }
  for (double neglect = kNeglect_mm / 10; over(result) && neglect >= kFinestNeglect_mm; neglect /= 10) {
    const int evaluations = result.evaluations;
    result = compile_again(machine, options.tick_us, neglect, evaluations, std::move(result));
  }
  if (over(result) && result.evaluations == 1)
    result = compile_again(machine, options.tick_us, kFinestNeglect_mm, 2, std::move(result));
  result.operations_of_one = operations_of_one;
  if (over(result)) {
    const OutputBound& bad = worst(result.bounds);
    const Contribution blame = largest_term(bad);
    throw text::LimitNotMet(fmt::format(
        "error bound {:.4g} um on axis {} exceeds the budget of {:g} um; largest term: {} ({}), {:.4g} um",
        bad.total_um, bad.axis, *options.budget_um, blame.name, blame.source, blame.bound_um));
  }
  const std::uint64_t source_hash = hash_of(machine_text);
  result.image = write_image(machine, result.program, result.shares, options.tick_us, source_hash,
                             options.accepted_rules, result.fingerprint);
  result.header = print_header(machine, result.program, source_hash, result.fingerprint);
  result.source = print_source(machine, result.program, source_hash);
  load_image(result.image,
             machine);  // the compiler's own output must pass the board's verifier
  return result;
}

std::unique_ptr<LoadedImage> load_image(const std::vector<std::uint8_t>& image,
                                        const model::Machine& machine) {
  auto loaded = std::make_unique<LoadedImage>();
  loaded->machine = machine;
  loaded->words.resize((image.size() + 7) / 8);
  if (!image.empty()) std::memcpy(loaded->words.data(), image.data(), image.size());
  const ImageFault fault = loaded->view.open(reinterpret_cast<const std::uint8_t*>(loaded->words.data()),
                                             static_cast<std::uint32_t>(image.size()), loaded->workspace);
  if (fault != ImageFault::kNone) throw text::InputError(std::string("image refused: ") + describe(fault));
  return loaded;
}

std::unique_ptr<LoadedImage> load_image_dir(const std::string& directory) {
  const std::string text = text::read_file(directory + "/machine.xml"),
                    bytes = text::read_file(directory + "/machine.vimg");
  auto loaded =
      load_image({bytes.begin(), bytes.end()}, model::parse_machine(text, directory + "/machine.xml"));
  if (loaded->view.header().source_hash != hash_of(text))
    throw text::InputError(directory + "/machine.vimg was not compiled from the machine.xml beside it");
  return loaded;
}

}  // namespace vernier::compile
