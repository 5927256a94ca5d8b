#include <gtest/gtest.h>

#include "drape/pipeline/config_node.hpp"
#include "support.hpp"

namespace drape::pipeline {
namespace {

std::string problem(const std::string& yaml) {
  return test::error_message(ErrorCode::config, [&] { (void)parse_yaml(yaml, "c.yaml"); });
}

TEST(Yaml, TreeWithPlaces) {
  const ConfigNode root = parse_yaml("a: 1\nb:\n  - x\n  - {c: 'two words'}\nd:\n", "c.yaml");
  ASSERT_EQ(root.kind, ConfigNode::Kind::map);
  EXPECT_EQ(root.find("a")->text, "1");
  EXPECT_EQ(root.find("b")->items[1].find("c")->text, "two words");
  EXPECT_EQ(root.find("b")->items[1].find("c")->where.text(), "c.yaml:4:9");
  EXPECT_EQ(root.find("d")->kind, ConfigNode::Kind::null);
  EXPECT_EQ(root.find("e"), nullptr);
}

TEST(Yaml, EmptyIsNull) {
  EXPECT_EQ(parse_yaml("# nothing\n", "c.yaml").kind, ConfigNode::Kind::null);
}

TEST(Yaml, DangerousThingsAreRefusedWithTheirPlace) {
  EXPECT_EQ(problem("a: 1\nb: 2\na: 3\n"), "c.yaml:3:1: a is given twice (first in line 1)");
  EXPECT_NE(problem("a: &x [1]\nb: *x\n").find("c.yaml:1:"), std::string::npos);
  EXPECT_NE(problem("a: *x\n"), "");
  EXPECT_NE(problem("a: !!binary xyz\n").find("tags"), std::string::npos);
  EXPECT_NE(problem("a: [1, 2\n").find("c.yaml:"), std::string::npos);
  EXPECT_NE(problem("a: 1\n---\nb: 2\n").find("more than one document"), std::string::npos);
  EXPECT_NE(problem("? [x]\n: 1\n").find("single word"), std::string::npos);
  EXPECT_NE(problem(std::string(40, '[') + std::string(40, ']')).find("deeper than 32"), std::string::npos);
  std::string many = "a: [";
  for (int i = 0; i < 10001; ++i) many += "1,";
  EXPECT_NE(problem(many + "]").find("more than 10000"), std::string::npos);
}

TEST(Yaml, TruncatedAnywhereIsATreeOrAnError) {
  const std::string yaml =
      "input:\n  scans: ['a*.ply', \"b\"]\n  photos:\n    - image: x.jpg\n      box_px: [1, 2, 3, 4]\nfill: "
      "{base: flat}\n";
  for (std::size_t length = 0; length <= yaml.size(); ++length) {
    try {
      (void)parse_yaml(yaml.substr(0, length), "c.yaml");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::config);
    }
  }
}

TEST(Yaml, SetReplacesAndAdds) {
  ConfigNode root = parse_yaml("fill: {base: flat}\n", "c.yaml");
  set_value(root, "fill.base", "leave");
  set_value(root, "input.photos[0].mask", "m.png");
  set_value(root, "input.photos[1]", "{image: b.jpg}");
  EXPECT_EQ(root.find("fill")->find("base")->text, "leave");
  EXPECT_EQ(root.find("input")->find("photos")->items[0].find("mask")->text, "m.png");
  EXPECT_EQ(root.find("input")->find("photos")->items[1].find("image")->text, "b.jpg");
  const auto wrong = [&](const std::string& path) {
    return test::error_message(ErrorCode::config, [&] { set_value(root, path, "1"); });
  };
  EXPECT_NE(wrong("input.photos[7].mask"), "");
  EXPECT_NE(wrong("fill.base.deeper"), "");
  EXPECT_NE(wrong("fill..base"), "");
  EXPECT_NE(wrong("[0"), "");
  EXPECT_NE(wrong(""), "");
}

}  // namespace
}  // namespace drape::pipeline
