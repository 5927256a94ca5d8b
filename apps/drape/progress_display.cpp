#include "progress_display.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>

namespace drape::app {
namespace {

constexpr int bar_width = 28;

std::string bar(double fraction) {
  const int full = static_cast<int>(fraction * bar_width + 0.5);
  std::string text;
  for (int i = 0; i < bar_width; ++i) text += i < full ? "█" : "░";
  return text;
}

void print_json(const nlohmann::ordered_json& event) {
  fmt::print(stderr, "{}\n", event.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace

ProgressDisplay::ProgressDisplay(ProgressMode mode) {
  switch (mode) {
    case ProgressMode::automatic:
      style_ = ::isatty(STDERR_FILENO) != 0 ? Style::bar : Style::plain;
      break;
    case ProgressMode::plain:
      style_ = Style::plain;
      break;
    case ProgressMode::json:
      style_ = Style::json;
      break;
    case ProgressMode::none:
      style_ = Style::none;
      break;
  }
}

ProgressDisplay::~ProgressDisplay() {
  clear_bar();
}

void ProgressDisplay::clear_bar() {
  if (bar_shown_) fmt::print(stderr, "\r\x1b[K");
  bar_shown_ = false;
  std::fflush(stderr);
}

void ProgressDisplay::stage_started(const pipeline::Stage& stage, std::size_t number, std::size_t count,
                                    const std::string& why) {
  last_shown_ = {};
  last_fraction_ = 0;
  title_ = fmt::format("[{}/{}] {}", number, count, stage.name);
  if (style_ == Style::json)
    print_json({{"event", "stage_started"},
                {"stage", stage.name},
                {"number", number},
                {"count", count},
                {"why", why}});
  if (style_ == Style::plain) fmt::print(stderr, "{}: {}\n", title_, why);
}

void ProgressDisplay::stage_progress(const pipeline::Stage& stage, double fraction, std::string_view what) {
  if (style_ == Style::json) {
    // A program wants to see movement, not every call: whole percents.
    if (fraction < 1 && static_cast<int>(fraction * 100) == static_cast<int>(last_fraction_ * 100)) return;
    last_fraction_ = fraction;
    print_json({{"event", "progress"}, {"stage", stage.name}, {"fraction", fraction}, {"what", what}});
    return;
  }
  show(title_, fraction, what);
}

void ProgressDisplay::show(const std::string& title, double fraction, std::string_view what) {
  const auto now = std::chrono::steady_clock::now();
  if (style_ == Style::bar) {
    if (now - last_shown_ < std::chrono::milliseconds(80)) return;
    last_shown_ = now;
    fmt::print(stderr, "\r\x1b[K{:<16} {} {:3.0f} %  {}", title, bar(fraction), 100 * fraction, what);
    std::fflush(stderr);
    bar_shown_ = true;
  }
  // Plain lines only for what takes long: a line every ten seconds.
  if (style_ == Style::plain) {
    if (last_shown_ == std::chrono::steady_clock::time_point{}) last_shown_ = now;
    if (now - last_shown_ < std::chrono::seconds(10)) return;
    last_shown_ = now;
    fmt::print(stderr, "{}: {:.0f} % {}\n", title, 100 * fraction, what);
  }
}

void ProgressDisplay::stage_finished(const pipeline::Stage& stage, std::size_t number, std::size_t count,
                                     const pipeline::StageRecord& record, bool ran) {
  clear_bar();
  switch (style_) {
    case Style::json:
      print_json({{"event", "stage_finished"},
                  {"stage", stage.name},
                  {"number", number},
                  {"count", count},
                  {"ran", ran},
                  {"seconds", ran ? record.seconds : 0.0},
                  {"peak_memory_mb", record.peak_memory_mb},
                  {"key", record.key}});
      break;
    case Style::bar:
    case Style::plain:
      fmt::print(
          stderr, "[{}/{}] {:<9} {}\n", number, count, stage.name,
          ran ? fmt::format("{:7.2f} s  {:5.0f} MB", record.seconds, record.peak_memory_mb) : "  up to date");
      break;
    case Style::none:
      break;
  }
}

}  // namespace drape::app
