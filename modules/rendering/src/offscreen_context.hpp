// One OSMesa context. What is made in it lives as long as it does.
#pragma once

#include <memory>

#include "gl_functions.hpp"

namespace drape::rendering {

/// Not to be used from two threads at once. Nothing is drawn into OSMesa's own colour buffer: pictures go to
/// a RenderTarget.
class OffscreenContext {
 public:
  /// OpenGL 4.5 core. Error{input} if this machine's OSMesa cannot.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// While it lives, the context is the calling thread's current one; then whatever was so before is again.
  class Current {
   public:
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    friend class OffscreenContext;
    struct Before;
    explicit Current(OffscreenContext& context);
    std::unique_ptr<Before> before_;
  };
  [[nodiscard]] Current make_current() { return Current(*this); }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drape::rendering
