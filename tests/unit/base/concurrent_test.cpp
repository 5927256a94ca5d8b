#include "drape/base/concurrent.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "drape/base/parallel.hpp"

namespace drape {
namespace {

TEST(RunConcurrently, TakesUpNoTaskWithinAnother) {
  static thread_local bool busy = false;
  std::atomic<int> ended = 0;
  std::atomic<int> nested = 0;
  const auto task = [&] {
    if (busy) ++nested;
    busy = true;
    // Whoever is through with its own chunks waits for the others', and could be given another task
    // meanwhile.
    parallel_for(8, 1, [](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        std::this_thread::sleep_for(std::chrono::microseconds(200 * (1 + i)));
    });
    busy = false;
    ++ended;
  };
  // A waiting thread takes what a third one has left: two are not enough to show it.
  constexpr int threads = 4;
  set_thread_count(threads);
  for (int round = 0; round < 10; ++round)
    tbb::task_arena(threads).execute([&] {
      run_concurrently({task, task, task, task, task, task, task, task, task, task, task, task});
    });
  EXPECT_EQ(ended, 120);
  EXPECT_EQ(nested, 0);
  set_thread_count(0);
}

TEST(RunConcurrently, PassesAnExceptionOn) {
  EXPECT_THROW(run_concurrently({[] {}, [] { throw std::runtime_error("no"); }}), std::runtime_error);
}

}  // namespace
}  // namespace drape
