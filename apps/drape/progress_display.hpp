// Shows how far a run is: a bar on a terminal, plain lines elsewhere, JSON lines for programs.
#pragma once

#include <chrono>
#include <string>

#include "drape/pipeline/engine.hpp"

namespace drape::app {

enum class ProgressMode { automatic, plain, json, none };

class ProgressDisplay : public pipeline::RunObserver {
 public:
  /// automatic: a bar if standard error is a terminal, else plain lines. All output goes to standard error.
  explicit ProgressDisplay(ProgressMode mode);
  ~ProgressDisplay() override;
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void stage_started(const pipeline::Stage& stage, std::size_t number, std::size_t count,
                     const std::string& why) override;
  void stage_progress(const pipeline::Stage& stage, double fraction, std::string_view what) override;
  void stage_finished(const pipeline::Stage& stage, std::size_t number, std::size_t count,
                      const pipeline::StageRecord& record, bool ran) override;

  /// For work that is no stage: the same display.
  void show(const std::string& title, double fraction, std::string_view what);

 private:
  enum class Style { bar, plain, json, none };
  void clear_bar();

  Style style_;
  bool bar_shown_ = false;
  std::string title_;
  std::chrono::steady_clock::time_point last_shown_{};
  double last_fraction_ = 0;
};

}  // namespace drape::app
