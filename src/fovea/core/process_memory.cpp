#include "fovea/core/process_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

/// jemalloc's, in programs that are linked with it (jemalloc(3)).
extern "C" [[gnu::weak]] int mallctl(const char* name, void* old_value, std::size_t* old_size,
                                     void* new_value, std::size_t new_size);

namespace fovea {
namespace {

/// Of the limit of addresses: a reservation must leave the rest for memory of other sizes.
constexpr std::size_t kMaxShare = 8;

}  // namespace

std::size_t resident_memory() {
  std::ifstream statm("/proc/self/statm");
  std::size_t pages = 0, resident_pages = 0;
  statm >> pages >> resident_pages;
  return resident_pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

std::size_t peak_resident_memory() {
  // getrusage() reports the parent's peak instead, if that is larger: exec() keeps it.
  std::ifstream status("/proc/self/status");
  std::size_t kilobytes = 0;
  for (std::string word; status >> word;) {
    if (word == "VmHWM:") {
      status >> kilobytes;
      break;
    }
  }
  return kilobytes * 1024;
}

void reserve_memory(std::size_t bytes) {
  if (mallctl == nullptr) return;
  rlimit limit{};
  const bool limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur / kMaxShare < bytes;
  if (limited) return;
  void* volatile memory = std::malloc(bytes);  // volatile: the compiler must not leave both out
  std::free(memory);
}

void warm_memory(std::size_t bytes) {
  if (mallctl == nullptr) return;
  const std::unique_ptr<std::byte[]> memory(new (std::nothrow) std::byte[bytes]);
  if (memory == nullptr) return;  // then it will not be had later, either
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  volatile std::byte* write = memory.get();  // which the compiler must not leave out
  for (std::size_t i = 0; i < bytes; i += page) write[i] = std::byte{1};
}

void release_free_memory() {
  if (mallctl != nullptr) {
    mallctl("thread.tcache.flush", nullptr, nullptr, nullptr, 0);
    mallctl("arena.4096.purge", nullptr, nullptr, nullptr, 0);  // of all arenas
    return;
  }
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace fovea
