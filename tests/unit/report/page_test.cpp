#include "drape/report/page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "encoded_picture.hpp"
#include "html_text.hpp"
#include "markup.hpp"
#include "page_script.hpp"

namespace drape::report {
namespace {

using test::Element;
using test::Markup;
using test::parse_markup;

// As much of the formats as tells what they are and how large.
std::string png(int width, int height) {
  std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16);
  for (const int size : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(size >> shift & 0xFF);
  return bytes + std::string("\x08\x02\0\0\0 the rest", 14);
}

std::string jpeg(int width, int height) {
  std::string bytes("\xFF\xD8\xFF\xE0\0\x06JFIF\xFF\xFF\xC0\0\x11\x08", 16);
  for (const int size : {height, width})
    for (int shift = 8; shift >= 0; shift -= 8) bytes += static_cast<char>(size >> shift & 0xFF);
  return bytes + "\x03 the rest";
}

const std::string nasty = "<script>alert(\"x\")</script> & 'y' --><!-- ]]> \" onload=\"z";

// A page in which every text is `text`.
RunPage page_of(const std::string& text) {
  const Number number{text, text, text, text};
  const Picture picture{text, text, text, png(4, 3)};
  StageSection stage;
  stage.name = text;
  stage.summary = text;
  stage.seconds = 1.5;
  stage.peak_memory_mb = 100;
  stage.numbers = {number, number};
  stage.pictures = {picture, {text, text, text, text}};
  stage.warnings = {text, text};
  stage.options = {{text, text}};
  RunPage page;
  page.title = text;
  page.status = RunStatus::review;
  page.reasons = {text};
  page.started = text;
  page.numbers = {number};
  page.pictures = {picture, picture};
  page.stages = {stage, stage};
  page.stages[1].status = StageStatus::failed;
  page.command_line = text;
  page.config_text = text;
  page.versions = {{text, text}};
  return page;
}

TEST(Page, IsWellFormed) {
  EXPECT_EQ(parse_markup(render_page(page_of("words"))).problem, "");
  EXPECT_EQ(parse_markup(render_page(RunPage{})).problem, "");
  RunPage bare_stages;
  bare_stages.stages.resize(3);
  EXPECT_EQ(parse_markup(render_page(bare_stages)).problem, "");
}

TEST(Page, TheReaderOfTheseTestsIsStrict) {
  for (const char* wrong : {"<p>", "</p>", "<p><b></p></b>", "<p a=b></p>", "<p a=\"<\"></p>", "a & b",
                            "&nbsp;", "<p a=\"1\" a=\"2\"></p>"})
    EXPECT_NE(parse_markup(std::string("<!DOCTYPE html>\n") + wrong).problem, "") << wrong;
}

TEST(Page, ShowsEveryTextAsItIs) {
  const Markup markup = parse_markup(render_page(page_of(nasty)));
  ASSERT_EQ(markup.problem, "");
  EXPECT_TRUE(markup.named("script").empty());
  for (const Element& element : markup.elements)
    for (const auto& [name, value] : element.attributes) EXPECT_FALSE(name.starts_with("on")) << name;
  // A page of plain words and this one differ in their texts alone.
  const Markup plain = parse_markup(render_page(page_of("words")));
  ASSERT_EQ(markup.elements.size(), plain.elements.size());
  std::size_t shown = 0;
  for (std::size_t i = 0; i < plain.elements.size(); ++i) {
    EXPECT_EQ(markup.elements[i].name, plain.elements[i].name);
    if (plain.elements[i].text != "words") continue;
    EXPECT_EQ(markup.elements[i].text, nasty);
    ++shown;
  }
  EXPECT_GT(shown, 30U);
  EXPECT_EQ(markup.named("img").front().attributes.at("alt"), nasty);
}

TEST(Page, ScriptIsThereWithAViewAndNamedByThePolicy) {
  RunPage page = page_of("words");
  page.pictures[0].key = "photo:000";
  page.view = ModelView{"glTF bytes", R"({"text": "</script><!-- & ]]>"})"};
  const std::string text = render_page(page);
  const Markup markup = parse_markup(text);
  ASSERT_EQ(markup.problem, "");
  ASSERT_NE(markup.with_id("view"), nullptr);
  EXPECT_EQ(markup.with_id("page-data")->text, R"({"text": "\u003c/script\u003e\u003c!-- \u0026 ]]\u003e"})");
  EXPECT_EQ(markup.with_id("model-bytes")->text, "Z2xURiBieXRlcw==");
  EXPECT_EQ(markup.named("img").front().attributes.at("data-key"), "photo:000");
  const std::vector<Element> scripts = markup.named("script");
  ASSERT_EQ(scripts.size(), 3U);
  EXPECT_GT(scripts.back().text.size(), 100'000U);
  // The browser runs the script whose digest the policy names: that of the bytes between the tags.
  const std::size_t begin = text.rfind("<script>") + 8;
  const ScriptElement element = script_element(run_page_script());
  EXPECT_EQ(text.substr(begin, text.rfind("</script>") - begin),
            element.html.substr(8, element.html.rfind("</script>") - 8));
  EXPECT_NE(text.find("script-src " + element.policy_source), std::string::npos);
}

