// Peak memory of a part of the process's life.
#pragma once

namespace drape::pipeline {

/// Starts a new maximum (Linux: writes 5 to /proc/self/clear_refs). Where that is not allowed, the maximum
/// goes on.
void reset_peak_memory();
/// Most resident memory since then, in megabytes (10^6 bytes); 0 if the system does not tell.
[[nodiscard]] double peak_memory_mb();

}  // namespace drape::pipeline
