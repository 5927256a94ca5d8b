#include "drape/report/batch_page.hpp"

#include <gtest/gtest.h>

#include "markup.hpp"

namespace drape::report {
namespace {

using test::Element;
using test::Markup;
using test::parse_markup;

const std::string nasty = "<script>alert(\"x\")</script> & 'y' --><!-- ]]> \" onload=\"z";

BatchPage page_of(const std::string& text) {
  BatchPage page{text, text, {}, text};
  for (const char* status : {"failed", "missing", "review", "ok"})
    page.rows.push_back({text, status, text, text, text, 1.5, 200, "../../runs/b/x/report.html", ""});
  page.rows.push_back({text, "ok", "", "", "", 0, 0, "", "no picture"});
  return page;
}

TEST(BatchPage, ShowsEveryTextAsItIsInTheOrderGiven) {
  const Markup markup = parse_markup(render_batch(page_of(nasty)));
  ASSERT_EQ(markup.problem, "");
  std::vector<std::string> statuses;
  for (const Element& row : markup.named("tr"))
    if (row.attributes.contains("data-status")) {
      statuses.push_back(row.attributes.at("data-status"));
      EXPECT_EQ(row.attributes.at("data-object"), nasty);
    }
  EXPECT_EQ(statuses, (std::vector<std::string>{"failed", "missing", "review", "ok", "ok"}));
  EXPECT_EQ(markup.named("script").size(), 1U);
  EXPECT_TRUE(markup.named("img").empty());
}

TEST(BatchPage, LinksTheObjectsThatHaveAPage) {
  const Markup markup = parse_markup(render_batch(page_of("a")));
  ASSERT_EQ(markup.named("a").size(), 4U);
  EXPECT_EQ(markup.named("a")[0].attributes.at("href"), "../../runs/b/x/report.html");
  EXPECT_EQ(markup.named("a")[0].attributes.at("rel"), "opener");
}

}  // namespace
}  // namespace drape::report