TEST(PageScript, DigestIsThatOfTheContent) {
  // printf '/*<![CDATA[*/x/*]]>*/' | openssl dgst -sha256 -binary | base64
  EXPECT_EQ(script_element("x").html, "<script>/*<![CDATA[*/x/*]]>*/</script>\n");
  EXPECT_EQ(script_element("x").policy_source, "'sha256-AgNK+9h07F0NgK79Sb9X0ZA76oQiT7YjgiWiY4bg/mw='");
}

TEST(Page, BytesThatAreNoTextDoNotBreakIt) {
  const std::string page = render_page(page_of("\xFF\x01\xC3(\xE2\x82"));
  EXPECT_EQ(parse_markup(page).problem, "");
  EXPECT_EQ(page.find('\xFF'), std::string::npos);
  EXPECT_EQ(page.find('\x01'), std::string::npos);
}

TEST(Page, RefersToNothingOutsideItself) {
  const std::string page = render_page(page_of("https://example.org/a.png"));
  const Markup markup = parse_markup(page);
  for (const Element& element : markup.elements)
    for (const auto& [name, value] : element.attributes) {
      EXPECT_TRUE(name != "src" || value.starts_with("data:image/")) << value.substr(0, 40);
      EXPECT_TRUE(name != "href" || value.starts_with("#")) << value;
      EXPECT_TRUE(name != "srcset" && name != "action" && name != "data" && name != "poster") << name;
    }
  EXPECT_TRUE(markup.named("link").empty());
  const std::string style = page.substr(page.find("<style>"), page.find("</style>") - page.find("<style>"));
  EXPECT_EQ(style.find("url("), std::string::npos);
  EXPECT_EQ(style.find("@import"), std::string::npos);
}

TEST(Page, LinksLeadSomewhereAndIdsAreUnique) {
  for (const RunPage& page : {page_of("words"), RunPage{}}) {
    const Markup markup = parse_markup(render_page(page));
    std::set<std::string> ids;
    for (const Element& element : markup.elements) {
      if (element.attributes.contains("id")) {
        EXPECT_TRUE(ids.insert(element.attributes.at("id")).second);
      }
      if (element.attributes.contains("href")) {
        const std::string target = element.attributes.at("href").substr(1);
        EXPECT_NE(markup.with_id(target), nullptr) << target;
      }
    }
  }
}

TEST(Page, HeadingsGoDownOneLevelAtATime) {
  const Markup markup = parse_markup(render_page(page_of("words")));
  EXPECT_EQ(markup.named("h1").size(), 1U);
  int level = 0;
  for (const Element& element : markup.elements) {
    if (element.name.size() != 2 || element.name[0] != 'h' || element.name[1] < '1' || element.name[1] > '6')
      continue;
    EXPECT_LE(element.name[1] - '0', level + 1);
    level = element.name[1] - '0';
  }
  EXPECT_EQ(level, 3);
  EXPECT_EQ(markup.named("html").front().attributes.at("lang"), "en");
}

TEST(Page, EmbedsPicturesWithTheirSizeAndText) {
  RunPage page;
  page.pictures = {{"Photo", "A teapot on a table", "front.jpg", jpeg(640, 480)},
                   {"Stencil", "", "", png(300, 200)}};
  const Markup markup = parse_markup(render_page(page));
  const auto images = markup.named("img");
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].attributes.at("src"), "data:image/jpeg;base64," + base64(jpeg(640, 480)));
  EXPECT_EQ(images[0].attributes.at("width"), "640");
  EXPECT_EQ(images[0].attributes.at("height"), "480");
  EXPECT_EQ(images[0].attributes.at("alt"), "A teapot on a table");
  EXPECT_EQ(images[1].attributes.at("src"), "data:image/png;base64," + base64(png(300, 200)));
  EXPECT_EQ(images[1].attributes.at("alt"), "Stencil");
  EXPECT_EQ(markup.named("figcaption")[0].text, "Photofront.jpg");
}

