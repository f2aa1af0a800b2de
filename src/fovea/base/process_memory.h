// What this process takes of the machine's memory.
#pragma once

#include <cstddef>

namespace fovea {

/// Bytes in physical memory now; 0 where the system does not tell.
std::size_t resident_memory();
/// The most that it ever had there, bytes.
std::size_t peak_resident_memory();

/// Gives back what the allocator keeps of freed memory. In a long run memory that comes and goes
/// leaves more and more pages of which a part is in use; this returns those that are free.
void release_free_memory();

}  // namespace fovea
