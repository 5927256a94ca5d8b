// Depth of OpenEXR pictures, by OpenEXR's own library.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "drape/base/error.hpp"
#include "exr_depth.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

class BytesStream : public Imf::IStream {
 public:
  BytesStream(const std::string& file, std::string_view bytes) : IStream(file.c_str()), bytes_(bytes) {}

  bool read(char to[], int count) override {
    if (count < 0 || static_cast<std::size_t>(count) > bytes_.size() - at_)
      throw std::runtime_error("the file is truncated");
    std::memcpy(to, bytes_.data() + at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return at_ < bytes_.size();
  }
  uint64_t tellg() override { return at_; }
  void seekg(uint64_t at) override { at_ = std::min<std::size_t>(at, bytes_.size()); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

// The one channel that holds depth: the only one, or the one of that name (in any layer: "View.Depth.Z").
std::string depth_channel(const std::string& file, const Imf::ChannelList& channels) {
  std::vector<std::string> names;
  for (auto c = channels.begin(); c != channels.end(); ++c) names.emplace_back(c.name());
  if (names.size() == 1) return names.front();
  for (const std::string_view wanted : {"Z", "V", "Y", "R"})
    for (const std::string& name : names)
      if (name == wanted || name.ends_with("." + std::string(wanted))) return name;
  std::string known;
  for (const std::string& name : names) known += " " + shown(name);
  throw input_error("{}: none of its channels (OpenEXR:{}) is depth: one named Z, V, Y or R, or a single one",
                    file, known);
}

ImageF read_channel(const std::string& file, std::string_view bytes) {
  BytesStream stream(file, bytes);
  Imf::InputFile picture(stream, 0);
  const Imath::Box2i window = picture.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width <= 0 || height <= 0 || width > most_pixels / height)
    throw input_error("{}: a picture of {} x {} pixels", file, width, height);
  const Imf::ChannelList& channels = picture.header().channels();
  const std::string name = depth_channel(file, channels);
  const Imf::Channel& channel = channels[name.c_str()];
  if (channel.type == Imf::UINT || channel.xSampling != 1 || channel.ySampling != 1)
    throw input_error("{}: the channel {} does not hold one float a pixel", file, shown(name));
  // Even a picture of one value takes a byte for each line.
  if (static_cast<std::size_t>(height) > bytes.size())
    throw input_error("{}: {} lines are claimed, which {} bytes cannot hold", file, height, bytes.size());
  ImageF depth(static_cast<int>(width), static_cast<int>(height), 1);
  char* const first = reinterpret_cast<char*>(&depth.at(0, 0));
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(width * static_cast<std::int64_t>(sizeof(float)));
  Imf::FrameBuffer buffer;
  buffer.insert(
      name, Imf::Slice(Imf::FLOAT,
                       first - window.min.x * static_cast<std::ptrdiff_t>(sizeof(float)) - window.min.y * row,
                       sizeof(float), static_cast<std::size_t>(row)));
  picture.setFrameBuffer(buffer);
  picture.readPixels(window.min.y, window.max.y);
  return depth;
}

}  // namespace

bool looks_like_exr(std::string_view bytes) {
  return bytes.starts_with("\x76\x2f\x31\x01");
}

ImageF decode_exr_depth(const std::string& file, std::string_view bytes) {
  try {
    ImageF depth = read_channel(file, bytes);
    // Blender writes 1e10 where a ray met nothing.
    constexpr float nothing = 1e10F;
    for (int y = 0; y < depth.height(); ++y)
      for (int x = 0; x < depth.width(); ++x)
        if (!(depth.at(x, y) < nothing)) depth.at(x, y) = 0;
    return depth;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& problem) {
    throw input_error("{}: is no whole OpenEXR picture: {}", file, shown(problem.what()));
  }
}

}  // namespace drape::io