TEST(Page, SaysWhichPictureIsMissing) {
  for (const std::string& bytes :
       {std::string(), std::string("GIF89a"), std::string("\x89PNG\r\n\x1a\n"),
        std::string("\xFF\xD8\xFF\xE0"), png(0, 5), jpeg(640, 480).substr(0, 17)}) {
    EXPECT_FALSE(encoded_picture(bytes).has_value());
    RunPage page;
    page.pictures = {{"Photo", "A teapot", "", bytes}};
    const Markup markup = parse_markup(render_page(page));
    EXPECT_EQ(markup.problem, "");
    EXPECT_TRUE(markup.named("img").empty());
    EXPECT_NE(markup.named("figure").front().text.find("missing"), std::string::npos);
    EXPECT_NE(markup.named("figure").front().text.find("Photo"), std::string::npos);
  }
}

TEST(Page, ShowsNumbersWithTheirUnits) {
  RunPage page;
  page.numbers = {{"overlap", "96.4", "%", "of the stencils"}, {"faces", "12", "", ""}};
  page.stages.resize(1);
  page.stages[0].numbers = {{"focal length", "1200", "px", "found"}};
  const Markup markup = parse_markup(render_page(page));
  const auto values = markup.named("dd");
  EXPECT_EQ(values[0].text, "96.4\u00a0%");
  EXPECT_EQ(values[1].text, "of the stencils");
  EXPECT_EQ(values[2].text, "12");
  const auto cells = markup.named("td");
  EXPECT_TRUE(
      std::any_of(cells.begin(), cells.end(), [](const Element& e) { return e.text == "1200\u00a0px"; }));
  EXPECT_TRUE(std::any_of(cells.begin(), cells.end(), [](const Element& e) { return e.text == "found"; }));
}

TEST(Page, TellsHowItEndedAndWhy) {
  RunPage page;
  page.title = "teapot";
  page.status = RunStatus::review;
  page.reasons = {"units were guessed"};
  page.started = "2026-05-14T10:11:12Z";
  page.seconds = 192;
  Markup markup = parse_markup(render_page(page));
  EXPECT_EQ(markup.named("title").front().text, "teapot \u00b7 Needs review");
  const std::string text = markup.with_id("result")->text;
  EXPECT_NE(text.find("Why it needs review"), std::string::npos);
  EXPECT_NE(text.find("units were guessed"), std::string::npos);
  EXPECT_NE(text.find("2026-05-14 10:11:12 UTC"), std::string::npos);
  EXPECT_NE(text.find("3 min 12 s"), std::string::npos);
  page.status = RunStatus::ok;
  page.reasons = {};
  markup = parse_markup(render_page(page));
  EXPECT_EQ(markup.with_id("result")->text.find("Why"), std::string::npos);
  page.status = RunStatus::failed;
  page.reasons = {"a.ply: cut off"};
  EXPECT_NE(parse_markup(render_page(page)).with_id("result")->text.find("Why it failed"), std::string::npos);
}

TEST(Page, ShowsEveryStageWithItsCostAndWarnings) {
  RunPage page;
  page.seconds = 7;
  page.stages.resize(2);
  page.stages[0].name = "ingest";
  page.stages[0].status = StageStatus::reused;
  page.stages[0].seconds = 90;
  page.stages[0].peak_memory_mb = 4000;
  page.stages[1].name = "align";
  page.stages[1].seconds = 6;
  page.stages[1].peak_memory_mb = 250;
  page.stages[1].warnings = {"weak evidence"};
  page.stages[1].options = {{"align.method", "exhaustive"}};
  const Markup markup = parse_markup(render_page(page));
  const std::string times = markup.with_id("times")->text;
  EXPECT_NE(times.find("1 min 30 s"), std::string::npos);
  EXPECT_NE(times.find("reused"), std::string::npos);
  // What the run needed leaves the reused stage out.
  EXPECT_NE(times.find("This run7.0 s250 MB"), std::string::npos);
  ASSERT_NE(markup.with_id("stage-2"), nullptr);
  EXPECT_NE(markup.with_id("stage-2")->text.find("weak evidence"), std::string::npos);
  EXPECT_NE(markup.with_id("stage-2")->text.find("align.methodexhaustive"), std::string::npos);
  EXPECT_EQ(markup.with_id("stage-1")->text.find("Warning"), std::string::npos);
  const std::string navigation = markup.named("nav").front().text;
  EXPECT_NE(navigation.find("ingest"), std::string::npos);
  EXPECT_NE(navigation.find("align!"), std::string::npos);
}

TEST(Page, KeepsTheConfigurationToTheLetter) {
  RunPage page;
  page.config_text = "input:\n  scans: [\"a.ply\"]   # two  blanks\n\ttab\n";
  page.command_line = "drape run 'my config.yaml'";
  const Markup markup = parse_markup(render_page(page));
  const auto code = markup.named("code");
  ASSERT_EQ(code.size(), 2U);
  EXPECT_EQ(code[0].text, page.command_line);
  EXPECT_EQ(code[1].text, page.config_text);
}

}  // namespace
}  // namespace drape::report
