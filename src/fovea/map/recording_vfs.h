// A file system for SQLite that records what is written, so that tests can cut the power at any
// moment and see what a disk may then hold.
#pragma once

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fovea/core/random.h"

namespace fovea {

/// Contents of files by name.
using DiskImage = std::map<std::string, std::vector<char>>;

/// While it lives it is what SQLite writes through; on to the real disk, and into `events`.
class RecordingVfs {
 public:
  struct Event {
    enum Kind { kOpen, kWrite, kTruncate, kSync, kDelete, kMark } kind;
    std::string file;
    std::vector<char> bytes;  // written; of kOpen: what was there
    std::size_t offset = 0;   // or the size after truncation
    bool is_durable = false;  // of kDelete
  };
  std::vector<Event> events;

  RecordingVfs() : real_(sqlite3_vfs_find(nullptr)), vfs_(*real_) {
    vfs_.zName = "recording";
    vfs_.szOsFile = int(sizeof(File)) + real_->szOsFile;
    vfs_.pAppData = this;
    vfs_.xOpen = &open;
    vfs_.xDelete = &remove;
    vfs_.xAccess = [](sqlite3_vfs* v, const char* name, int flags, int* result) {
      return self(v).real_->xAccess(self(v).real_, name, flags, result);
    };
    vfs_.xFullPathname = [](sqlite3_vfs* v, const char* name, int size, char* path) {
      return self(v).real_->xFullPathname(self(v).real_, name, size, path);
    };
    if (sqlite3_vfs_register(&vfs_, /*makeDflt=*/1) != SQLITE_OK) throw std::bad_alloc();
  }
  ~RecordingVfs() {
    sqlite3_vfs_unregister(&vfs_);
    sqlite3_vfs_register(real_, /*makeDflt=*/1);
  }
  RecordingVfs(const RecordingVfs&) = delete;
  RecordingVfs& operator=(const RecordingVfs&) = delete;

  void mark() { events.push_back({Event::kMark, {}, {}}); }

 private:
  struct File {
    sqlite3_file base;
    RecordingVfs* owner;
    const char* name;  // SQLite's, lives as long as the file is open
    sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
    void record(Event::Kind kind, std::size_t offset = 0, std::vector<char> bytes = {}) {
      if (name != nullptr) owner->events.push_back({kind, name, std::move(bytes), offset});
    }
  };
  static RecordingVfs& self(sqlite3_vfs* vfs) { return *static_cast<RecordingVfs*>(vfs->pAppData); }
  static File& file(sqlite3_file* f) { return *reinterpret_cast<File*>(f); }
  static sqlite3_file* real(sqlite3_file* f) { return file(f).real(); }

  static int open(sqlite3_vfs* vfs, const char* name, sqlite3_file* f, int flags, int* out) {
    RecordingVfs& owner = self(vfs);
    File& opened = *new (f) File{{nullptr}, &owner, name};
    const int code = owner.real_->xOpen(owner.real_, name, opened.real(), flags, out);
    if (opened.real()->pMethods == nullptr) return code;
    static const sqlite3_io_methods methods = passing_methods();
    opened.base.pMethods = &methods;
    if (name != nullptr) {
      std::ifstream content(name, std::ios::binary);
      opened.record(Event::kOpen, 0, {std::istreambuf_iterator<char>(content), {}});
    }
    return code;
  }
  static int remove(sqlite3_vfs* vfs, const char* name, int sync_folder) {
    self(vfs).events.push_back({Event::kDelete, name, {}, 0, sync_folder != 0});
    return self(vfs).real_->xDelete(self(vfs).real_, name, sync_folder);
  }

