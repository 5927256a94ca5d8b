// A few long tasks at a time.
#pragma once

#include <functional>
#include <initializer_list>

namespace drape {

/// Runs the tasks on several threads. None of them is ever taken up by a thread that waits within another:
/// OpenCV's random numbers are a state of the thread, which two tasks in one thread would spoil for each
/// other. An exception from a task is rethrown here.
void run_concurrently(std::initializer_list<std::function<void()>> tasks);

}  // namespace drape
