#include "markup.hpp"

#include <cctype>
#include <string_view>

namespace drape::report::test {
namespace {

struct Reader {
  std::string_view rest;
  Markup markup;
  std::vector<std::size_t> open;

  void fail(const std::string& what) {
    if (markup.problem.empty()) markup.problem = what + " before: " + std::string(rest.substr(0, 60));
  }
  bool take(std::string_view text) {
    if (!rest.starts_with(text)) return false;
    rest.remove_prefix(text.size());
    return true;
  }
  void skip_space() {
    while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest[0])) != 0) rest.remove_prefix(1);
  }
  std::string name() {
    std::size_t length = 0;
    while (length < rest.size() && (std::isalnum(static_cast<unsigned char>(rest[length])) != 0 ||
                                    rest[length] == '-' || rest[length] == ':'))
      ++length;
    const std::string taken(rest.substr(0, length));
    rest.remove_prefix(length);
    if (taken.empty()) fail("no name");
    return taken;
  }
  std::string resolved(std::string_view text) {
    std::string out;
    while (!text.empty()) {
      if (text[0] == '<') fail("a bare <");
      if (text[0] != '&') {
        out += text[0];
        text.remove_prefix(1);
        continue;
      }
      const std::map<std::string_view, std::string> known = {{"&amp;", "&"}, {"&lt;", "<"},
                                                             {"&gt;", ">"},  {"&quot;", "\""},
                                                             {"&#39;", "'"}, {"&#160;", "\u00a0"}};
      const std::size_t end = text.find(';');
      const auto entity = known.find(text.substr(0, end == std::string_view::npos ? 0 : end + 1));
      if (entity == known.end()) {
        fail("an unknown entity " + std::string(text.substr(0, 12)));
        return out;
      }
      out += entity->second;
      text.remove_prefix(end + 1);
    }
    return out;
  }
  void start_tag() {
    Element element;
    element.name = name();
    element.parent = open.empty() ? 0 : open.back();
    for (skip_space(); markup.problem.empty() && !rest.empty() && rest[0] != '>' && rest[0] != '/';
         skip_space()) {
      const std::string key = name();
      if (!take("=\"")) return fail("an attribute without a quoted value");
      const std::size_t end = rest.find('"');
      if (end == std::string_view::npos) return fail("an attribute without an end");
      if (!element.attributes.emplace(key, resolved(rest.substr(0, end))).second)
        return fail("an attribute twice: " + key);
      rest.remove_prefix(end + 1);
    }
    markup.elements.push_back(element);
    if (take("/>")) return;
    if (!take(">")) return fail("a tag without an end");
    open.push_back(markup.elements.size() - 1);
    if (element.name == "style") rest.remove_prefix(std::min(rest.find("</style>"), rest.size()));
  }
  void end_tag() {
    const std::string closed = name();
    if (!take(">")) return fail("a closing tag without an end");
    if (open.empty() || markup.elements[open.back()].name != closed)
      return fail("</" + closed + "> out of order");
    open.pop_back();
  }
  // What XML takes as it is: <![CDATA[ ... ]]>
  void section() {
    const std::size_t end = rest.find("]]>");
    if (end == std::string_view::npos) return fail("a section without an end");
    for (const std::size_t i : open) markup.elements[i].text += rest.substr(0, end);
    rest.remove_prefix(end + 3);
  }
  void text() {
    const std::size_t length = std::min(rest.find('<'), rest.size());
    const std::string words = resolved(rest.substr(0, length));
    rest.remove_prefix(length);
    for (const std::size_t i : open) markup.elements[i].text += words;
  }
};

}  // namespace

std::vector<Element> Markup::named(const std::string& name) const {
  std::vector<Element> found;
  for (const Element& element : elements)
    if (element.name == name) found.push_back(element);
  return found;
}

const Element* Markup::with_id(const std::string& id) const {
  for (const Element& element : elements)
    if (const auto it = element.attributes.find("id"); it != element.attributes.end() && it->second == id)
      return &element;
  return nullptr;
}

Markup parse_markup(const std::string& document) {
  Reader reader{document, {}, {}};
  if (!reader.take("<!DOCTYPE html>\n")) reader.fail("no document type");
  while (!reader.rest.empty() && reader.markup.problem.empty()) {
    if (reader.take("</"))
      reader.end_tag();
    else if (reader.take("<![CDATA["))
      reader.section();
    else if (reader.take("<"))
      reader.start_tag();
    else
      reader.text();
  }
  if (!reader.open.empty()) reader.fail("unclosed " + reader.markup.elements[reader.open.back()].name);
  return reader.markup;
}

}  // namespace drape::report::test
