// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/image_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tables/checksum.h"
#include "tables/image_format.h"
#include "tools/compile/symbolic/ranges.h"

namespace vernier::compile {
namespace {

class Writer {
 public:
  Writer() : bytes_(sizeof(ImageHeader) + kSectionCount * sizeof(SectionEntry)) {}

  template <class T>
  void section(SectionType type, const std::vector<T>& records) {
    bytes_.resize((bytes_.size() + kImageAlignment - 1) / kImageAlignment * kImageAlignment);
    const SectionEntry entry{type, static_cast<std::uint32_t>(bytes_.size()),
                             static_cast<std::uint32_t>(records.size()), sizeof(T)};
    std::memcpy(bytes_.data() + sizeof(ImageHeader) + sizeof(SectionEntry) * static_cast<std::size_t>(type),
                &entry, sizeof(entry));
    const std::size_t start = bytes_.size();
    bytes_.resize(start + records.size() * sizeof(T));
    if (!records.empty()) std::memcpy(bytes_.data() + start, records.data(), records.size() * sizeof(T));
    if (type >= SectionType::kConstants)
      fingerprint_ =
          fnv1a(bytes_.data() + start, static_cast<std::uint32_t>(bytes_.size() - start), fingerprint_);
  }

  std::vector<std::uint8_t> finish(ImageHeader header) {
    std::memcpy(header.magic, kImageMagic, sizeof(kImageMagic));
    header.header_bytes = sizeof(ImageHeader);
    header.format_version = kImageFormatVersion;
    header.image_bytes = static_cast<std::uint32_t>(bytes_.size());
    header.section_count = kSectionCount;
    header.fingerprint = fingerprint_;
    std::memcpy(bytes_.data(), &header, sizeof(header));
    header.checksum = crc32c(bytes_.data() + kChecksumStart, header.image_bytes - kChecksumStart);
    std::memcpy(bytes_.data(), &header, sizeof(header));
    return std::move(bytes_);
  }
  std::uint64_t fingerprint() const { return fingerprint_; }

 private:
  std::vector<std::uint8_t> bytes_;
  std::uint64_t fingerprint_ = kFnvSeed;
};

void copy_text(char* field, std::size_t size, const std::string& text, const model::Machine& machine,
               std::size_t line) {
  if (text.size() >= size)
    throw text::InputError({machine.file, line}, text, "the name is too long for an image");
  std::copy(text.begin(), text.end(), field);  // the rest of the field is zero
}

std::vector<AxisRecord> axis_records(const model::Machine& machine) {
  std::vector<AxisRecord> records;
  for (const model::Axis& axis : machine.axes) {
    AxisRecord r{};
    copy_text(r.name, sizeof(r.name), axis.name, machine, axis.line);
    r.flags = (axis.rotary ? kRotary : 0u) | (axis.rollover ? kRollover : 0u);
    const double counts = axis.rotary ? static_cast<double>(kTurnCounts) / 360 : 1e6;
    r.low = std::llround(axis.min.value() * counts);
    r.high = std::llround(axis.max.value() * counts);
    records.push_back(r);
  }
  return records;
}

std::vector<InputRecord> input_records(const model::Machine& machine) {
  std::vector<InputRecord> records;
  for (const model::Input& input : machine.inputs) {
    InputRecord r{};
    copy_text(r.name, sizeof(r.name), input.name, machine, input.line);
    copy_text(r.unit, sizeof(r.unit), input.unit, machine, input.line);
    const Interval range = input_range(machine, records.size());
    r.reference = std::llround(input.reference * 1e6);
    r.low = std::llround(range.low * 1e6);
    r.high = std::llround(range.high * 1e6);
    records.push_back(r);
  }
  return records;
}

}  // namespace

std::vector<std::uint8_t> write_image(const model::Machine& machine, const LoweredProgram& program,
                                      const LoweredShares& shares, std::uint32_t tick_us,
                                      std::uint64_t source_hash, std::uint32_t accepted_rules,
                                      std::uint64_t& fingerprint) {
  Writer writer;
  std::vector<char> name(machine.name.begin(), machine.name.end());
  name.push_back('\0');
  writer.section(SectionType::kName, name);
  writer.section(SectionType::kAxes, axis_records(machine));
  writer.section(SectionType::kInputs, input_records(machine));
  writer.section(SectionType::kConstants, program.constants);
  writer.section(SectionType::kChannels, program.channels);
  writer.section(SectionType::kInstructions, program.instructions);
  writer.section(SectionType::kTerms, program.terms);
  std::vector<TableRecord> tables;
  std::vector<std::int32_t> records;
  for (const LoweredTable& t : program.tables) {
    tables.push_back({t.pieces, t.columns, t.degree, t.grid_multiplier, t.grid_shift});
    records.insert(records.end(), t.records.begin(), t.records.end());
  }
  writer.section(SectionType::kTables, tables);
  writer.section(SectionType::kRecords, records);
  writer.section(SectionType::kWraps, program.wraps);
  writer.section(SectionType::kOutputs, program.outputs);
  writer.section(SectionType::kShareConstants, shares.constants);
  writer.section(SectionType::kShareSources, shares.sources);
  writer.section(SectionType::kShareInstructions, shares.instructions);
  writer.section(SectionType::kShareTerms, shares.terms);
  writer.section(SectionType::kShares, shares.shares);
  std::vector<ShareName> names(shares.names.size());
  for (std::size_t i = 0; i < names.size(); ++i)
    std::memcpy(names[i].text, shares.names[i].data(),
                std::min(shares.names[i].size(), sizeof(ShareName) - 1));
  writer.section(SectionType::kShareNames, names);
  ImageHeader header{};
  header.tick_us = tick_us;
  header.source_hash = source_hash;
  header.lag_count = program.lag_count;
  header.accepted_rules = accepted_rules;
  fingerprint = writer.fingerprint();
  return writer.finish(header);
}

}  // namespace vernier::compile
