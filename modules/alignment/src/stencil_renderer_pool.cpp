#include "stencil_renderer_pool.hpp"

#include <utility>

namespace drape::alignment {

StencilRendererPool::Lease::Lease(StencilRendererPool& pool) : pool_(pool) {
  {
    const std::scoped_lock lock(pool_.mutex_);
    if (!pool_.free_.empty()) {
      renderer_ = std::move(pool_.free_.back());
      pool_.free_.pop_back();
    }
  }
  if (renderer_ == nullptr)
    renderer_ = std::make_unique<rendering::StencilRenderer>(pool_.mesh_, pool_.width_, pool_.height_);
}

StencilRendererPool::Lease::~Lease() {
  const std::scoped_lock lock(pool_.mutex_);
  pool_.free_.push_back(std::move(renderer_));
}

}  // namespace drape::alignment
