#include "drape/base/progress.hpp"

#include <algorithm>

#include "drape/base/error.hpp"

namespace drape {

void Progress::update(double fraction, std::string_view what) const {
  if (stop_requested()) throw Interrupted();
  if (report_) report_(from_ + std::clamp(fraction, 0.0, 1.0) * (to_ - from_), what);
}

Progress Progress::part(double from, double to) const {
  Progress sub = *this;
  sub.from_ = from_ + from * (to_ - from_);
  sub.to_ = from_ + to * (to_ - from_);
  return sub;
}

}  // namespace drape
