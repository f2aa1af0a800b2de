// What this process takes of the machine's memory.
#pragma once

#include <cstddef>

namespace fovea {

/// Bytes in physical memory now; 0 where the system does not tell.
std::size_t resident_memory();
/// The largest value since this program started, bytes; 0 where the system does not report it.
std::size_t peak_resident_memory();

/// Has the allocator take so many bytes of addresses in one piece, none of which is written to.
/// Those that it takes one by one as a program grows are at first too small for huge pages, and
/// each 4 kB of them costs a page fault. Nothing happens with an allocator that would give it back.
void reserve_memory(std::size_t bytes);

/// Has the allocator keep so much more memory that has been written to: what is taken of it next
/// costs no page faults, each of which a virtual machine's host may have to serve. Nothing happens
/// with an allocator that would give it back.
void warm_memory(std::size_t bytes);

/// Gives back what the allocator keeps of freed memory. In a long run memory that comes and goes
/// leaves more and more pages of which a part is in use; this returns those that are free.
void release_free_memory();

}  // namespace fovea
