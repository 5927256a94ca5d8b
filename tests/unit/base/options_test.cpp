#include "drape/base/options.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace drape {
namespace {

enum class Fruit { apple, pear };

struct Sample {
  bool ripe = false;
  int count = 3;
  double weight_kg = 0.5;
  std::optional<double> price;
  std::string name = "basket";
  Fruit fruit = Fruit::apple;
  std::vector<double> box_px = {1, 2};
};

void describe(Binder& b, Sample& s) {
  b.flag("ripe", s.ripe, "whether it is ripe");
  b.number("count", s.count, {0, 10}, "how many");
  b.number("weight_kg", s.weight_kg, {0, 5}, "how heavy");
  b.number("price", s.price, {0, 100}, "what it costs; auto: free");
  b.text("name", s.name, "what it is called");
  b.choice("fruit", s.fruit, {{"apple", Fruit::apple}, {"pear", Fruit::pear}}, "which");
  b.numbers("box_px", s.box_px, 2, {0, 9}, "where");
}

const Option& find(const std::vector<Option>& options, const std::string& name) {
  for (const Option& option : options)
    if (option.name == name) return option;
  throw std::out_of_range(name);
}

std::string assign(Sample& sample, const std::string& name, const std::string& text) {
  const auto options = options_of(sample);
  const Option& option = find(options, name);
  const auto value = parse_option(option, text);
  if (std::holds_alternative<std::string>(value)) return std::get<std::string>(value);
  option.assign(std::get<OptionValue>(value));
  return "ok";
}

TEST(Options, EveryKindIsAssigned) {
  Sample s;
  EXPECT_EQ(assign(s, "ripe", "true"), "ok");
  EXPECT_EQ(assign(s, "count", "7"), "ok");
  EXPECT_EQ(assign(s, "weight_kg", "1.25"), "ok");
  EXPECT_EQ(assign(s, "price", "12"), "ok");
  EXPECT_EQ(assign(s, "name", "crate"), "ok");
  EXPECT_EQ(assign(s, "fruit", "pear"), "ok");
  EXPECT_TRUE(s.ripe);
  EXPECT_EQ(s.count, 7);
  EXPECT_EQ(s.weight_kg, 1.25);
  EXPECT_EQ(s.price, 12.0);
  EXPECT_EQ(s.name, "crate");
  EXPECT_EQ(s.fruit, Fruit::pear);
  EXPECT_EQ(assign(s, "price", "auto"), "ok");
  EXPECT_FALSE(s.price.has_value());
}

TEST(Options, WrongValuesAreExplained) {
  Sample s;
  EXPECT_EQ(assign(s, "ripe", "yes"), "is 'yes'; must be true or false");
  EXPECT_EQ(assign(s, "count", "11"), "is 11; must be within 0 and 10");
  EXPECT_EQ(assign(s, "count", "2.5"), "is 2.5; must be a whole number");
  EXPECT_EQ(assign(s, "count", "auto"), "is 'auto'; must be a number");
  EXPECT_EQ(assign(s, "weight_kg", "nan"), "is 'nan'; must be a number");
  EXPECT_EQ(assign(s, "weight_kg", "1,5"), "is '1,5'; must be a number");
  EXPECT_EQ(assign(s, "fruit", "paer"), "is 'paer'; must be one of apple, pear; did you mean pear?");
}

TEST(Options, Lists) {
  Sample s;
  const auto options = options_of(s);
  const Option& box = find(options, "box_px");
  EXPECT_EQ(std::get<std::string>(parse_option(box, std::vector<std::string>{"1"})),
            "has 1 values; must have 2");
  EXPECT_EQ(std::get<std::string>(parse_option(box, std::vector<std::string>{"1", "10"})),
            "is 10; must be within 0 and 9");
  box.assign(std::get<OptionValue>(parse_option(box, std::vector<std::string>{"3", "4.5"})));
  EXPECT_EQ(s.box_px, (std::vector<double>{3, 4.5}));
  EXPECT_EQ(readable(box.get()), "[3, 4.5]");
}

TEST(Options, CanonicalTextTellsValuesApart) {
  Sample s;
  const auto options = options_of(s);
  const std::string before = canonical(find(options, "weight_kg").get());
  s.weight_kg = std::nextafter(s.weight_kg, 1.0);
  EXPECT_NE(canonical(find(options, "weight_kg").get()), before);
  EXPECT_EQ(canonical(find(options, "price").get()), "unset");
  EXPECT_EQ(readable(find(options, "fruit").get()), "apple");
}

TEST(Options, ClosestFindsSlipsAndNothingElse) {
  const std::vector<std::string> names = {"max_hole_size_spacings", "base", "method"};
  EXPECT_EQ(closest("max_hole_size_spacing", names), "max_hole_size_spacings");
  EXPECT_EQ(closest("mehtod", names), "method");
  EXPECT_EQ(closest("texture", names), "");
}

}  // namespace
}  // namespace drape
