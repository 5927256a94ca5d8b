#include "browser.hpp"

#include <fcntl.h>
#include <httplib.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "drape/base/files.hpp"

namespace drape::test {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

const char* const browser_program = "/usr/bin/chromium";
const char* const driver_program = "/usr/bin/chromedriver";
// The name under which the protocol refers to elements (W3C WebDriver, section 11).
const char* const element_key = "element-6066-11e4-a52e-4f735466cecf";

void pause_ms(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

std::string from_base64(const std::string& text) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned block = 0;
  int bits = 0;
  for (const char c : text) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) break;
    block = block << 6 | static_cast<unsigned>(digit);
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += static_cast<char>(block >> bits & 0xFFU);
    }
  }
  return bytes;
}

json capabilities(const fs::path& folder) {
  // WebGL by software, for machines without a screen; as root Chromium has no sandbox of its own.
  const json options{{"binary", browser_program},
                     {"args",
                      {"--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle",
                       "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                       "--force-device-scale-factor=1", "--no-first-run", "--disable-background-networking",
                       "--user-data-dir=" + (folder / "profile").string()}},
                     {"prefs", {{"download.default_directory", folder.string()}}}};
  return {{"capabilities",
           {{"alwaysMatch",
             {{"browserName", "chrome"},
              {"goog:chromeOptions", options},
              {"goog:loggingPrefs", {{"browser", "ALL"}}}}}}}};
}

}  // namespace

std::string Browser::missing() {
  for (const char* program : {browser_program, driver_program})
    if (!fs::exists(program)) return std::string(program) + " is not installed; scripts/setup installs it";
  return {};
}

Browser::Browser() {
  const fs::path log = folder_ / "driver.log";
  driver_ = ::fork();
  if (driver_ == 0) {
    ::setpgid(0, 0);
    const int file = ::open(log.c_str(), O_CREAT | O_WRONLY, 0600);
    ::dup2(file, 1);
    ::dup2(file, 2);
    ::execl(driver_program, driver_program, "--port=0", nullptr);
    ::_exit(127);
  }
  for (int i = 0; i < 600 && port_ == 0; ++i) {
    pause_ms(50);
    const std::string text = fs::exists(log) ? read_file(log) : "";
    const std::size_t at = text.find("successfully on port ");
    if (at != std::string::npos && text.find('\n', at) != std::string::npos)
      port_ = std::stoi(text.substr(at + 21));
  }
  if (port_ == 0) throw std::runtime_error("chromedriver did not start: " + read_file(log));
  session_ = call("/session", capabilities(folder_.path())).at("sessionId");
}

Browser::~Browser() {
  if (!session_.empty()) {
    httplib::Client client("127.0.0.1", port_);
    client.Delete(("/session/" + session_).c_str());
  }
  ::kill(-driver_, SIGTERM);
  ::waitpid(driver_, nullptr, 0);
}

json Browser::call(const std::string& path, const json& body) {
  httplib::Client client("127.0.0.1", port_);
  client.set_read_timeout(180, 0);
  const std::string whole = session_.empty() ? path : "/session/" + session_ + path;
  const auto answer = client.Post(whole.c_str(), body.dump(), "application/json");
  if (!answer) throw std::runtime_error(path + ": chromedriver does not answer");
  const json value = json::parse(answer->body).at("value");
  if (answer->status != 200) throw std::runtime_error(path + ": " + value.value("message", answer->body));
  return value;
}

json Browser::get(const std::string& path) {
  httplib::Client client("127.0.0.1", port_);
  client.set_read_timeout(180, 0);
  const auto answer = client.Get(("/session/" + session_ + path).c_str());
  if (!answer || answer->status != 200) throw std::runtime_error(path + ": no answer");
  return json::parse(answer->body).at("value");
}

void Browser::command(const std::string& name, const json& parameters) {
  call("/goog/cdp/execute", {{"cmd", name}, {"params", parameters}});
}

void Browser::resize(int width, int height) {
  command("Emulation.setDeviceMetricsOverride",
          {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

void Browser::prefer(const std::string& color_scheme) {
  command("Emulation.setEmulatedMedia",
          {{"features", {{{"name", "prefers-color-scheme"}, {"value", color_scheme}}}}});
}

void Browser::open(const fs::path& file) {
  call("/url", {{"url", "file://" + fs::absolute(file).string()}});
}

json Browser::evaluate(const std::string& body) {
  return call("/execute/sync", {{"script", body}, {"args", json::array()}});
}

bool Browser::wait_for(const std::string& expression) {
  for (int i = 0; i < 600; ++i) {
    if (evaluate("return Boolean(" + expression + ")").get<bool>()) return true;
    pause_ms(100);
  }
  return false;
}

std::string Browser::element(const std::string& selector) {
  return call("/element", {{"using", "css selector"}, {"value", selector}}).at(element_key);
}

void Browser::click(const std::string& selector) {
  // At once: the page itself scrolls smoothly.
  evaluate("document.querySelector(" + json(selector).dump() +
           ")?.scrollIntoView({block: 'center', behavior: 'instant'})");
  call("/element/" + element(selector) + "/click", json::object());
}

void Browser::follow(const std::string& selector) {
  const std::size_t before = get("/window/handles").size();
  click(selector);
  json handles = get("/window/handles");
  for (int i = 0; i < 100 && handles.size() == before; ++i) {
    pause_ms(50);
    handles = get("/window/handles");
  }
  call("/window", {{"handle", handles.back()}});
}

void Browser::back_to_the_first_window() {
  call("/window", {{"handle", get("/window/handles").front()}});
}

void Browser::drag(const std::string& selector, const std::vector<std::array<double, 2>>& places) {
  const std::string quoted = json(selector).dump();
  const json box = evaluate("const e = document.querySelector(" + quoted +
                            "); e.scrollIntoView({block: 'center', behavior: 'instant'}); const b = "
                            "e.getBoundingClientRect(); return "
                            "[b.left, b.top, b.width, b.height];");
  json steps = json::array();
  for (std::size_t i = 0; i < places.size(); ++i) {
    steps.push_back({{"type", "pointerMove"},
                     {"duration", 0},
                     {"x", std::lround(box[0].get<double>() + places[i][0] * box[2].get<double>())},
                     {"y", std::lround(box[1].get<double>() + places[i][1] * box[3].get<double>())}});
    if (i == 0) steps.push_back({{"type", "pointerDown"}, {"button", 0}});
  }
  steps.push_back({{"type", "pointerUp"}, {"button", 0}});
  call("/actions", {{"actions", {{{"type", "pointer"}, {"id", "mouse"}, {"actions", steps}}}}});
}

void Browser::type(const std::string& selector, const std::string& keys) {
  call("/element/" + element(selector) + "/value", {{"text", keys}});
}

std::vector<std::string> Browser::console_errors() {
  std::vector<std::string> errors;
  for (const json& entry : call("/se/log", {{"type", "browser"}}))
    if (entry.value("level", "") == "SEVERE" || entry.value("level", "") == "WARNING")
      errors.push_back(entry.value("message", ""));
  return errors;
}

std::string Browser::screenshot_png() {
  return from_base64(get("/screenshot"));
}

std::string Browser::screenshot_png(const std::string& selector) {
  return from_base64(get("/element/" + element(selector) + "/screenshot"));
}

fs::path Browser::downloaded(const std::string& name) {
  const fs::path file = folder_ / name;
  for (int i = 0; i < 200; ++i) {
    if (fs::exists(file) && fs::file_size(file) > 0) return file;
    pause_ms(50);
  }
  throw std::runtime_error(name + " was not downloaded");
}

}  // namespace drape::test
