#include "render_target.hpp"

#include "drape/base/error.hpp"

namespace drape::rendering {
namespace {

struct PixelFormat {
  GLenum storage;
  GLenum format;
  GLenum type;
};

PixelFormat pixel_format(RenderTarget::Kind kind) {
  switch (kind) {
    case RenderTarget::Kind::coverage:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE};
    case RenderTarget::Kind::faces:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
    case RenderTarget::Kind::colors:
      break;
  }
  return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
}

}  // namespace

void RenderTarget::allocate(int width, int height) {
  const GlFunctions& gl = gl_functions();
  gl.DeleteFramebuffers(1, &framebuffer_);
  gl.DeleteRenderbuffers(1, &color_);
  gl.DeleteRenderbuffers(1, &depth_);
  width_ = height_ = 0;
  gl.GenFramebuffers(1, &framebuffer_);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl.GenRenderbuffers(1, &color_);
  gl.BindRenderbuffer(GL_RENDERBUFFER, color_);
  gl.RenderbufferStorage(GL_RENDERBUFFER, pixel_format(kind_).storage, width, height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_);
  if (kind_ != Kind::coverage) {
    gl.GenRenderbuffers(1, &depth_);
    gl.BindRenderbuffer(GL_RENDERBUFFER, depth_);
    gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  }
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE || gl.GetError() != GL_NO_ERROR)
    throw Error(ErrorCode::try_again,
                fmt::format("no memory to draw a picture of {} x {} pixels", width, height));
  width_ = width;
  height_ = height;
}

void RenderTarget::begin(const Window& window, const Eigen::Vector3f& background) {
  const GlFunctions& gl = gl_functions();
  const int width = window.width * window.samples;
  const int height = window.height * window.samples;
  if (width != width_ || height != height_) allocate(width, height);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl.Viewport(0, 0, width, height);
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl.Disable(GL_CULL_FACE);

  if (kind_ == Kind::coverage) {
    gl.Disable(GL_DEPTH_TEST);
  } else {
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_GREATER);
    const float farthest = 0;
    gl.ClearBufferfv(GL_DEPTH, 0, &farthest);
  }
  if (kind_ == Kind::faces) {
    const GLuint no_face[4] = {~0U, ~0U, ~0U, ~0U};
    gl.ClearBufferuiv(GL_COLOR, 0, no_face);
  } else {
    const float color[4] = {background.x(), background.y(), background.z(), 1};
    gl.ClearBufferfv(GL_COLOR, 0, color);
  }
}

void RenderTarget::read(void* destination, int row_length) const {
  const GlFunctions& gl = gl_functions();
  const PixelFormat format = pixel_format(kind_);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.PixelStorei(GL_PACK_ROW_LENGTH, row_length);
  gl.ReadPixels(0, 0, width_, height_, format.format, format.type, destination);
}

}  // namespace drape::rendering
