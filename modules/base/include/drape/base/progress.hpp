// How far a long computation is, and whether it should stop.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>

namespace drape {

/// Handed by value to every long function. `update(fraction)` both reports and, when an interrupt was asked
/// for, throws Interrupted; so no caller can forget to look. A default-constructed Progress reports nowhere.
/// Call update from one thread at a time; stop_requested may be called from any.
class Progress {
 public:
  /// Receives the overall fraction in 0..1 and what is being done now.
  using Report = std::function<void(double fraction, std::string_view what)>;

  Progress() = default;
  /// `stop` may be null; it must outlive the Progress (a signal handler's flag does).
  Progress(Report report, const std::atomic<bool>* stop) : report_(std::move(report)), stop_(stop) {}

  /// fraction: 0..1 of this Progress's own share. Throws Interrupted.
  void update(double fraction, std::string_view what = {}) const;

  [[nodiscard]] bool stop_requested() const {
    return stop_ != nullptr && stop_->load(std::memory_order_relaxed);
  }

  /// A Progress whose 0..1 is from..to of this one: for a step within a longer computation.
  [[nodiscard]] Progress part(double from, double to) const;

 private:
  Report report_;
  const std::atomic<bool>* stop_ = nullptr;
  double from_ = 0.0;
  double to_ = 1.0;
};

}  // namespace drape
