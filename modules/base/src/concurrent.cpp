#include "drape/base/concurrent.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace drape {

void run_concurrently(std::initializer_list<std::function<void()>> tasks) {
  tbb::parallel_for(std::size_t{0}, tasks.size(),
                    [&](std::size_t i) { tbb::this_task_arena::isolate(*(tasks.begin() + i)); });
}

}  // namespace drape
