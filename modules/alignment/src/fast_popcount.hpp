// Before a function that counts bits in its inner loop: it is compiled for both kinds of machine, and picked
// at start.
#pragma once

// The compilers' baseline for x86-64 has no popcount instruction; both versions count the same.
#if defined(__x86_64__) && defined(__gnu_linux__)
#define DRAPE_FAST_POPCOUNT __attribute__((target_clones("popcnt", "default")))
#else
#define DRAPE_FAST_POPCOUNT
#endif
