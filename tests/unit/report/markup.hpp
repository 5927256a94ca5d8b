// A strict reader of the mark-up that the page is written in: well-formed XML with HTML's names.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace drape::report::test {

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;  // entities resolved
  std::string text;                               // of it and of all it contains, entities resolved
  std::size_t parent = 0;                         // index; the root is its own parent
};

struct Markup {
  std::string problem;  // empty: every tag is closed in order, every attribute quoted, every entity known
  std::vector<Element> elements;

  [[nodiscard]] std::vector<Element> named(const std::string& name) const;
  [[nodiscard]] const Element* with_id(const std::string& id) const;
};

[[nodiscard]] Markup parse_markup(const std::string& document);

}  // namespace drape::report::test
