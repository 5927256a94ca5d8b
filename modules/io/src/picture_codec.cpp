#include "picture_codec.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <mutex>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/io/photo.hpp"
#include "srgb_tags.hpp"

namespace drape::io {
namespace {

/// Errors come to the user once, as ours.
void silence_opencv() {
  static const bool done = [] {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
    return true;
  }();
  (void)done;
}

std::uint8_t to_byte(std::uint8_t value) {
  return value;
}
std::uint8_t to_byte(std::uint16_t value) {
  return byte_from_deep(value);
}

/// While one lives, std::cerr says nothing: OpenCV's imdecode reports there what it also returns. (drape's
/// log does not use that stream.)
class QuietStream {
 public:
  QuietStream() {
    const std::scoped_lock lock(mutex());
    if (count()++ == 0) kept() = std::cerr.rdbuf(nullptr);
  }
  ~QuietStream() {
    const std::scoped_lock lock(mutex());
    if (--count() > 0) return;
    std::cerr.rdbuf(kept());
    std::cerr.clear();
  }
  QuietStream(const QuietStream&) = delete;
  QuietStream& operator=(const QuietStream&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex m;
    return m;
  }
  static int& count() {
    static int n = 0;
    return n;
  }
  static std::streambuf*& kept() {
    static std::streambuf* buffer = nullptr;
    return buffer;
  }
};

template <class Sample>
DecodedPicture converted(const cv::Mat& mat) {
  const int channels = mat.channels();
  DecodedPicture picture{Image8(mat.cols, mat.rows, channels), true};
  // OpenCV keeps blue first.
  const std::array<int, 4> source =
      channels >= 3 ? std::array<int, 4>{2, 1, 0, 3} : std::array<int, 4>{0, 1, 2, 3};
  const auto row_samples = static_cast<std::size_t>(mat.cols * channels);
  Sample most = 0;
  for (int y = 0; y < mat.rows; ++y)
    most = std::max(most, *std::max_element(mat.ptr<Sample>(y), mat.ptr<Sample>(y) + row_samples));
  picture.only_zeros_and_ones = most <= 1;
  for (int y = 0; y < mat.rows; ++y) {
    const Sample* row = mat.ptr<Sample>(y);
    const auto out = picture.pixels.row(y);
    for (int x = 0; x < mat.cols; ++x)
      for (int c = 0; c < channels; ++c) {
        const Sample value = row[x * channels + source[static_cast<std::size_t>(c)]];
        // Labels 0 and 1 of a 16-bit mask would both become 0.
        out[static_cast<std::size_t>(x * channels + c)] =
            picture.only_zeros_and_ones ? static_cast<std::uint8_t>(value) : to_byte(value);
      }
  }
  return picture;
}

Image16 deep_rgb(const cv::Mat& mat) {
  Image16 rgb(mat.cols, mat.rows, 3);
  for (int y = 0; y < mat.rows; ++y)
    for (int x = 0; x < mat.cols; ++x)
      for (int c = 0; c < 3; ++c)
        rgb.at(x, y, c) = mat.ptr<std::uint16_t>(y)[x * mat.channels() + (mat.channels() >= 3 ? 2 - c : 0)];
  return rgb;
}

template <class Sample>
cv::Mat mat_of(const Image<Sample>& image) {
  const int channels = image.channels();
  cv::Mat mat(image.height(), image.width(), CV_MAKETYPE(cv::DataType<Sample>::depth, channels));
  const std::array<int, 4> source =
      channels >= 3 ? std::array<int, 4>{2, 1, 0, 3} : std::array<int, 4>{0, 1, 2, 3};
  for (int y = 0; y < mat.rows; ++y) {
    const auto row = image.row(y);
    Sample* out = mat.ptr<Sample>(y);
    for (int x = 0; x < mat.cols; ++x)
      for (int c = 0; c < channels; ++c)
        out[x * channels + c] =
            row[static_cast<std::size_t>(x * channels + source[static_cast<std::size_t>(c)])];
  }
  return mat;
}

/// JPEG has no alpha.
Image8 without_alpha(const Image8& image) {
  Image8 rgb(image.width(), image.height(), 3);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < 3; ++c) rgb.at(x, y, c) = image.at(x, y, c);
  return rgb;
}

/// As OpenCV has it.
cv::Mat decoded(const std::string& file, std::string_view bytes) {
  silence_opencv();
  cv::Mat mat;
  try {
    const cv::Mat raw(1, static_cast<int>(std::min<std::size_t>(bytes.size(), INT_MAX)), CV_8U,
                      const_cast<char*>(bytes.data()));
    const QuietStream quiet;
    mat = cv::imdecode(raw, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    throw input_error("{}: the picture is damaged: it cannot be decoded", file);
  }
  if (mat.empty()) throw input_error("{}: the picture is damaged: it cannot be decoded", file);
  return mat;
}

/// The bytes of a file of the kind that its extension names; nothing where OpenCV cannot make them.
std::optional<std::string> encoded(const char* extension, const cv::Mat& mat,
                                   const std::vector<int>& parameters) {
  std::vector<std::uint8_t> bytes;
  try {
    if (!cv::imencode(extension, mat, bytes, parameters)) return std::nullopt;
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace

ImageF decode_depth(const std::string& file, std::string_view bytes) {
  const cv::Mat mat = decoded(file, bytes);
  if (mat.channels() != 1 || (mat.depth() != CV_16U && mat.depth() != CV_32F))
    throw input_error("{}: a depth picture has one channel of 16-bit numbers or floats", file);
  ImageF depth(mat.cols, mat.rows, 1);
  for (int y = 0; y < mat.rows; ++y)
    for (int x = 0; x < mat.cols; ++x)
      depth.at(x, y) =
          mat.depth() == CV_16U ? static_cast<float>(mat.at<std::uint16_t>(y, x)) : mat.at<float>(y, x);
  return depth;
}

DecodedPicture decode_picture(const std::string& file, std::string_view bytes, bool keep_depth) {
  const cv::Mat mat = decoded(file, bytes);
  if (mat.channels() == 1 || mat.channels() == 3 || mat.channels() == 4) {
    if (mat.depth() == CV_8U) return converted<std::uint8_t>(mat);
    if (mat.depth() == CV_16U) {
      DecodedPicture picture = converted<std::uint16_t>(mat);
      if (keep_depth) picture.deep_rgb = deep_rgb(mat);
      return picture;
    }
  }
  throw input_error("{}: holds neither 8-bit nor 16-bit grey or colour values: convert it to PNG first",
                    file);
}

std::string encode_image(const Image8& image, const std::string& format, int jpeg_quality, Samples samples) {
  silence_opencv();
  const bool jpeg = format == "jpg" || format == "jpeg";
  if (!jpeg && format != "png") throw io_error("pictures are written as png or jpg, not as \"{}\"", format);
  if (image.empty() || image.channels() == 2 || image.channels() > 4)
    throw Error(ErrorCode::bug, "an image without pixels or with 2 channels cannot be written");
  std::vector<int> parameters;
  if (jpeg) parameters = {cv::IMWRITE_JPEG_QUALITY, std::clamp(jpeg_quality, 1, 100)};
  auto bytes = encoded(jpeg ? ".jpg" : ".png",
                       mat_of(jpeg && image.channels() == 4 ? without_alpha(image) : image), parameters);
  if (!bytes)
    throw io_error("an image of {} x {} pixels cannot be written as {}", image.width(), image.height(),
                   format);
  if (image.channels() < 3 || samples != Samples::srgb) return *std::move(bytes);
  return jpeg ? srgb_jpeg(*std::move(bytes)) : srgb_png(*std::move(bytes));
}

std::string encode_tiff(const Image16& image) {
  silence_opencv();
  if (image.channels() != 3 || image.empty())
    throw Error(ErrorCode::bug, "a TIFF is written of three channels");
  constexpr int lzw = 5;
  auto bytes = encoded(".tif", mat_of(image), {cv::IMWRITE_TIFF_COMPRESSION, lzw});
  if (!bytes)
    throw io_error("an image of {} x {} pixels cannot be written as TIFF", image.width(), image.height());
  return srgb_tiff(*std::move(bytes));
}

void write_image(const std::filesystem::path& file, const Image8& image, int jpeg_quality) {
  const std::string format = extension(file);
  if (format != "png" && format != "jpg" && format != "jpeg")
    throw io_error("{}: pictures are written as .png or .jpg", file.string());
  write_file(file, encode_image(image, format, jpeg_quality));
}

void write_tiff(const std::filesystem::path& file, const Image16& image) {
  write_file(file, encode_tiff(image));
}

}  // namespace drape::io
