// A head-less Chromium, driven as a user would (W3C WebDriver over HTTP).
#pragma once

#include <sys/types.h>

#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support.hpp"

namespace drape::test {

class Browser {
 public:
  /// Why there can be none here; empty: there can. Tests are skipped with it.
  [[nodiscard]] static std::string missing();

  /// Throws std::runtime_error if it does not start or answer; so do all calls.
  Browser();
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Layout size in CSS pixels, from the next page on.
  void resize(int width, int height);
  void prefer(const std::string& color_scheme);
  void open(const std::filesystem::path& file);

  /// The value of a JavaScript function's body; a promise is waited for.
  nlohmann::json evaluate(const std::string& body);
  /// Waits until the expression is true, a minute at most; false if it never was.
  [[nodiscard]] bool wait_for(const std::string& expression);

  /// A click in the middle of the element, scrolled into view.
  void click(const std::string& selector);
  /// Clicks a link that opens a window of its own, and goes there.
  void follow(const std::string& selector);
  void back_to_the_first_window();
  /// The pointer pressed and moved through places of the element: shares of its width and height.
  void drag(const std::string& selector, const std::vector<std::array<double, 2>>& places);
  /// Keys to the element that has the focus.
  void type(const std::string& selector, const std::string& keys);

  /// What was logged since the last call: errors and warnings of the console.
  [[nodiscard]] std::vector<std::string> console_errors();
  [[nodiscard]] std::string screenshot_png();
  /// What the element shows, as PNG.
  [[nodiscard]] std::string screenshot_png(const std::string& selector);
  /// Where downloads go. Waits until the file is there.
  [[nodiscard]] std::filesystem::path downloaded(const std::string& name);

 private:
  nlohmann::json call(const std::string& path, const nlohmann::json& body);
  nlohmann::json get(const std::string& path);
  std::string element(const std::string& selector);
  void command(const std::string& name, const nlohmann::json& parameters);

  ScratchFolder folder_;
  pid_t driver_ = -1;
  int port_ = 0;
  std::string session_;
};

}  // namespace drape::test
