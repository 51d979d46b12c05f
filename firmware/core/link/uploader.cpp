// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/link/uploader.h"

#include <algorithm>
#include <cstring>

#include "comp/fixed.h"
#include "firmware/core/link/read_place.h"

namespace vernier {
namespace {

UploadResult refused(UploadFault fault) {
  UploadResult result;
  result.fault = fault;
  return result;
}

// A store of an earlier version has shorter records.
SlotPlace read_slot_place(SlotStore& store, std::uint32_t number) noexcept {
  const SlotPlace place = read_place<SlotRecord>(store, number);
  if (is_valid(place.record)) return place;
  const StoredPlace<SlotRecordV1> old = read_place<SlotRecordV1>(store, number);
  return old.record.magic == kSlotMagicV1 ? SlotPlace{old.written, upgraded(old.record)} : place;
}

bool names(const char (&board)[kBoardNameBytes], const Name& name) {
  char wanted[kBoardNameBytes] = {};
  std::memcpy(wanted, name.c_str(), name.size());
  return std::memcmp(wanted, board, sizeof(wanted)) == 0;
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

Uploader::Uploader(SlotStore& store, const Wiring& wiring, Exchange& exchange, const Options& options)
    : store_(store),
      wiring_(wiring),
      options_(options),
      programs_(exchange, options.places,
                store.capacity() - lower(store.capacity(), std::uint32_t{sizeof(UploadHeader)}),
                options.dense_cells),
      workspace_(new ImageWorkspace) {
  publish();
}

bool Uploader::write(const SlotChange& change) {
  std::uint8_t bytes[sizeof(SlotRecord)];
  std::memcpy(bytes, &change.record, sizeof(bytes));
  if (store_.write_record(change.place, bytes, sizeof(bytes)) != HalFault::kNone) return false;
  slots_.stored(change);
  return true;
}

// To both places: an older copy of one record is not the newest, or no neighbour of the other. If the medium
// refuses the second one, the change counts, and the next one writes both.
bool Uploader::store(const SlotChange& change) {
  if (!write(change)) return false;
  write(slots_.again());
  if (damaged_) damaged_ = slots_.places() == StoredPair::kDamaged;
  return true;
}

void Uploader::publish() noexcept {
  record_.confirmed = slots_.confirmed();
  record_.trial = slots_.trial();
  record_.issued = slots_.issued();
  record_.newest_issued = slots_.newest_issued();
  record_.security = slots_.security();
  published_.publish(record_);
}

SlotsRecord Uploader::record() const noexcept {
  SlotsRecord record;
  published_.read(record);
  const Trial trial = programs_.trial();
  if (trial == Trial::kNone || trial == Trial::kOver) record.trial = kNoSlot, record.trial_fingerprint = 0;
  return record;
}

TimeUs Uploader::trial_left(TimeUs now) const noexcept {
  return record().trial == kNoSlot ? TimeUs{} : programs_.trial_left(now, options_.trial_time);
}

// An image that the verifier passes may still be more than the board can do in its time.
bool Uploader::within_budget(const ImageView& view) const noexcept {
  return options_.budget.covers(view.program(), view.shares());
}

// A retired key is valid only for images that were confirmed with it before it was retired.
UploadResult Uploader::check_signature(const LoadedProgram& loaded, Origin origin) const {
  const UploadHeader& header = loaded.header;
  if (options_.identity.keys.empty()) return refused(UploadFault::kNoKey);
  const TrustedKey* const key = options_.identity.find(header.key, sizeof(header.key));
  if (key == nullptr) return refused(UploadFault::kForeignKey);
  if (origin == Origin::kNew && (key->retired || !key->upload)) return refused(UploadFault::kKeyMayNot);
  const std::span<const std::uint8_t> image{const_cast<LoadedProgram&>(loaded).image(), header.image_bytes};
  return signature_fits(bytes_of_head(header, kSignedHeaderBytes), image, header.signature, key->key)
             ? UploadResult{}
             : refused(UploadFault::kSignature);
}

UploadResult Uploader::check_image(LoadedProgram& loaded) {
  const UploadHeader& header = loaded.header;
  UploadResult result;
  result.image = loaded.view.open(loaded.image(), header.image_bytes, *workspace_);
  if (result.image != ImageFault::kNone) {
    result.fault = UploadFault::kImage;
    return result;
  }
  if (loaded.view.header().fingerprint != header.fingerprint) return refused(UploadFault::kFingerprint);
  if (!within_budget(loaded.view)) return refused(UploadFault::kTooMuchWork);
  std::destroy_at(&loaded.bound);
  std::construct_at(&loaded.bound, loaded.view, loaded.dense.memory());
  result.bind = bind(loaded.view, wiring_, options_.tick, loaded.bound, result.offender);
  if (result.bind != BindFault::kNone) result.fault = UploadFault::kForeignMachine;
  std::copy_n(loaded.bound.axis, kMaxAxes, loaded.axis);
  return result;
}

// Header and image of a slot, from the medium, checked.
UploadResult Uploader::load(std::uint8_t slot, LoadedProgram& loaded, Origin origin) {
  std::uint8_t bytes[sizeof(UploadHeader)];
  UploadHeader& header = loaded.header;
  if (store_.read_image(slot, 0, bytes, sizeof(bytes)) != HalFault::kNone)
    return refused(UploadFault::kNotAnUpload);
  std::memcpy(&header, bytes, sizeof(header));
  if (std::memcmp(header.magic, kUploadMagicV1, sizeof(kUploadMagicV1)) == 0)
    return origin == Origin::kStored ? load_v1(slot, loaded) : refused(UploadFault::kOldForm);
  if (std::memcmp(header.magic, kUploadMagic, sizeof(kUploadMagic)) != 0 ||
      header.header_bytes != sizeof(UploadHeader) || header.image_bytes > programs_.image_bytes() ||
      store_.read_image(slot, sizeof(UploadHeader), loaded.image(), header.image_bytes) != HalFault::kNone)
    return refused(UploadFault::kNotAnUpload);
  UploadResult result = check_signature(loaded, origin);
  const BoardIdentity& own = options_.identity;
  if (result.fault == UploadFault::kNone && !names(header.board, own.board) &&
      (own.board_class.empty() || !names(header.board, own.board_class)))
    result = refused(UploadFault::kOtherBoard);
  return result.fault == UploadFault::kNone ? check_image(loaded) : result;
}

// An image that was confirmed before boards had names still runs, until another one is uploaded.
UploadResult Uploader::load_v1(std::uint8_t slot, LoadedProgram& loaded) {
  std::uint8_t bytes[sizeof(UploadHeaderV1)];
  UploadHeaderV1 old;
  if (store_.read_image(slot, 0, bytes, sizeof(bytes)) != HalFault::kNone)
    return refused(UploadFault::kNotAnUpload);
  std::memcpy(&old, bytes, sizeof(old));
  if (old.header_bytes != sizeof(old) || old.image_bytes > programs_.image_bytes() ||
      store_.read_image(slot, sizeof(old), loaded.image(), old.image_bytes) != HalFault::kNone)
    return refused(UploadFault::kNotAnUpload);
  const TrustedKey* const key = options_.identity.find(old.key, sizeof(old.key));
  if (key == nullptr) return refused(UploadFault::kForeignKey);
  if (!signature_fits(bytes_of_head(old, kSignedHeaderBytesV1), {loaded.image(), old.image_bytes},
                      old.signature, key->key))
    return refused(UploadFault::kSignature);
  loaded.header = {};
  loaded.header.image_bytes = old.image_bytes;
  loaded.header.issued = old.issued;
  loaded.header.fingerprint = old.fingerprint;
  return check_image(loaded);
}

// A reset ends a trial. If even that cannot be stored, the state on the medium gives the same result next
// time. A damaged pair stays as it is until repair(): a start before that finds the damage again.
void Uploader::read_slots() {
  const SlotPlace first = read_slot_place(store_, 0), second = read_slot_place(store_, 1);
  slots_ = Slots::load(first, second);
  // A power failure may have cut the first record that was ever written; no image was confirmed by then.
  records_lost_ = first.written && second.written && !is_valid(first.record) && !is_valid(second.record);
  if (slots_.places() == StoredPair::kIntact && (slots_.trial() != kNoSlot || slots_.once()))
    store(slots_.revert());
  publish();
}

bool Uploader::repair() {
  if (damaged() && !store(slots_.revert())) return false;
  publish();
  return true;
}

UploadResult Uploader::boot_with(std::span<const std::uint8_t> image) {
  read_slots();
  image_lost_ = true;
  ProgramRef loaded = programs_.take();
  if (loaded == nullptr || image.size() > programs_.image_bytes()) return refused(UploadFault::kTooLarge);
  std::copy(image.begin(), image.end(), loaded->image());
  ImageHeader header{};
  std::memcpy(&header, image.data(), std::min(sizeof(header), image.size()));
  loaded->header = {};
  loaded->header.image_bytes = static_cast<std::uint32_t>(image.size());
  loaded->header.fingerprint = header.fingerprint;
  const UploadResult result = check_image(*loaded);
  if (result.fault != UploadFault::kNone) return result;
  record_.confirmed_fingerprint = header.fingerprint;
  publish();
  programs_.run_confirmed(std::move(loaded));
  image_lost_ = false;
  return result;
}

UploadResult Uploader::boot() {
  read_slots();
  image_lost_ = records_lost_;
  damaged_ = slots_.places() == StoredPair::kDamaged && !records_lost_;
  if (records_lost_) {
    UploadResult lost = refused(UploadFault::kStore);
    lost.offender = "both records";
    return lost;
  }
  if (slots_.confirmed() == kNoSlot) return {};
  image_lost_ = true;
  ProgramRef loaded = programs_.take();
  if (loaded == nullptr) return refused(UploadFault::kStore);
  UploadResult result = load(slots_.confirmed(), *loaded, Origin::kStored);
  // Another image in the slot, also one of this board, is not the one that was confirmed.
  if (result.fault == UploadFault::kNone && loaded->header.issued != slots_.issued()) {
    result = refused(UploadFault::kStore);
    result.offender = "not the image confirmed";
  }
  if (result.fault != UploadFault::kNone) return result;
  record_.confirmed_fingerprint = loaded->header.fingerprint;
  publish();
  programs_.run_confirmed(std::move(loaded));
  image_lost_ = false;
  return result;
}

UploadResult Uploader::begin(std::uint32_t bytes) {
  receiving_ = false;
  coming_ = nullptr;
  if (programs_.trial() != Trial::kNone) return refused(UploadFault::kTrialRuns);
  if (bytes > store_.capacity()) return refused(UploadFault::kTooLarge);
  if (bytes < sizeof(UploadHeader)) return refused(UploadFault::kNotAnUpload);
  if (options_.identity.keys.empty()) return refused(UploadFault::kNoKey);
  coming_ = programs_.take();
  if (coming_ == nullptr) return refused(UploadFault::kStore);
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
  std::uint8_t header[sizeof(UploadHeader)];
  std::memcpy(header, &coming_->header, sizeof(header));
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t at = offset + i;
    (at < sizeof(header) ? header[at] : coming_->image()[at - sizeof(header)]) = bytes[i];
  }
  std::memcpy(&coming_->header, header, sizeof(header));
  last_offset_ = offset;
  received_ = offset + size;
  return {};
}

// Copies received data to the medium, in pieces that a small flash driver accepts.
UploadResult Uploader::write_slot(std::uint8_t slot) {
  constexpr std::uint32_t kPiece = 4096;
  std::uint8_t header[sizeof(UploadHeader)];
  std::memcpy(header, &coming_->header, sizeof(header));
  bool written = store_.write_image(slot, 0, header, sizeof(header)) == HalFault::kNone;
  const std::uint32_t image_bytes = expected_ - static_cast<std::uint32_t>(sizeof(header));
  for (std::uint32_t at = 0; written && at < image_bytes; at += kPiece)
    written = store_.write_image(slot, at + static_cast<std::uint32_t>(sizeof(header)), coming_->image() + at,
                                 lower(kPiece, image_bytes - at)) == HalFault::kNone;
  written = written && store_.finish_image(slot, expected_) == HalFault::kNone;
  return written ? UploadResult{} : refused(UploadFault::kStore);
}

// The limit is the newest image ever tried, not the newest confirmed one: an image that an operator reverted
// does not return by itself.
UploadFault Uploader::judge_history(const UploadHeader& header) const noexcept {
  if (header.security < slots_.security()) return UploadFault::kSecurity;
  if (header.issued > kLatestIssued) return UploadFault::kAbsurdTime;
  return header.issued > slots_.newest_issued() ? UploadFault::kNone : UploadFault::kOlder;
}

UploadResult Uploader::finish() {
  if (!receiving_) return refused(UploadFault::kNoUpload);
  if (received_ != expected_) return refused(UploadFault::kIncomplete);
  receiving_ = false;
  const std::uint8_t slot = slots_.free_slot();
  UploadResult result = write_slot(slot);
  // The data read back from the medium count, not the data received.
  ProgramRef loaded = std::move(coming_);
  if (result.fault == UploadFault::kNone) result = load(slot, *loaded, Origin::kNew);
  if (result.fault != UploadFault::kNone) return result;
  const UploadHeader& header = loaded->header;
  if (sizeof(header) + header.image_bytes != expected_) return refused(UploadFault::kNotAnUpload);
  if (const UploadFault fault = judge_history(header); fault != UploadFault::kNone) return refused(fault);
  if (!store(slots_.start_trial(header.issued, header.security))) return refused(UploadFault::kStore);
  record_.trial_fingerprint = header.fingerprint;
  publish();
  programs_.run_trial(std::move(loaded), options_.trial_time);
  return result;
}

UploadResult Uploader::confirm() {
  if (!programs_.begin_to_keep()) return refused(UploadFault::kNoTrial);
  const bool written = store(slots_.confirm());
  if (written) record_.confirmed_fingerprint = record_.trial_fingerprint;
  if (written) image_lost_ = false;
  publish();
  programs_.kept(written);
  return written ? UploadResult{} : refused(UploadFault::kStore);
}

UploadResult Uploader::revert() {
  return programs_.give_up() ? UploadResult{} : refused(UploadFault::kNoTrial);
}

bool Uploader::look_after_store() {
  if (programs_.trial() != Trial::kOver || !store(slots_.revert())) return false;
  publish();
  programs_.given_up();
  return true;
}

HalFault Uploader::read_confirmed(std::uint32_t offset, std::uint8_t* bytes, std::uint32_t size) noexcept {
  if (slots_.confirmed() == kNoSlot) return HalFault::kNoReading;
  return store_.read_image(slots_.confirmed(), offset, bytes, size);
}

}  // namespace vernier