  static sqlite3_io_methods passing_methods() {
    sqlite3_io_methods m{};
    m.iVersion = 2;  // with shared memory, without mapped reads
    m.xClose = [](sqlite3_file* f) { return real(f)->pMethods->xClose(real(f)); };
    m.xRead = [](sqlite3_file* f, void* to, int size, sqlite3_int64 offset) {
      return real(f)->pMethods->xRead(real(f), to, size, offset);
    };
    m.xWrite = [](sqlite3_file* f, const void* from, int size, sqlite3_int64 offset) {
      const char* bytes = static_cast<const char*>(from);
      file(f).record(Event::kWrite, std::size_t(offset), {bytes, bytes + size});
      return real(f)->pMethods->xWrite(real(f), from, size, offset);
    };
    m.xTruncate = [](sqlite3_file* f, sqlite3_int64 size) {
      file(f).record(Event::kTruncate, std::size_t(size));
      return real(f)->pMethods->xTruncate(real(f), size);
    };
    m.xSync = [](sqlite3_file* f, int flags) {
      file(f).record(Event::kSync);
      return real(f)->pMethods->xSync(real(f), flags);
    };
    m.xFileSize = [](sqlite3_file* f, sqlite3_int64* size) {
      return real(f)->pMethods->xFileSize(real(f), size);
    };
    m.xLock = [](sqlite3_file* f, int level) { return real(f)->pMethods->xLock(real(f), level); };
    m.xUnlock = [](sqlite3_file* f, int level) {
      return real(f)->pMethods->xUnlock(real(f), level);
    };
    m.xCheckReservedLock = [](sqlite3_file* f, int* result) {
      return real(f)->pMethods->xCheckReservedLock(real(f), result);
    };
    m.xFileControl = [](sqlite3_file* f, int op, void* argument) {
      return real(f)->pMethods->xFileControl(real(f), op, argument);
    };
    m.xSectorSize = [](sqlite3_file* f) { return real(f)->pMethods->xSectorSize(real(f)); };
    m.xDeviceCharacteristics = [](sqlite3_file* f) {
      return real(f)->pMethods->xDeviceCharacteristics(real(f));
    };
    m.xShmMap = [](sqlite3_file* f, int page, int size, int extend, void volatile** memory) {
      return real(f)->pMethods->xShmMap(real(f), page, size, extend, memory);
    };
    m.xShmLock = [](sqlite3_file* f, int offset, int n, int flags) {
      return real(f)->pMethods->xShmLock(real(f), offset, n, flags);
    };
    m.xShmBarrier = [](sqlite3_file* f) { real(f)->pMethods->xShmBarrier(real(f)); };
    m.xShmUnmap = [](sqlite3_file* f, int remove) {
      return real(f)->pMethods->xShmUnmap(real(f), remove);
    };
    return m;
  }

  sqlite3_vfs* real_;
  sqlite3_vfs vfs_;
};

/// What a disk may hold when the power fails after the first `count` events: what was synced is
/// there; of what was written since, nothing, all, or any part, in any order, the last of it torn.
/// Files that were there when they were first opened are taken for synced.
inline DiskImage power_cut(const std::vector<RecordingVfs::Event>& events, std::size_t count,
                           Random& random) {
  using Event = RecordingVfs::Event;
  DiskImage disk;
  std::map<std::string, std::vector<const Event*>> pending;
  std::map<std::string, bool> known;
  const auto apply = [&](const Event& event, std::size_t bytes) {
    std::vector<char>& file = disk[event.file];
    if (event.kind == Event::kTruncate) {
      file.resize(event.offset);
      return;
    }
    file.resize(std::max(file.size(), event.offset + bytes));
    std::copy_n(event.bytes.begin(), bytes, file.begin() + std::ptrdiff_t(event.offset));
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Event& event = events[i];
    switch (event.kind) {
      case Event::kOpen:
        if (!std::exchange(known[event.file], true) && !event.bytes.empty()) {
          disk[event.file] = event.bytes;
        }
        break;
      case Event::kWrite:
      case Event::kTruncate:
        pending[event.file].push_back(&event);
        break;
      case Event::kSync:
        for (const Event* written : std::exchange(pending[event.file], {})) {
          apply(*written, written->bytes.size());
        }
        break;
      case Event::kDelete:
        pending.erase(event.file);
        if (event.is_durable || random.below(2) == 0) disk.erase(event.file);
        break;
      case Event::kMark:
        break;
    }
  }
  const std::uint64_t mood = random.below(3);  // nothing, all, a part
  for (auto& [file, writes] : pending) {
    if (mood == 0) continue;
    if (mood == 1) {
      for (const Event* written : writes) apply(*written, written->bytes.size());
      continue;
    }
    for (std::size_t i = writes.size(); i > 1; --i) {
      std::swap(writes[i - 1], writes[random.below(i)]);
    }
    for (const Event* written : writes) {
      if (random.below(2) == 0) continue;
      const bool torn = random.below(4) == 0;
      apply(*written, torn ? random.below(written->bytes.size() + 1) : written->bytes.size());
    }
  }
  return disk;
}

}  // namespace fovea
