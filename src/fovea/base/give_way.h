// Threads whose work can wait.
#pragma once

namespace fovea {

/// The calling thread steps back behind others that want the processor, for good; on Linux a thread
/// has a priority of its own. Where that cannot be had, nothing happens.
/// @param nice  1 (gets a fifth less of a busy processor than an equal would) to 19 (next to none)
void give_way(int nice);

}  // namespace fovea
