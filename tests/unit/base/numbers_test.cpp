#include "drape/base/numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "drape/base/parallel.hpp"
#include "drape/base/random.hpp"

namespace drape {
namespace {

TEST(Numbers, ParseTheWholeTextOrNothing) {
  EXPECT_EQ(parse_double("+1.5e3"), 1500.0);
  EXPECT_EQ(parse_double("-.5"), -0.5);
  EXPECT_FALSE(parse_double("1.5x"));
  EXPECT_FALSE(parse_double(""));
  EXPECT_FALSE(parse_double("+-1"));
  EXPECT_FALSE(parse_double("1,5"));
  EXPECT_EQ(parse_integer("-12"), -12);
  EXPECT_FALSE(parse_integer("12.0"));
}

TEST(Numbers, FormattedReadsBackAsTheSame) {
  Rng rng(7);
  for (int i = 0; i < 1000; ++i) {
    const double value = rng.normal() * std::exp(rng.normal() * 20);
    EXPECT_EQ(parse_double(format_number(value)), value);
  }
  EXPECT_EQ(format_number(0.1), "0.1");
}

TEST(Rng, UniformAndNormalHaveTheirMoments) {
  Rng rng(42);
  double sum = 0, squares = 0, mean = 0;
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i) {
    const double n = rng.normal();
    sum += n;
    squares += n * n;
    mean += rng.uniform();
  }
  EXPECT_NEAR(sum / count, 0, 5 / std::sqrt(count));
  EXPECT_NEAR(squares / count, 1, 5 * std::sqrt(2.0 / count));
  EXPECT_NEAR(mean / count, 0.5, 5 / std::sqrt(12.0 * count));
}

TEST(Parallel, SameSumsForAnyThreadCount) {
  const auto run = [] {
    std::vector<double> partial(100);
    parallel_for(9950, 100, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += std::sin(static_cast<double>(i));
      partial[begin / 100] = sum;
    });
    double total = 0;
    for (const double p : partial) total += p;
    return total;
  };
  set_thread_count(1);
  const double one = run();
  set_thread_count(4);
  EXPECT_EQ(run(), one);
  set_thread_count(0);
  EXPECT_EQ(run(), one);
}

TEST(Parallel, ExceptionsComeThrough) {
  EXPECT_THROW(parallel_for(10, 1,
                            [](std::size_t i, std::size_t) {
                              if (i == 7) throw std::runtime_error("seven");
                            }),
               std::runtime_error);
}

}  // namespace
}  // namespace drape
