// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/registry/database.h"

namespace vernier::fleet {

/// A sample of a machine that waits to be stored in the registry. The payload of a record is the result of
/// encode().
struct SpoolRecord {
  std::uint64_t number = 0;  // number of the record in this spool: 1, 2, 3 …
  std::string machine;
  std::uint64_t time_ms = 0;
  std::string payload;
};

/// A file with the data that a gateway has read and that no registry has confirmed yet. The spool file has a
/// limited size, survives a power failure, and numbers its records. A record is removed from the spool after
/// the registry has stored it. If the file is full, a record is also removed, and the removal is counted.
class Spool {
 public:
  /// `owner`: name of the gateway. If the file belongs to another gateway (a copied medium), the spool gets a
  /// new id. `most`: largest number of records. Throws InputError if the file cannot be opened or created.
  Spool(const std::string& file, const std::string& owner, std::uint64_t most);

  /// Returns the unique id of this spool. A new file gets a new id. A record number together with the id of
  /// the spool therefore always has only one meaning.
  const std::string& id() const { return id_; }
  /// Writes records with their numbers, and removes the records up to stored(), in one transaction. Throws
  /// DatabaseError if the file cannot be written.
  void take(std::vector<SpoolRecord>& records);
  /// Returns the records after `number` in their order, at most `most`. Damaged records are moved to another
  /// file (set_aside()).
  std::vector<SpoolRecord> after(std::uint64_t number, std::size_t most);
  /// Moves records that cannot be read to the file aside(), so that they do not stop later records. Throws
  /// InputError if the file aside() cannot be written. If the file aside() cannot be written, the damaged
  /// records stay in the spool. Throws DatabaseError if the spool itself cannot be written.
  void set_aside(const std::vector<std::uint64_t>& numbers);
  /// count_aside() returns the number of records that were moved since the spool was opened. aside() returns
  /// their file (one JSON object per line, with the original cells).
  std::uint64_t count_aside() const { return count_aside_; }
  const std::string& aside() const { return aside_; }
  /// Records that the registry has stored all records up to `number`.
  void stored(std::uint64_t number);
  std::uint64_t stored() const { return stored_; }
  /// last() returns the number of the last record. dropped() returns the number of records that were removed
  /// before they were sent, because the spool was full.
  std::uint64_t last() const { return last_; }
  std::uint64_t dropped() const { return dropped_; }
  /// Returns the number of the last record that the spool no longer contains.
  std::uint64_t gone() const { return gone_; }
  /// Call begin_anew() if the registry has numbers that this spool never gave. If the registry has numbers
  /// that this spool never gave, the spool file is an older, restored file. After begin_anew(), the records
  /// get new numbers under a new spool id.
  void begin_anew();
  /// Returns the number of the next birth. The number of the birth message increases by one at each call
  /// (bdSeq of Sparkplug, 0..255).
  std::uint64_t next_birth();

 private:
  /// Lock of a file beside the spool (flock(2)). Other processes may still read the spool.
  class Lock {
   public:
    /// Throws InputError if another process, or this process, already has the lock.
    explicit Lock(const std::string& file);
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

   private:
    int fd_;
  };

  Lock lock_;
  std::unique_ptr<registry::Database> database_;
  std::string id_, aside_;
  std::uint64_t most_, last_ = 0, stored_ = 0, gone_ = 0, dropped_ = 0, count_aside_ = 0;
};

}  // namespace vernier::fleet
