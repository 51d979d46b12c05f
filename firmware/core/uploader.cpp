// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/uploader.h"

#include <algorithm>
#include <cstring>

#include "comp/fixed.h"

namespace vernier {
namespace {

UploadResult refused(UploadFault fault) {
  UploadResult result;
  result.fault = fault;
  return result;
}

SlotRecord read_record(SlotStore& store, std::uint32_t place) {
  SlotRecord record{};
  std::uint8_t bytes[sizeof(SlotRecord)];
  if (store.read_record(place, bytes, sizeof(bytes)) == HalFault::kNone)
    std::memcpy(&record, bytes, sizeof(record));
  return record;
}

void append(Line& line, const char* text) noexcept {
  std::size_t at = 0;
  while (line.text[at] != 0) ++at;
  while (*text != 0 && at + 1 < sizeof(line.text)) line.text[at++] = *text++;
}

}  // namespace

Line describe(const UploadResult& result) noexcept {
  Line line;
  const auto add = [&line](const char* text) {
    if (line.text[0] != 0) append(line, ": ");
    append(line, text);
  };
  add(describe(result.fault));
  if (result.fault == UploadFault::kImage) add(describe(result.image));
  if (result.fault == UploadFault::kForeignMachine) add(describe(result.bind));
  if (!result.offender.empty()) add(result.offender.c_str());
  return line;
}

ProgramPool::ProgramPool(std::uint32_t places, std::uint32_t image_bytes)
    : places_(places), image_bytes_(image_bytes), programs_(new LoadedProgram[places]) {
  for (std::uint32_t i = 0; i < places_; ++i)
    programs_[i].words.reset(new std::uint64_t[(image_bytes + 7) / 8]);
}

ProgramRef ProgramPool::take() noexcept {
  for (std::uint32_t i = 0; i < places_; ++i) {
    LoadedProgram& program = programs_[i];
    if (program.taken) continue;
    program.taken = true;
    return ProgramRef(&program);
  }
  return nullptr;
}

Uploader::Uploader(SlotStore& store, const Wiring& wiring, const Options& options)
    : store_(store),
      wiring_(wiring),
      options_(options),
      pool_(options.places, store.capacity() - lower(store.capacity(), std::uint32_t{sizeof(UploadHeader)})),
      workspace_(new ImageWorkspace) {}

bool Uploader::store(const SlotChange& change) {
  std::uint8_t bytes[sizeof(SlotRecord)];
  std::memcpy(bytes, &change.record, sizeof(bytes));
  if (store_.write_record(change.place, bytes, sizeof(bytes)) != HalFault::kNone) return false;
  slots_.stored(change);
  return true;
}

UploadResult Uploader::check(const UploadHeader& header, LoadedProgram& loaded) {
  if (!options_.key) return refused(UploadFault::kNoKey);
  if (std::memcmp(header.key, options_.key->data(), sizeof(header.key)) != 0)
    return refused(UploadFault::kForeignKey);
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(loaded.words.get());
  if (!signature_fits(header, {bytes, header.image_bytes}, *options_.key))
    return refused(UploadFault::kSignature);
  UploadResult result;
  result.image = loaded.view.open(bytes, header.image_bytes, *workspace_);
  if (result.image != ImageFault::kNone) {
    result.fault = UploadFault::kImage;
    return result;
  }
  if (loaded.view.header().fingerprint != header.fingerprint) return refused(UploadFault::kFingerprint);
  std::destroy_at(&loaded.bound);
  std::construct_at(&loaded.bound, loaded.view);
  result.bind = bind(loaded.view, wiring_, options_.tick, loaded.bound, result.offender);
  if (result.bind != BindFault::kNone) result.fault = UploadFault::kForeignMachine;
  loaded.issued = header.issued;
  loaded.fingerprint = header.fingerprint;
  return result;
}

// Header and image of a slot, from the medium, checked.
UploadResult Uploader::load(std::uint8_t slot, LoadedProgram& loaded, UploadHeader& header) {
  std::uint8_t bytes[sizeof(UploadHeader)];
  if (store_.read_image(slot, 0, bytes, sizeof(bytes)) != HalFault::kNone)
    return refused(UploadFault::kNotAnUpload);
  std::memcpy(&header, bytes, sizeof(header));
  if (std::memcmp(header.magic, kUploadMagic, sizeof(kUploadMagic)) != 0 ||
      header.header_bytes != sizeof(UploadHeader) || header.image_bytes > pool_.image_bytes() ||
      store_.read_image(slot, sizeof(UploadHeader), reinterpret_cast<std::uint8_t*>(loaded.words.get()),
                        header.image_bytes) != HalFault::kNone)
    return refused(UploadFault::kNotAnUpload);
  return check(header, loaded);
}

UploadResult Uploader::boot() {
  slots_ = Slots::load(read_record(store_, 0), read_record(store_, 1));
  // A reset ends a trial. Where even that cannot be stored, the state on the medium says the same next time.
  if (slots_.trial() != kNoSlot) store(slots_.revert());
  if (slots_.confirmed() == kNoSlot) return {};
  ProgramRef loaded = pool_.take();
  if (loaded == nullptr) return refused(UploadFault::kStore);
  UploadHeader header;
  const UploadResult result = load(slots_.confirmed(), *loaded, header);
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
  ProgramRef loaded = pool_.take();
  if (loaded == nullptr) return refused(UploadFault::kStore);
  UploadHeader header;
  const UploadResult result = load(slot, *loaded, header);
  if (result.fault != UploadFault::kNone) return result;
  if (sizeof(header) + header.image_bytes != expected_) return refused(UploadFault::kNotAnUpload);
  if (!may_replace(header)) return refused(UploadFault::kOlder);
  if (!store(slots_.start_trial(header.issued))) return refused(UploadFault::kStore);
  trial_began_ = now;
  given_up_ = owed_ = false;
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
  // What was not taken over yet is not wanted any more: its place is the one that is needed.
  next_ = nullptr;
  ProgramRef loaded = pool_.take();
  owed_ = loaded == nullptr;
  if (owed_) return;
  UploadHeader header;
  if (slots_.confirmed() == kNoSlot ||
      load(slots_.confirmed(), *loaded, header).fault != UploadFault::kNone) {
    std::destroy_at(&loaded->bound);
    std::construct_at(&loaded->bound);
    loaded->fingerprint = loaded->issued = 0;
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
  if (owed_) offer_confirmed();
  if (slots_.trial() == kNoSlot || given_up_ || trial_left(now) > TimeUs{}) return false;
  return revert().fault == UploadFault::kNone;
}

HalFault Uploader::read_confirmed(std::uint32_t offset, std::uint8_t* bytes, std::uint32_t size) noexcept {
  if (slots_.confirmed() == kNoSlot) return HalFault::kNoReading;
  return store_.read_image(slots_.confirmed(), offset, bytes, size);
}

}  // namespace vernier
