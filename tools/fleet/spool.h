// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/registry/database.h"

namespace vernier::fleet {

/// A sample of a machine that waits to be stored; payload as encode() made it.
struct SpoolRecord {
  std::uint64_t number = 0;  // 1, 2, 3 … in this spool
  std::string machine;
  std::uint64_t time_ms = 0;
  std::string payload;
};

/// A file with the data that a gateway has read and no registry has confirmed yet: bounded, durable,
/// numbered. A record leaves the spool when the registry has stored it. A record is also removed, and
/// counted, when the file is full.
class Spool {
 public:
  /// owner: the gateway; the file of another gateway (a copied medium) gets a new id. most: number of records
  /// that fit. Throws InputError if the file cannot be opened or created.
  Spool(const std::string& file, const std::string& owner, std::uint64_t most);

  /// Returns the unique id of this spool. A new file gets a new id, so that a number never has two meanings.
  const std::string& id() const { return id_; }
  /// Writes records with numbers, and removes the records up to stored(), in one transaction. Throws
  /// DatabaseError.
  void take(std::vector<SpoolRecord>& records);
  /// The records after `number`, at most `most`, in order. Damaged records are set aside (set_aside()).
  std::vector<SpoolRecord> after(std::uint64_t number, std::size_t most);
  /// Moves records that cannot be read to the file aside(), so that they do not stop later records. Throws
  /// InputError if that file cannot be written; the records then stay. Throws DatabaseError.
  void set_aside(const std::vector<std::uint64_t>& numbers);
  /// Returns the number of records that were set aside since the spool was opened, and their file (one JSON
  /// object a line, with the cells as they were).
  std::uint64_t count_aside() const { return count_aside_; }
  const std::string& aside() const { return aside_; }
  /// The registry has all records up to this number.
  void stored(std::uint64_t number);
  std::uint64_t stored() const { return stored_; }
  /// The last number of a record; the number of records that were discarded before sending, because the spool
  /// was full.
  std::uint64_t last() const { return last_; }
  std::uint64_t dropped() const { return dropped_; }
  /// The last number of a record that the spool no longer contains.
  std::uint64_t gone() const { return gone_; }
  /// Call begin_anew if the registry has numbers that this spool never gave: the file is an older, restored
  /// file. The records then get new numbers under a new id.
  void begin_anew();
  /// Returns the number of the next birth; increases by one at each call (Sparkplug's bdSeq, 0..255).
  std::uint64_t next_birth();

 private:
  /// Lock of a file beside the spool (flock(2)): other processes may still read the spool.
  class Lock {
   public:
    /// Throws InputError if another process, or this process, has the lock.
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
