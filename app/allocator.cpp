// How the program gets its memory: from jemalloc, in huge pages where the kernel lends them to
// those who ask (docs/performance.md, "Memory"). A map of half a gigabyte is 130,000 pages of 4 kB,
// each of which costs a fault when it is first written.

/// jemalloc reads its settings here when the program starts (jemalloc(3), "TUNING"); MALLOC_CONF in
/// the environment overrides them. One arena for blocks of any size, so that what one thread
/// frees serves all, cut as it is needed; blocks up to 64 kB stay with their thread; what is freed
/// is kept until the map's keeper gives it back.
extern "C" {
__attribute__((visibility("default"))) const char* malloc_conf =
    "thp:always,metadata_thp:auto,narenas:1,oversize_threshold:0,lg_extent_max_active_fit:16,"
    "lg_tcache_max:16,dirty_decay_ms:-1,muzzy_decay_ms:-1";
}
