// Renderers of one mesh for as many threads as there happen to be.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "drape/rendering/stencil_renderer.hpp"

namespace drape::alignment {

/// Makes a renderer when a thread asks for one and none is free. The mesh must outlive the pool.
class StencilRendererPool {
 public:
  StencilRendererPool(const TriangleMesh& mesh, int width, int height)
      : mesh_(mesh), width_(width), height_(height) {}

  /// A renderer for one thread, given back when it goes out of scope.
  class Lease {
   public:
    explicit Lease(StencilRendererPool& pool);
    ~Lease();
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    [[nodiscard]] rendering::StencilRenderer& renderer() { return *renderer_; }

   private:
    StencilRendererPool& pool_;
    std::unique_ptr<rendering::StencilRenderer> renderer_;
  };

 private:
  const TriangleMesh& mesh_;
  int width_;
  int height_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<rendering::StencilRenderer>> free_;
};

}  // namespace drape::alignment
