#include "tools/compile/compile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tables/checksum.h"
#include "tools/compile/bound.h"
#include "tools/model/files.h"

namespace vernier {
namespace {

// What is left out at first, and the finest that is tried to meet a budget.
constexpr double kNeglect_mm = 5e-6, kFinestNeglect_mm = 5e-9;

const OutputBound& worst(const std::vector<OutputBound>& bounds) {
  return *std::max_element(bounds.begin(), bounds.end(),
                           [](const auto& a, const auto& b) { return a.total_um < b.total_um; });
}

CompiledMachine compile_once(const Machine& machine, std::uint32_t tick_us, double neglect_mm) {
  CompiledMachine result;
  const Derivation d = derive(machine, neglect_mm);
  result.program = lower(machine, d, tick_us);
  result.shares = lower_shares(machine, d, result.program);
  result.switching = d.switching;
  result.notes = d.notes;
  if (result.shares.left_out > 0)
    result.notes.push_back(
        fmt::format("{} of {} shares of effects have no room in the image and are left out",
                    result.shares.left_out, result.shares.left_out + result.shares.shares.size()));
  result.least_squares = d.least_squares;
  result.bounds = bounds_of(machine, d, result.program);
  return result;
}

}  // namespace

std::uint64_t hash_of(const std::string& text) {
  return fnv1a(reinterpret_cast<const std::uint8_t*>(text.data()), static_cast<std::uint32_t>(text.size()));
}

CompiledMachine compile_machine(const Machine& machine, const std::string& machine_text,
                                const CompileOptions& options) {
  CompiledMachine result = compile_once(machine, options.tick_us, kNeglect_mm);
  for (double neglect = kNeglect_mm / 10;
       options.budget_um && worst(result.bounds).total_um > *options.budget_um &&
       neglect >= kFinestNeglect_mm;
       neglect /= 10)
    result = compile_once(machine, options.tick_us, neglect);
  if (options.budget_um && worst(result.bounds).total_um > *options.budget_um) {
    const OutputBound& bad = worst(result.bounds);
    const Contribution& blame = bad.contributions.front();
    throw LimitNotMet(fmt::format(
        "error bound {:.4g} um on axis {} exceeds the budget of {:g} um; largest term: {} ({}), {:.4g} um",
        bad.total_um, bad.axis, *options.budget_um, blame.name, blame.source, blame.bound_um));
  }
  const std::uint64_t source_hash = hash_of(machine_text);
  result.image =
      write_image(machine, result.program, result.shares, options.tick_us, source_hash, result.fingerprint);
  result.header = print_header(machine, result.program, source_hash, result.fingerprint);
  result.source = print_source(machine, result.program, source_hash);
  load_image(result.image,
             machine);  // the compiler's own output passes the board's verifier, or it is no output
  return result;
}

std::unique_ptr<LoadedImage> load_image(const std::vector<std::uint8_t>& image, const Machine& machine) {
  auto loaded = std::make_unique<LoadedImage>();
  loaded->machine = machine;
  loaded->words.resize((image.size() + 7) / 8);
  if (!image.empty()) std::memcpy(loaded->words.data(), image.data(), image.size());
  const ImageFault fault = loaded->view.open(reinterpret_cast<const std::uint8_t*>(loaded->words.data()),
                                             static_cast<std::uint32_t>(image.size()), loaded->workspace);
  if (fault != ImageFault::kNone) throw InputError(std::string("image refused: ") + describe(fault));
  return loaded;
}

std::unique_ptr<LoadedImage> load_image_dir(const std::string& directory) {
  const std::string text = read_file(directory + "/machine.xml"),
                    bytes = read_file(directory + "/machine.vimg");
  auto loaded = load_image({bytes.begin(), bytes.end()}, parse_machine(text, directory + "/machine.xml"));
  if (loaded->view.header().source_hash != hash_of(text))
    throw InputError(directory + "/machine.vimg was not compiled from the machine.xml beside it");
  return loaded;
}

}  // namespace vernier
