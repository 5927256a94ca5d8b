// Threads, with results that do not depend on their number.
#pragma once

#include <cstddef>
#include <functional>

namespace drape {

/// The most threads that parallel_for and the libraries on TBB use. 0: one per core (the default).
void set_thread_count(int threads);

/// Calls body(begin, end) for consecutive chunks of [0, count) of `chunk` items each (the last may be
/// shorter), on several threads. The chunks depend on `chunk` alone, never on the number of threads: keep one
/// partial result per chunk and combine them in order, and the outcome is the same bytes for any thread
/// count. An exception from body is rethrown here. chunk > 0.
void parallel_for(std::size_t count, std::size_t chunk,
                  const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace drape
