// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/verify.h"
#include "tables/image_format.h"

namespace vernier {

/// Reason why an image is not valid. Each cause has one enumerator.
enum class ImageFault : std::uint8_t {
  kNone = 0,
  kMisaligned = 1,       // the buffer does not begin at a multiple of 8 bytes
  kTruncated = 2,        // the data are shorter than a header, or than the length in the header
  kMagic = 3,            // the data are not a Vernier image
  kFormatVersion = 4,    // the image has another format version
  kHeader = 5,           // header size, image size, number of sections, tick or reserved words are wrong
  kChecksum = 6,         // bytes of the image have changed
  kSection = 7,          // a section is out of order, misaligned, overlapping or outside the image
  kFingerprint = 8,      // the equation is not the one that the fingerprint in the header identifies
  kAxis = 9,             // an axis record is wrong: name (also a repeated name), flags or range
  kInput = 10,           // an input record is wrong: name (also a repeated name), unit or range
  kRange = 11,           // the records of a table are outside their section
  kTooMany = 12,         // there are more tables than the views can contain
  kProgramTooLong = 13,  // this and the following causes are those of comp/verify.h, in the same order
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

/// Returns the cause as one line of text for people: "checksum: bytes of the image have changed".
const char* describe(ImageFault fault) noexcept;

/// Memory for the verification of an image. The memory for the verification is not on the stack, because the
/// stack of small targets is small.
struct ImageWorkspace {
  ValueRange ranges[kMaxRegisters];
};

/// Validated views of the bytes of an image. The views do not own the bytes. The bytes must exist longer than
/// the view and all objects that use the view.
class ImageView {
 public:
  ImageView() = default;
  ImageView(const ImageView&) = delete;
  ImageView& operator=(const ImageView&) = delete;

  /// Validates the whole image, including its program. If open() does not return kNone, the views are empty.
  /// `bytes`: start of the image, aligned to 8 bytes, with any content; `size`: number of bytes. If the
  /// result is kNone, workspace.ranges contains the proved range of every register. Not real-time safe.
  ImageFault open(const std::uint8_t* bytes, std::uint32_t size, ImageWorkspace& workspace) noexcept;

  const ImageHeader& header() const noexcept { return *header_; }
  const char* name() const noexcept { return name_; }
  View<AxisRecord> axes() const noexcept { return axes_; }
  View<InputRecord> inputs() const noexcept { return inputs_; }
  /// Returns the equation for the contribution of each effect to the correction, which run_shares uses.
  /// share_names() returns the names of the effects, in the order of the shares.
  const ShareProgram& shares() const noexcept { return shares_; }
  View<ShareName> share_names() const noexcept { return share_names_; }
  /// Returns the program in the form that Compensator uses.
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
