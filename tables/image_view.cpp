// SPDX-License-Identifier: Apache-2.0
#include "tables/image_view.h"

#include "comp/fixed.h"
#include "tables/checksum.h"

namespace vernier {
namespace {

constexpr std::uint32_t kRecordBytes[kSectionCount] = {1,
                                                       sizeof(AxisRecord),
                                                       sizeof(InputRecord),
                                                       4,
                                                       sizeof(Channel),
                                                       sizeof(Instruction),
                                                       sizeof(ProductTerm),
                                                       sizeof(TableRecord),
                                                       4,
                                                       sizeof(Wrap),
                                                       sizeof(Output),
                                                       4,
                                                       sizeof(std::uint16_t),
                                                       sizeof(Instruction),
                                                       sizeof(ProductTerm),
                                                       sizeof(Share),
                                                       sizeof(ShareName)};

template <class T>
const T* at(const std::uint8_t* bytes, std::uint32_t offset) {
  return reinterpret_cast<const T*>(bytes + offset);
}

constexpr std::uint64_t aligned(std::uint64_t offset) {
  return (offset + kImageAlignment - 1) & ~std::uint64_t{kImageAlignment - 1};
}

bool zero_between(const std::uint8_t* bytes, std::uint64_t from, std::uint64_t to) {
  for (std::uint64_t i = from; i < to; ++i)
    if (bytes[i] != 0) return false;
  return true;
}

ImageFault check_header(const std::uint8_t* bytes, std::uint32_t size) {
  if ((reinterpret_cast<std::uintptr_t>(bytes) & (kImageAlignment - 1)) != 0) return ImageFault::kMisaligned;
  if (size < sizeof(ImageHeader)) return ImageFault::kTruncated;
  const ImageHeader& header = *at<ImageHeader>(bytes, 0);
  for (std::uint32_t i = 0; i < sizeof(kImageMagic); ++i)
    if (header.magic[i] != kImageMagic[i]) return ImageFault::kMagic;
  if (header.format_version != kImageFormatVersion) return ImageFault::kFormatVersion;
  if (header.header_bytes != sizeof(ImageHeader) || header.image_bytes > kMaxImageBytes)
    return ImageFault::kHeader;
  if (header.image_bytes < sizeof(ImageHeader) + kSectionCount * sizeof(SectionEntry))
    return ImageFault::kHeader;
  if (header.image_bytes > size) return ImageFault::kTruncated;
  if (header.section_count != kSectionCount || header.tick_us == 0) return ImageFault::kHeader;
  if ((header.reserved[0] | header.reserved[1]) != 0) return ImageFault::kHeader;
  if (crc32c(bytes + kChecksumStart, header.image_bytes - kChecksumStart) != header.checksum)
    return ImageFault::kChecksum;
  return ImageFault::kNone;
}

// The sections fill the image without gaps beyond the alignment, so that no byte of it is without meaning.
ImageFault check_sections(const std::uint8_t* bytes) {
  const ImageHeader& header = *at<ImageHeader>(bytes, 0);
  const SectionEntry* const entries = at<SectionEntry>(bytes, sizeof(ImageHeader));
  std::uint64_t end = sizeof(ImageHeader) + kSectionCount * sizeof(SectionEntry);
  std::uint64_t fingerprint = kFnvSeed;
  for (std::uint32_t i = 0; i < kSectionCount; ++i) {
    const SectionEntry& entry = entries[i];
    if (static_cast<std::uint32_t>(entry.type) != i || entry.record_bytes != kRecordBytes[i])
      return ImageFault::kSection;
    const std::uint64_t bytes_here = std::uint64_t{entry.count} * entry.record_bytes;
    if (entry.offset != aligned(end) || entry.offset + bytes_here > header.image_bytes)
      return ImageFault::kSection;
    if (!zero_between(bytes, end, entry.offset)) return ImageFault::kSection;
    end = entry.offset + bytes_here;
    if (i >= static_cast<std::uint32_t>(SectionType::kConstants))
      fingerprint = fnv1a(bytes + entry.offset, static_cast<std::uint32_t>(bytes_here), fingerprint);
  }
  if (end != header.image_bytes) return ImageFault::kSection;
  return fingerprint == header.fingerprint ? ImageFault::kNone : ImageFault::kFingerprint;
}

// A name is one to size-1 characters and zeros to the end of its field.
bool text_ok(const char* text, std::uint32_t size, bool may_be_empty) {
  std::uint32_t length = 0;
  while (length < size && text[length] != 0) ++length;
  if (length == size || (length == 0 && !may_be_empty)) return false;
  return zero_between(reinterpret_cast<const std::uint8_t*>(text), length, size);
}

bool axis_ok(const AxisRecord& axis) {
  return text_ok(axis.name, sizeof(axis.name), false) &&
         (axis.flags & ~std::uint32_t{kRotary | kRollover}) == 0 && axis.reserved == 0 &&
         axis.low <= axis.high;
}

bool input_ok(const InputRecord& input) {
  return text_ok(input.name, sizeof(input.name), false) && text_ok(input.unit, sizeof(input.unit), true) &&
         input.low <= input.high;
}

bool same_text(const char* a, const char* b, std::uint32_t size) {
  for (std::uint32_t i = 0; i < size; ++i)
    if (a[i] != b[i]) return false;
  return true;
}

/// True if a name is in two records. The verifier refuses more records than a board has room for.
template <class Record>
bool named_twice(View<Record> records, std::uint32_t most) {
  if (records.size > most) return false;
  for (std::uint32_t i = 0; i < records.size; ++i)
    for (std::uint32_t k = 0; k < i; ++k)
      if (same_text(records[i].name, records[k].name, kImageNameBytes)) return true;
  return false;
}

template <class T>
View<T> section(const std::uint8_t* bytes, SectionType type) {
  const SectionEntry& entry = at<SectionEntry>(bytes, sizeof(ImageHeader))[static_cast<std::uint32_t>(type)];
  return {at<T>(bytes, entry.offset), entry.count};
}

ImageFault fault_of(ProgramFault fault) {
  if (fault == ProgramFault::kNone) return ImageFault::kNone;
  return static_cast<ImageFault>(static_cast<int>(ImageFault::kProgramTooLong) + static_cast<int>(fault) -
                                 static_cast<int>(ProgramFault::kTooLong));
}
static_assert(static_cast<int>(ImageFault::kProgramOutput) - static_cast<int>(ImageFault::kProgramTooLong) ==
              static_cast<int>(ProgramFault::kOutput) - static_cast<int>(ProgramFault::kTooLong));

}  // namespace

ImageFault ImageView::read_tables(View<TableRecord> tables, View<std::int32_t> words) noexcept {
  if (tables.size > kMaxTables) return ImageFault::kTooMany;
  std::uint64_t next = 0;
  for (std::uint32_t i = 0; i < tables.size; ++i) {
    const TableRecord& t = tables[i];
    const std::int32_t* const records = words.data + next;
    tables_[i] = {records, t.pieces, t.columns, t.degree, t.grid_multiplier, t.grid_shift};
    next += std::uint64_t{t.pieces} * tables_[i].stride();
    if (next > words.size) return ImageFault::kRange;
  }
  program_.equation.tables = {tables_, tables.size};
  return next == words.size ? ImageFault::kNone : ImageFault::kRange;
}

// Wide enough that no number of instructions can bring it round; the verifier bounds it.
void ImageView::count_results(Equation& equation) noexcept {
  std::uint64_t results = 0;
  for (const Instruction& step : equation.instructions) results += results_of(step, equation.tables);
  equation.result_count = static_cast<std::uint32_t>(lower<std::uint64_t>(results, UINT32_MAX));
}

ImageFault ImageView::read_sections(const std::uint8_t* bytes) noexcept {
  const View<char> name = section<char>(bytes, SectionType::kName);
  if (name.size == 0 || name[name.size - 1] != 0) return ImageFault::kSection;
  name_ = name.data;
  axes_ = section<AxisRecord>(bytes, SectionType::kAxes);
  inputs_ = section<InputRecord>(bytes, SectionType::kInputs);
  for (const AxisRecord& axis : axes_)
    if (!axis_ok(axis)) return ImageFault::kAxis;
  for (const InputRecord& input : inputs_)
    if (!input_ok(input)) return ImageFault::kInput;
  if (named_twice(axes_, kMaxAxes)) return ImageFault::kAxis;
  if (named_twice(inputs_, kMaxInputs)) return ImageFault::kInput;

  program_.axis_count = axes_.size;
  program_.input_count = inputs_.size;
  program_.channels = section<Channel>(bytes, SectionType::kChannels);
  program_.outputs = section<Output>(bytes, SectionType::kOutputs);
  Equation& equation = program_.equation;
  equation.constants = section<std::int32_t>(bytes, SectionType::kConstants);
  equation.channel_count = program_.channels.size;
  equation.instructions = section<Instruction>(bytes, SectionType::kInstructions);
  equation.wraps = section<Wrap>(bytes, SectionType::kWraps);
  equation.lag_count = header_->lag_count;
  equation.terms = section<ProductTerm>(bytes, SectionType::kTerms);
  const ImageFault fault = read_tables(section<TableRecord>(bytes, SectionType::kTables),
                                       section<std::int32_t>(bytes, SectionType::kRecords));
  count_results(equation);
  return fault == ImageFault::kNone ? read_shares(bytes) : fault;
}

ImageFault ImageView::read_shares(const std::uint8_t* bytes) noexcept {
  Equation& equation = shares_.equation;
  equation.constants = section<std::int32_t>(bytes, SectionType::kShareConstants);
  shares_.sources = section<std::uint16_t>(bytes, SectionType::kShareSources);
  equation.channel_count = shares_.sources.size;
  equation.instructions = section<Instruction>(bytes, SectionType::kShareInstructions);
  equation.terms = section<ProductTerm>(bytes, SectionType::kShareTerms);
  count_results(equation);
  shares_.shares = section<Share>(bytes, SectionType::kShares);
  share_names_ = section<ShareName>(bytes, SectionType::kShareNames);
  if (share_names_.size != shares_.shares.size) return ImageFault::kSection;
  for (const ShareName& name : share_names_)
    if (!text_ok(name.text, sizeof(name.text), false)) return ImageFault::kSection;
  return ImageFault::kNone;
}

ImageFault ImageView::read(const std::uint8_t* bytes, std::uint32_t size,
                           ImageWorkspace& workspace) noexcept {
  ImageFault fault = check_header(bytes, size);
  if (fault == ImageFault::kNone) fault = check_sections(bytes);
  if (fault != ImageFault::kNone) return fault;
  header_ = at<ImageHeader>(bytes, 0);
  fault = read_sections(bytes);
  if (fault == ImageFault::kNone) fault = fault_of(verify_program(program_, workspace.ranges));
  return fault != ImageFault::kNone ? fault : fault_of(verify_shares(shares_, program_, workspace.ranges));
}

void ImageView::close() noexcept {
  header_ = nullptr;
  name_ = "";
  axes_ = {};
  inputs_ = {};
  program_ = {};
  shares_ = {};
  share_names_ = {};
}

ImageFault ImageView::open(const std::uint8_t* bytes, std::uint32_t size,
                           ImageWorkspace& workspace) noexcept {
  close();
  const ImageFault fault = read(bytes, size, workspace);
  if (fault != ImageFault::kNone) close();
  return fault;
}

const char* describe(ImageFault fault) noexcept {
  switch (fault) {
    case ImageFault::kNone:
      return "no fault";
    case ImageFault::kMisaligned:
      return "buffer: the image does not begin at a multiple of 8 bytes";
    case ImageFault::kTruncated:
      return "length: the end of the image is missing";
    case ImageFault::kMagic:
      return "magic: the data are not a correction image";
    case ImageFault::kFormatVersion:
      return "format version: the image is compiled for another version";
    case ImageFault::kHeader:
      return "header: sizes or reserved words are wrong";
    case ImageFault::kChecksum:
      return "checksum: bytes of the image have changed";
    case ImageFault::kSection:
      return "section: a section is out of order, misaligned or outside the image";
    case ImageFault::kFingerprint:
      return "fingerprint: the equation is not that of the fingerprint in the header";
    case ImageFault::kAxis:
      return "axis record: the name (also a repeated name), the flags or the range is wrong";
    case ImageFault::kInput:
      return "input record: the name, the unit or the range is wrong";
    case ImageFault::kRange:
      return "table: records of the table are outside their section";
    case ImageFault::kTooMany:
      return "tables: the image has more tables than the memory can contain";
    case ImageFault::kProgramTooLong:
      return "program: the program has more registers, lags, axes or inputs than the memory can contain";
    case ImageFault::kProgramChannel:
      return "program: a channel index, limit, shift or multiplier is out of range";
    case ImageFault::kProgramTable:
      return "program: the stations, reciprocals or grid of a table are inconsistent";
    case ImageFault::kProgramWrap:
      return "program: the period of a rotary axis does not agree with its reciprocal or its range";
    case ImageFault::kProgramOpCode:
      return "program: an operation is unknown";
    case ImageFault::kProgramOperand:
      return "program: an operand is a register that is not yet written";
    case ImageFault::kProgramShift:
      return "program: a shift or factor is out of range";
    case ImageFault::kProgramOverflow:
      return "program: a result can exceed the range of int32";
    case ImageFault::kProgramLag:
      return "program: the state of a lag is used twice or never";
    case ImageFault::kProgramOutput:
      return "program: an output axis, source or limit is out of range";
  }
  return "unknown fault";
}

}  // namespace vernier
