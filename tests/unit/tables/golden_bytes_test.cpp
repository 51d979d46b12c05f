// SPDX-License-Identifier: GPL-3.0-or-later
// What is stored is compared with bytes that were stored before: tests/golden/image_v3.txt and the like,
// whose names carry the version of what they hold.
#include <gtest/gtest.h>

#include <cstring>

#include "comp/shares.h"
#include "firmware/core/link/signature.h"
#include "tables/checksum.h"
#include "tables/operator_record.h"
#include "tables/slots.h"
#include "tables/upload_format.h"
#include "tests/bench/poses.h"
#include "tests/unit/tables/golden_listing.h"
#include "tests/unit/tables/golden_machine.h"

namespace vernier::golden {

using namespace vernier::upload;
namespace {

/// A record whose bytes count up from `first`, so that each field has a value of its own.
template <class T>
std::vector<std::uint8_t> counting(std::uint8_t first) {
  std::vector<std::uint8_t> bytes(sizeof(T));
  for (std::uint8_t& byte : bytes) byte = first++;
  return bytes;
}

template <class T>
T read_as(const std::vector<std::uint8_t>& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof(value));
  return value;
}

std::string file_of(const char* what, std::uint32_t version) {
  return std::string(what) + "_v" + std::to_string(version) + ".txt";
}

std::string text_of(std::uint64_t value) { return std::to_string(value); }

// ---- the image

struct Section {
  const char* name;
  std::vector<Field> record;  // empty: one stretch of bytes
};

const std::vector<Section>& sections() {
  static const std::vector<Field> kInstruction = {{"op", 1}, {"shift", 1}, {"a", 2}, {"b", 2},
                                                  {"c", 2},  {"k", 4},     {"l", 4}};
  static const std::vector<Field> kTerm = {{"a", 2}, {"b", 2}, {"shift", 2}};
  static const std::vector<Section> kAll = {
      {"name", {}},
      {"axes", {{"name", 24}, {"flags", 4}, {"reserved", 4}, {"low", 8}, {"high", 8}}},
      {"inputs", {{"name", 24}, {"unit", 16}, {"reference", 8}, {"low", 8}, {"high", 8}}},
      {"constants", {}},
      {"channels",
       {{"kind", 1},
        {"index", 1},
        {"pre_shift", 1},
        {"shift", 1},
        {"multiplier", 4},
        {"low", 8},
        {"high", 8},
        {"wrap", 8}}},
      {"instructions", kInstruction},
      {"terms", kTerm},
      {"tables", {{"pieces", 4}, {"columns", 2}, {"degree", 2}, {"grid_multiplier", 4}, {"grid_shift", 4}}},
      {"records", {}},
      {"wraps", {{"first", 4}, {"period", 4}, {"reciprocal", 4}, {"shift", 4}}},
      {"outputs", {{"axis", 2}, {"source", 2}, {"shift", 4}, {"multiplier", 4}, {"limit", 4}, {"slew", 4}}},
      {"share constants", {}},
      {"share sources", {}},
      {"share instructions", kInstruction},
      {"share terms", kTerm},
      {"shares", {{"axis", 2}, {"source", 2}, {"shift", 4}, {"multiplier", 4}}},
      {"share names", {{"text", 64}}}};
  return kAll;
}

const std::vector<Field> kHeader = {{"magic", 8},          {"header_bytes", 4},   {"checksum", 4},
                                    {"format_version", 4}, {"image_bytes", 4},    {"section_count", 4},
                                    {"tick_us", 4},        {"fingerprint", 8},    {"source_hash", 8},
                                    {"lag_count", 4},      {"accepted_rules", 4}, {"reserved", 8}};

// An image, field by field, by the places that its own section entries name.
std::string listed_image(const std::vector<std::uint8_t>& image) {
  std::string text = "# machine image, format " + text_of(kImageFormatVersion) + "\n# header\n";
  const auto stretch = [&](std::size_t from, std::size_t to) {
    return std::vector<std::uint8_t>(image.begin() + static_cast<std::ptrdiff_t>(from),
                                     image.begin() + static_cast<std::ptrdiff_t>(to));
  };
  std::size_t at = sizeof(ImageHeader);
  text += listed(stretch(0, at), kHeader);
  std::vector<SectionEntry> entries;
  for (std::uint32_t i = 0; i < kSectionCount; ++i, at += sizeof(SectionEntry)) {
    const auto bytes = stretch(at, at + sizeof(SectionEntry));
    entries.push_back(read_as<SectionEntry>(bytes));
    text += "# entry " + std::string(sections()[i].name) + "\n" +
            listed(bytes, {{"type", 4}, {"offset", 4}, {"count", 4}, {"record_bytes", 4}});
  }
  for (std::uint32_t i = 0; i < kSectionCount; ++i) {
    const SectionEntry& entry = entries[i];
    if (entry.offset > at) text += listed(stretch(at, entry.offset), {{"gap", entry.offset - at}});
    at = entry.offset;
    const Section& section = sections()[i];
    if (section.record.empty()) {
      const std::size_t bytes = std::size_t{entry.count} * entry.record_bytes;
      if (bytes > 0) text += listed(stretch(at, at + bytes), {{section.name, bytes}});
      at += bytes;
      continue;
    }
    for (std::uint32_t k = 0; k < entry.count; ++k, at += entry.record_bytes)
      text += "# " + std::string(section.name) + " " + text_of(k) + "\n" +
              listed(stretch(at, at + entry.record_bytes), section.record);
  }
  return text;
}

// Corrections of the image over seeded poses: what its numbers mean.
std::uint64_t hash_of_corrections(const ImageView& view) {
  Compensator compensator(view.program());
  bench::Poses poses(view);
  std::uint64_t hash = kFnvSeed;
  for (int i = 0; i < 1000; ++i) hash = bench::mixed(hash, compensator.step(poses.next()));
  return hash;
}

TEST(GoldenBytes, ImageThatWasStoredIsReadFieldByFieldAndMeansTheSame) {
  const std::string file = file_of("image", kImageFormatVersion);
  std::vector<std::uint8_t> image = bytes_in(golden_text(file));
  if (image.empty()) image = golden_image();  // a new version; VERNIER_UPDATE_GOLDEN=1 writes it
  AlignedImage aligned(image);
  ASSERT_EQ(aligned.fault, ImageFault::kNone) << describe(aligned.fault);
  expect_golden(file, listed_image(image) + "= corrections over 1000 poses, hash " +
                          text_of(hash_of_corrections(aligned.view)) + "\n");
}

TEST(GoldenBytes, ImageHasEveryKindOfChannelOperationAndTable) {
  AlignedImage aligned(bytes_in(golden_text(file_of("image", kImageFormatVersion))));
  ASSERT_EQ(aligned.fault, ImageFault::kNone);
  const Program& program = aligned.view.program();
  std::uint32_t operations = 0, kinds = 0, degrees = 0;
  for (const Instruction& step : program.equation.instructions) operations |= 1u << static_cast<int>(step.op);
  for (const Channel& channel : program.channels) kinds |= 1u << static_cast<int>(channel.kind);
  for (const ErrorTable& table : program.equation.tables) degrees |= 1u << table.degree;
  EXPECT_EQ(operations, (1u << kOpCodeCount) - 1);
  EXPECT_EQ(kinds, (1u << kChannelKindCount) - 1);
  EXPECT_EQ(degrees, 1u << 1 | 1u << 3);
  EXPECT_GT(program.equation.wraps.size, 0u);
  EXPECT_GT(aligned.view.shares().shares.size, 0u);
}

// The compiler's own bytes carry the same header and sections as what was stored; the equation may differ, as
// the compiler gets better.
TEST(GoldenBytes, CompilerStillWritesThisFormat) {
  AlignedImage aligned(golden_image());
  ASSERT_EQ(aligned.fault, ImageFault::kNone);
  EXPECT_EQ(aligned.view.header().format_version, kImageFormatVersion);
  AlignedImage stored(bytes_in(golden_text(file_of("image", kImageFormatVersion))));
  EXPECT_STREQ(aligned.view.name(), stored.view.name());
  EXPECT_EQ(aligned.view.axes().size, stored.view.axes().size);
}

// Fields are read where the listing says that they stand: each of the bytes has a value of its own.
TEST(GoldenBytes, RecordsOfAnImageAreReadFromTheirPlaces) {
  const auto axis = read_as<AxisRecord>(counting<AxisRecord>(0));
  EXPECT_EQ(axis.flags, 0x1b1a1918u);
  EXPECT_EQ(axis.high, 0x2f2e2d2c2b2a2928);
  const auto input = read_as<InputRecord>(counting<InputRecord>(0));
  EXPECT_EQ(input.reference, 0x2f2e2d2c2b2a2928);
  const auto step = read_as<Instruction>(counting<Instruction>(0));
  EXPECT_EQ(static_cast<int>(step.op), 0);
  EXPECT_EQ(step.shift, 1);
  EXPECT_EQ(step.a, 0x0302);
  EXPECT_EQ(step.k, 0x0b0a0908);
  const auto channel = read_as<Channel>(counting<Channel>(0));
  EXPECT_EQ(channel.multiplier, 0x07060504);
  EXPECT_EQ(channel.wrap, 0x1f1e1d1c1b1a1918);
  const auto out = read_as<Output>(counting<Output>(0));
  EXPECT_EQ(out.limit, 0x0f0e0d0c);
  const auto share = read_as<Share>(counting<Share>(0));
  EXPECT_EQ(share.multiplier, 0x0b0a0908);
}

// ---- upload and slot record

TEST(GoldenBytes, UploadIsSignedAndLaidOutAsBefore) {
  const std::vector<std::uint8_t> image = bytes_in(golden_text(file_of("image", kImageFormatVersion)));
  ASSERT_FALSE(image.empty());
  const SigningKey key = golden_key();
  std::vector<std::uint8_t> upload = make_upload(image, key, 0x0102030405060708, 0x11121314, "mill-1");
  UploadHeader header;
  std::memcpy(&header, upload.data(), sizeof(header));
  EXPECT_TRUE(
      signature_fits(bytes_of_head(header, kSignedHeaderBytes), image, header.signature, key.public_part()));
  ASSERT_EQ(std::memcmp(upload.data() + sizeof(UploadHeader), image.data(), image.size()), 0);
  upload.resize(sizeof(UploadHeader));
  expect_golden(file_of("upload", kUploadFormatVersion),
                "# signed upload, version " + text_of(kUploadFormatVersion) +
                    ": this header, then the image of image_v" + text_of(kImageFormatVersion) + ".txt\n" +
                    listed(upload, {{"magic", 8},
                                    {"header_bytes", 4},
                                    {"image_bytes", 4},
                                    {"issued", 8},
                                    {"fingerprint", 8},
                                    {"security", 4},
                                    {"reserved", 4},
                                    {"board", 24},
                                    {"key", 24},
                                    {"signature", 64}}));
}

TEST(GoldenBytes, OperatorRecordIsStoredAsBefore) {
  const std::vector<Field> fields = {{"magic", 4},   {"sequence", 4}, {"out", 1},
                                     {"holding", 1}, {"fault", 1},    {"reserved", 1},
                                     {"axis", 32},   {"weight", 32},  {"checksum", 4}};
  std::string text = "# operator record, version " + text_of(kOperatorRecordVersion) + "\n";
  OperatorRecords records = OperatorRecords::load({}, {});
  EXPECT_FALSE(records.known());
  OperatorState state{
      .out = 1, .holding = 0, .fault = 4, .axis = {operator_axis("X", 1)}, .weight = {0x8000}};
  for (const char* const what : {"deactivated, a fault is latched, X at one half", "held"}) {
    const OperatorChange change = records.change_to(state);
    EXPECT_TRUE(is_valid(change.record));
    std::vector<std::uint8_t> bytes(sizeof(OperatorRecord));
    std::memcpy(bytes.data(), &change.record, bytes.size());
    text += std::string("# ") + what + ", stored in place " + text_of(change.place) + "\n" +
            listed(bytes, fields);
    records.stored(change);
    state.out = state.fault = 0, state.holding = 1;
  }
  expect_golden(file_of("operator_record", kOperatorRecordVersion), text);
}

TEST(GoldenBytes, SlotRecordIsStoredAsBefore) {
  const std::vector<Field> fields = {{"magic", 4},        {"sequence", 4},      {"issued", 8},
                                     {"trial_issued", 8}, {"newest_issued", 8}, {"security", 4},
                                     {"confirmed", 1},    {"trial", 1},         {"reserved", 2},
                                     {"reserved2", 4},    {"checksum", 4}};
  std::string text = "# slot record, version " + text_of(kSlotRecordVersion) + "\n";
  Slots slots = Slots::load({}, {});
  const auto take = [&](const char* what, const SlotChange& change) {
    std::vector<std::uint8_t> bytes(sizeof(SlotRecord));
    std::memcpy(bytes.data(), &change.record, bytes.size());
    EXPECT_TRUE(is_valid(change.record));
    text += std::string("# ") + what + ", stored in place " + text_of(change.place) + "\n" +
            listed(bytes, fields);
    slots.stored(change);
  };
  take("trial of the first image", slots.start_trial(0x0102030405060708, 3));
  take("confirmed", slots.confirm());
  take("trial of a second one", slots.start_trial(0x1112131415161718, 4));
  take("reverted", slots.revert());
  expect_golden(file_of("slot_record", kSlotRecordVersion), text);
}

}  // namespace
}  // namespace vernier::golden
