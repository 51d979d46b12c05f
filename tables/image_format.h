// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>

#include "comp/shares.h"

/// Definition of the correction image (`machine.vimg`). The compiler, the uploader and the firmware all use
/// only this definition. All numbers of the image are little-endian. The parts of the image are, in order:
/// header (64 bytes), `section_count` section entries, sections. Each section begins at a multiple of 8 bytes
/// from the start of the image. Gaps contain zeros. Every section type occurs exactly once. The sections are
/// in the order of SectionType. The checksum covers all bytes of the image after the checksum field.
namespace vernier {

static_assert(std::endian::native == std::endian::little, "images are read in place");

constexpr std::uint8_t kImageMagic[8] = {'V', 'E', 'R', 'N', 'I', 'E', 'R', '\n'};
constexpr std::uint32_t kImageFormatVersion = 3;
constexpr std::uint32_t kMaxImageBytes = 16u << 20;
constexpr std::uint32_t kImageAlignment = 8;
constexpr std::uint32_t kImageNameBytes = 24;

struct ImageHeader {
  std::uint8_t magic[8];
  std::uint32_t header_bytes;  // 64; the section entries follow after these bytes
  std::uint32_t checksum;      // CRC-32C of all bytes after this field
  std::uint32_t format_version;
  std::uint32_t image_bytes;  // number of bytes in the whole image
  std::uint32_t section_count;
  std::uint32_t tick_us;      // cycle time for which lags and slew limits were computed
  std::uint64_t fingerprint;  // fingerprint of the equation: FNV-1a over the sections from kConstants on
  std::uint64_t source_hash;  // FNV-1a of the machine file from which the image was compiled
  std::uint32_t lag_count;
  std::uint32_t accepted_rules;  // bit n: the user accepted rule n of "safe to run?" although it is not met
                                 // (tools/safety)
  std::uint32_t reserved[2];     // 0
};
static_assert(sizeof(ImageHeader) == 64);
static_assert(offsetof(ImageHeader, magic) == 0 && offsetof(ImageHeader, header_bytes) == 8 &&
              offsetof(ImageHeader, checksum) == 12 && offsetof(ImageHeader, format_version) == 16 &&
              offsetof(ImageHeader, image_bytes) == 20 && offsetof(ImageHeader, section_count) == 24 &&
              offsetof(ImageHeader, tick_us) == 28 && offsetof(ImageHeader, fingerprint) == 32 &&
              offsetof(ImageHeader, source_hash) == 40 && offsetof(ImageHeader, lag_count) == 48 &&
              offsetof(ImageHeader, accepted_rules) == 52 && offsetof(ImageHeader, reserved) == 56);
constexpr std::uint32_t kChecksumStart = 16;  // first byte that the checksum covers

enum class SectionType : std::uint32_t {
  kName = 0,          // char: name of the machine
  kAxes = 1,          // AxisRecord
  kInputs = 2,        // InputRecord
  kConstants = 3,     // int32
  kChannels = 4,      // Channel (comp/compensator.h)
  kInstructions = 5,  // Instruction (comp/equation.h)
  kTerms = 6,         // ProductTerm, for the instructions that sum products
  kTables = 7,        // TableRecord
  kRecords = 8,       // int32: the records of all tables one after the other (comp/error_table.h), without
                      // gaps
  kWraps = 9,         // Wrap
  kOutputs = 10,      // Output
  // The sections from here on contain the equation for the shares of the effects (comp/shares.h).
  kShareConstants = 11,     // int32
  kShareSources = 12,       // uint16: registers of the tick
  kShareInstructions = 13,  // Instruction
  kShareTerms = 14,         // ProductTerm
  kShares = 15,             // Share
  kShareNames = 16,         // ShareName, one per share
};
constexpr std::uint32_t kSectionCount = static_cast<std::uint32_t>(SectionType::kShareNames) + 1;

struct SectionEntry {
  SectionType type;
  std::uint32_t offset;  // offset from the start of the image
  std::uint32_t count;   // number of records
  std::uint32_t record_bytes;
};
static_assert(sizeof(SectionEntry) == 16);
static_assert(offsetof(SectionEntry, type) == 0 && offsetof(SectionEntry, offset) == 4 &&
              offsetof(SectionEntry, count) == 8 && offsetof(SectionEntry, record_bytes) == 12);

/// Form of a station table in the image. The records of a table are pieces * (4 + columns * (degree + 1))
/// words in the section kRecords. For each segment there is its Segment (start, length, reciprocal, shift),
/// and then the coefficients of one column after another. With six linear columns a record has 64 bytes. With
/// records of 64 bytes, an interpolation reads at most two cache lines.
struct TableRecord {
  std::uint32_t pieces;
  std::uint16_t columns;
  std::uint16_t degree;           // 1: linear; 3: cubic
  std::uint32_t grid_multiplier;  // for evenly spaced stations; otherwise 0 (ErrorTable)
  std::uint32_t grid_shift;
};
static_assert(sizeof(TableRecord) == 16);
static_assert(offsetof(TableRecord, pieces) == 0 && offsetof(TableRecord, columns) == 4 &&
              offsetof(TableRecord, degree) == 6 && offsetof(TableRecord, grid_multiplier) == 8 &&
              offsetof(TableRecord, grid_shift) == 12);

enum AxisFlag : std::uint32_t { kRotary = 1u << 0, kRollover = 1u << 1 };

/// A name in the image ends with a zero byte and is filled with zeros.
struct AxisRecord {
  char name[kImageNameBytes];
  std::uint32_t flags;     // AxisFlag
  std::uint32_t reserved;  // 0
  std::int64_t low, high;  // declared range, axis counts
};
static_assert(sizeof(AxisRecord) == 48);
static_assert(offsetof(AxisRecord, name) == 0 && offsetof(AxisRecord, flags) == 24 &&
              offsetof(AxisRecord, reserved) == 28 && offsetof(AxisRecord, low) == 32 &&
              offsetof(AxisRecord, high) == 40);

struct InputRecord {
  char name[kImageNameBytes];
  char unit[16];
  std::int64_t reference;  // value that replaces a missing sensor, 1e-6 of the unit
  std::int64_t low, high;  // range for which the error bound is valid, 1e-6 of the unit
};
static_assert(sizeof(InputRecord) == 64);
static_assert(offsetof(InputRecord, name) == 0 && offsetof(InputRecord, unit) == 24 &&
              offsetof(InputRecord, reference) == 40 && offsetof(InputRecord, low) == 48 &&
              offsetof(InputRecord, high) == 56);

/// Name of a share in a live display: "X of transform 2 (tool): BX*dirX". A longer name is truncated.
struct ShareName {
  char text[64];
};
static_assert(sizeof(ShareName) == 64);

}  // namespace vernier
