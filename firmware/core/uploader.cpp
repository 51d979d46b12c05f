// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/uploader.h"

#include <algorithm>
#include <cstring>

namespace vernier {
namespace {

UploadResult refused(UploadFault fault) { return UploadResult{.fault = fault, .offender = {}}; }

SlotRecord read_record(SlotStore& store, std::uint32_t place) {
  SlotRecord record{};
  std::uint8_t bytes[sizeof(SlotRecord)];
  if (store.read_record(place, bytes, sizeof(bytes)) == HalFault::kNone)
    std::memcpy(&record, bytes, sizeof(record));
  return record;
}

// Header and image of a slot; empty where they are not there or their sizes make no sense.
std::vector<std::uint8_t> read_upload(SlotStore& store, std::uint32_t slot) {
  std::vector<std::uint8_t> bytes(sizeof(UploadHeader));
  if (store.read_image(slot, 0, bytes.data(), sizeof(UploadHeader)) != HalFault::kNone) return {};
  UploadHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (header.image_bytes > store.capacity() - sizeof(UploadHeader)) return {};
  bytes.resize(sizeof(UploadHeader) + header.image_bytes);
  const HalFault fault =
      store.read_image(slot, sizeof(UploadHeader), bytes.data() + sizeof(UploadHeader), header.image_bytes);
  return fault == HalFault::kNone ? bytes : std::vector<std::uint8_t>{};
}

}  // namespace

std::string describe(const UploadResult& result) {
  std::string text = describe(result.fault);
  if (result.fault == UploadFault::kImage) text += std::string(": ") + describe(result.image);
  if (result.fault == UploadFault::kForeignMachine) text += std::string(": ") + describe(result.bind);
  if (!result.offender.empty()) text += ": " + result.offender;
  return text;
}

Uploader::Uploader(SlotStore& store, const Wiring& wiring, const Options& options)
    : store_(store), wiring_(wiring), options_(options) {}

bool Uploader::store(const SlotChange& change) {
  std::uint8_t bytes[sizeof(SlotRecord)];
  std::memcpy(bytes, &change.record, sizeof(bytes));
  if (store_.write_record(change.place, bytes, sizeof(bytes)) != HalFault::kNone) return false;
  slots_.stored(change);
  return true;
}

UploadResult Uploader::check(const std::vector<std::uint8_t>& upload, LoadedProgram& loaded) const {
  if (upload.size() < sizeof(UploadHeader)) return refused(UploadFault::kNotAnUpload);
  UploadHeader header;
  std::memcpy(&header, upload.data(), sizeof(header));
  if (std::memcmp(header.magic, kUploadMagic, sizeof(kUploadMagic)) != 0 ||
      header.header_bytes != sizeof(UploadHeader) ||
      header.image_bytes != upload.size() - sizeof(UploadHeader))
    return refused(UploadFault::kNotAnUpload);
  if (!options_.key) return refused(UploadFault::kNoKey);
  if (std::memcmp(header.key, options_.key->data(), sizeof(header.key)) != 0)
    return refused(UploadFault::kForeignKey);
  if (!signature_fits(upload, *options_.key)) return refused(UploadFault::kSignature);
  UploadResult result;
  result.image = loaded.image.open({upload.begin() + sizeof(UploadHeader), upload.end()});
  if (result.image != ImageFault::kNone) {
    result.fault = UploadFault::kImage;
    return result;
  }
  const ImageView& view = loaded.image.view();
  if (view.header().fingerprint != header.fingerprint) return refused(UploadFault::kFingerprint);
  loaded.bound = std::make_unique<BoundProgram>(view);
  result.bind = bind(view, wiring_, options_.tick, *loaded.bound, result.offender);
  if (result.bind != BindFault::kNone) result.fault = UploadFault::kForeignMachine;
  loaded.issued = header.issued;
  loaded.fingerprint = header.fingerprint;
  return result;
}

UploadResult Uploader::load(std::uint8_t slot, LoadedProgram& loaded) {
  return check(read_upload(store_, slot), loaded);
}

UploadResult Uploader::boot() {
  slots_ = Slots::load(read_record(store_, 0), read_record(store_, 1));
  // A reset ends a trial. Where even that cannot be stored, the state on the medium says the same next time.
  if (slots_.trial() != kNoSlot) store(slots_.revert());
  if (slots_.confirmed() == kNoSlot) return {};
  auto loaded = std::make_unique<LoadedProgram>();
  const UploadResult result = load(slots_.confirmed(), *loaded);
  if (result.fault != UploadFault::kNone) return result;
  confirmed_fingerprint_ = loaded->fingerprint;
  next_ = std::move(loaded);
  return result;
}

UploadResult Uploader::begin(std::uint32_t bytes) {
  receiving_ = false;
  if (slots_.trial() != kNoSlot) return refused(UploadFault::kTrialRuns);
  if (bytes > store_.capacity()) return refused(UploadFault::kTooLarge);
  if (bytes < sizeof(UploadHeader)) return refused(UploadFault::kNotAnUpload);
  if (!options_.key) return refused(UploadFault::kNoKey);
  receiving_ = true;
  expected_ = bytes;
  received_ = last_offset_ = 0;
  return {};
}

UploadResult Uploader::add(std::uint32_t offset, const std::uint8_t* bytes, std::uint32_t size) {
  if (!receiving_) return refused(UploadFault::kNoUpload);
  // A peer whose answer was lost sends the same piece again.
  const bool again = offset == last_offset_ && offset + std::uint64_t{size} == received_;
  if (!again && offset != received_) return refused(UploadFault::kOutOfOrder);
  if (size == 0 || offset + std::uint64_t{size} > expected_) return refused(UploadFault::kTooLarge);
  if (store_.write_image(slots_.free_slot(), offset, bytes, size) != HalFault::kNone) {
    receiving_ = false;
    return refused(UploadFault::kStore);
  }
  last_offset_ = offset;
  received_ = offset + size;
  return {};
}

bool Uploader::may_replace(const UploadHeader& header) const noexcept {
  if (slots_.confirmed() == kNoSlot || header.issued > slots_.issued()) return true;
  return header.replaces != 0 && header.replaces == slots_.issued();
}

UploadResult Uploader::finish(TimeUs now) {
  if (!receiving_) return refused(UploadFault::kNoUpload);
  if (received_ != expected_) return refused(UploadFault::kIncomplete);
  receiving_ = false;
  const std::uint8_t slot = slots_.free_slot();
  if (store_.finish_image(slot, expected_) != HalFault::kNone) return refused(UploadFault::kStore);
  // What counts is what the medium gives back, not what came over the wire.
  auto loaded = std::make_unique<LoadedProgram>();
  const std::vector<std::uint8_t> upload = read_upload(store_, slot);
  const UploadResult result = check(upload, *loaded);
  if (result.fault != UploadFault::kNone) return result;
  UploadHeader header;
  std::memcpy(&header, upload.data(), sizeof(header));
  if (upload.size() != expected_) return refused(UploadFault::kNotAnUpload);
  if (!may_replace(header)) return refused(UploadFault::kOlder);
  if (!store(slots_.start_trial(header.issued))) return refused(UploadFault::kStore);
  trial_began_ = now;
  given_up_ = false;
  trial_fingerprint_ = loaded->fingerprint;
  next_ = std::move(loaded);
  return result;
}

UploadResult Uploader::confirm() {
  if (slots_.trial() == kNoSlot || given_up_) return refused(UploadFault::kNoTrial);
  if (!store(slots_.confirm())) return refused(UploadFault::kStore);
  confirmed_fingerprint_ = trial_fingerprint_;
  trial_fingerprint_ = 0;
  return {};
}

void Uploader::offer_confirmed() {
  auto loaded = std::make_unique<LoadedProgram>();
  if (slots_.confirmed() == kNoSlot || load(slots_.confirmed(), *loaded).fault != UploadFault::kNone) {
    loaded = std::make_unique<LoadedProgram>();
    loaded->bound = std::make_unique<BoundProgram>();
  }
  next_ = std::move(loaded);
}

UploadResult Uploader::revert() {
  if (slots_.trial() == kNoSlot) return refused(UploadFault::kNoTrial);
  // The confirmed image runs again even where the medium cannot store that: the next boot reverts too.
  if (!given_up_) offer_confirmed();
  given_up_ = true;
  trial_fingerprint_ = 0;
  return store(slots_.revert()) ? UploadResult{} : refused(UploadFault::kStore);
}

TimeUs Uploader::trial_left(TimeUs now) const noexcept {
  if (slots_.trial() == kNoSlot) return TimeUs{};
  const TimeUs left = trial_began_ + options_.trial_time - now;
  return std::max(left, TimeUs{});
}

bool Uploader::poll(TimeUs now) {
  if (slots_.trial() == kNoSlot || given_up_ || trial_left(now) > TimeUs{}) return false;
  return revert().fault == UploadFault::kNone;
}

HalFault Uploader::read_confirmed(std::uint32_t offset, std::uint8_t* bytes, std::uint32_t size) noexcept {
  if (slots_.confirmed() == kNoSlot) return HalFault::kNoReading;
  return store_.read_image(slots_.confirmed(), offset, bytes, size);
}

}  // namespace vernier
