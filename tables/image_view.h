// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/verify.h"
#include "tables/image_format.h"

namespace vernier {

/// Reason why an image is refused; each cause has one enumerator.
enum class ImageFault : std::uint8_t {
  kNone = 0,
  kMisaligned = 1,       // the buffer does not start on a multiple of 8
  kTruncated = 2,        // shorter than a header, or than the length in the header
  kMagic = 3,            // no Vernier image
  kFormatVersion = 4,    // another format version
  kHeader = 5,           // header size, image size, section count, tick or reserved words wrong
  kChecksum = 6,         // bytes changed on the way
  kSection = 7,          // a section out of order, misaligned, overlapping or outside
  kFingerprint = 8,      // the equation is not the one that the header names
  kAxis = 9,             // axis record: name (also a repeated name), flags or range
  kInput = 10,           // input record: name (also a repeated name), unit or range
  kRange = 11,           // a table whose records leave their section
  kTooMany = 12,         // more tables than the views have room for
  kProgramTooLong = 13,  // the causes of comp/verify.h, in its order
  kProgramChannel = 14,
  kProgramTable = 15,
  kProgramWrap = 16,
  kProgramOpCode = 17,
  kProgramOperand = 18,
  kProgramShift = 19,
  kProgramOverflow = 20,
  kProgramLag = 21,
  kProgramOutput = 22,
};

/// Returns one line of text for people: "checksum: bytes changed on the way".
const char* describe(ImageFault fault) noexcept;

/// Memory for the verification, outside the stack, because the stack of small targets is small.
struct ImageWorkspace {
  ValueRange ranges[kMaxRegisters];
};

/// Validated, non-owning views into the bytes of an image. The bytes must outlive the view and all objects
/// that refer to the view.
class ImageView {
 public:
  ImageView() = default;
  ImageView(const ImageView&) = delete;
  ImageView& operator=(const ImageView&) = delete;

  /// Validates the whole image, the program included. The views are empty unless open() returns kNone. bytes:
  /// start of the image, aligned to 8, any content; size: bytes available. After kNone, workspace.ranges
  /// contains the proved range of every register. Not real-time safe.
  ImageFault open(const std::uint8_t* bytes, std::uint32_t size, ImageWorkspace& workspace) noexcept;

  const ImageHeader& header() const noexcept { return *header_; }
  const char* name() const noexcept { return name_; }
  View<AxisRecord> axes() const noexcept { return axes_; }
  View<InputRecord> inputs() const noexcept { return inputs_; }
  /// The equation of the contribution of each effect to the correction, for run_shares. share_names: the
  /// names of the effects, in the same order.
  const ShareProgram& shares() const noexcept { return shares_; }
  View<ShareName> share_names() const noexcept { return share_names_; }
  /// Ready for Compensator.
  const Program& program() const noexcept { return program_; }

 private:
  ImageFault read(const std::uint8_t* bytes, std::uint32_t size, ImageWorkspace& workspace) noexcept;
  ImageFault read_sections(const std::uint8_t* bytes) noexcept;
  ImageFault read_shares(const std::uint8_t* bytes) noexcept;
  ImageFault read_tables(View<TableRecord> tables, View<std::int32_t> words) noexcept;
  void count_results(Equation& equation) noexcept;
  void close() noexcept;

  const ImageHeader* header_ = nullptr;
  const char* name_ = "";
  View<AxisRecord> axes_;
  View<InputRecord> inputs_;
  Program program_;
  ShareProgram shares_;
  View<ShareName> share_names_;
  ErrorTable tables_[kMaxTables];
};

}  // namespace vernier
