#include "page_script.hpp"

#include <cstddef>

#include "drape/base/hash.hpp"
#include "html_text.hpp"

// The files' bytes, laid into the program by the assembler.
#define DRAPE_EMBED(name, file)       \
  asm(".pushsection .rodata\n"        \
      ".global " #name "\n" #name     \
      ":\n"                           \
      ".incbin \"" file               \
      "\"\n"                          \
      ".global " #name "_end\n" #name \
      "_end:\n"                       \
      ".byte 0\n"                     \
      ".popsection\n");               \
  extern "C" const char name[];       \
  extern "C" const char name##_end[]

DRAPE_EMBED(drape_batch_page, DRAPE_PAGE_FOLDER "/batch_page.js");
DRAPE_EMBED(drape_run_page, DRAPE_PAGE_FOLDER "/run_page.js");

namespace drape::report {
namespace {

// 64 hexadecimal digits as base64.
std::string base64_of_hex(std::string_view hex) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(16 * digit(hex[i]) + digit(hex[i + 1]));
  return base64(bytes);
}

}  // namespace

std::string_view batch_page_script() {
  return {drape_batch_page, static_cast<std::size_t>(drape_batch_page_end - drape_batch_page)};
}

std::string_view run_page_script() {
  return {drape_run_page, static_cast<std::size_t>(drape_run_page_end - drape_run_page)};
}

ScriptElement script_element(std::string_view script) {
  // XML takes the script for text by the section, HTML takes the section's marks for comments.
  std::string text = "/*<![CDATA[*/";
  text += script;
  text += "/*]]>*/";
  return {"<script>" + text + "</script>\n", "'sha256-" + base64_of_hex(sha256(text)) + "'"};
}

std::string json_in_script(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json)
    if (c == '<')
      text += "\\u003c";
    else if (c == '>')
      text += "\\u003e";
    else if (c == '&')
      text += "\\u0026";
    else
      text += c;
  return text;
}

}  // namespace drape::report
