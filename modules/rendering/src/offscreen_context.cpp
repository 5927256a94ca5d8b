#include "offscreen_context.hpp"

#include <GL/osmesa.h>

#include <array>

#include "drape/base/error.hpp"

namespace drape::rendering {
namespace {

constexpr int dummy_side = 4;

}  // namespace

struct OffscreenContext::Impl {
  OSMesaContext context = nullptr;
  // OSMesa wants a colour buffer of the caller's even where none is drawn to.
  std::array<std::uint32_t, dummy_side * dummy_side> dummy{};
};

OffscreenContext::OffscreenContext() : impl_(std::make_unique<Impl>()) {
  const std::array<int, 13> attributes{OSMESA_FORMAT,
                                       OSMESA_RGBA,
                                       OSMESA_DEPTH_BITS,
                                       24,
                                       OSMESA_PROFILE,
                                       OSMESA_CORE_PROFILE,
                                       OSMESA_CONTEXT_MAJOR_VERSION,
                                       4,
                                       OSMESA_CONTEXT_MINOR_VERSION,
                                       5,
                                       0,
                                       0,
                                       0};
  impl_->context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (impl_->context == nullptr)
    throw input_error("OSMesa cannot make an OpenGL 4.5 context; install a Mesa with llvmpipe (libosmesa6)");
}

OffscreenContext::~OffscreenContext() {
  if (impl_ != nullptr && impl_->context != nullptr) OSMesaDestroyContext(impl_->context);
}

struct OffscreenContext::Current::Before {
  OSMesaContext context = nullptr;
  void* buffer = nullptr;
  GLint width = 0;
  GLint height = 0;
};

OffscreenContext::Current::Current(OffscreenContext& context) {
  before_ = std::make_unique<Before>();
  before_->context = OSMesaGetCurrentContext();
  if (before_->context != nullptr) {
    GLint format = 0;
    OSMesaGetColorBuffer(before_->context, &before_->width, &before_->height, &format, &before_->buffer);
  }
  Impl& impl = *context.impl_;
  if (OSMesaMakeCurrent(impl.context, impl.dummy.data(), GL_UNSIGNED_BYTE, dummy_side, dummy_side) == 0)
    throw input_error("OSMesa cannot use its context in this thread");
}

OffscreenContext::Current::~Current() {
  if (before_->context == nullptr)
    OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
  else
    OSMesaMakeCurrent(before_->context, before_->buffer, GL_UNSIGNED_BYTE, before_->width, before_->height);
}

}  // namespace drape::rendering
