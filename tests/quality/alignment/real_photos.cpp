#include "real_photos.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "drape/base/files.hpp"
#include "drape/io/photo.hpp"
#include "support.hpp"

namespace drape::lab {
namespace {

namespace fs = std::filesystem;

constexpr double dino_threshold = 0.19;
constexpr int dino_dilate_px = 10;
constexpr int dino_erode_px = 7;

Eigen::Matrix3d matrix_of(const nlohmann::json& rows) {
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      matrix(i, j) = rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j)).get<double>();
  return matrix;
}

// Pixel centres lie at whole numbers in that file.
Camera camera_of(const nlohmann::json& item, const io::ImageSize& size) {
  Camera camera;
  camera.width = size.width;
  camera.height = size.height;
  camera.K = matrix_of(item.at("K"));
  camera.K.topRightCorner<2, 1>().array() += 0.5;
  camera.camera_from_world.linear() = matrix_of(item.at("R"));
  const auto t = item.at("t").get<std::vector<double>>();
  camera.camera_from_world.translation() = Eigen::Vector3d(t.at(0), t.at(1), t.at(2));
  return camera;
}

cv::Mat disc(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
}

}  // namespace

std::vector<PosedPhoto> posed_photos(const std::string& prefix) {
  std::vector<PosedPhoto> photos;
  if (!test::have_data("photos/poses.json")) return photos;
  const auto poses = nlohmann::json::parse(read_file(test::data("photos/poses.json")));
  for (const auto& item : poses.at("items")) {
    PosedPhoto photo;
    photo.name = item.at("id").get<std::string>();
    photo.image = test::data(item.at("image").get<std::string>());
    if (!photo.name.starts_with(prefix) || !fs::exists(photo.image)) continue;
    const auto mesh = item.at("mesh").get<std::string>();
    if (test::have_data(mesh)) photo.mesh = test::data(mesh);
    photo.truth = camera_of(item, io::read_photo_size(photo.image));
    photos.push_back(std::move(photo));
  }
  return photos;
}

Image8 dino_stencil(const Image8& rgb) {
  cv::Mat bright(rgb.height(), rgb.width(), CV_8U);
  for (int y = 0; y < rgb.height(); ++y)
    for (int x = 0; x < rgb.width(); ++x)
      bright.at<std::uint8_t>(y, x) =
          std::max({rgb.at(x, y, 0), rgb.at(x, y, 1), rgb.at(x, y, 2)}) > 255 * dino_threshold ? 255 : 0;
  cv::dilate(bright, bright, disc(dino_dilate_px));
  cv::erode(bright, bright, disc(dino_erode_px));
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(bright, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  Image8 stencil(rgb.width(), rgb.height(), 1, stencil::background);
  if (contours.empty()) return stencil;
  const auto largest = std::max_element(contours.begin(), contours.end(), [](const auto& a, const auto& b) {
    return cv::contourArea(a) < cv::contourArea(b);
  });
  cv::Mat picture(rgb.height(), rgb.width(), CV_8U, stencil.data().data());
  cv::drawContours(picture, contours, static_cast<int>(largest - contours.begin()),
                   cv::Scalar(stencil::object), cv::FILLED);
  return stencil;
}

TriangleMesh dino_hull(const std::vector<Outline>& outlines) {
  const BoundingBox box(Eigen::Vector3d(-0.046, -0.003, -0.042), Eigen::Vector3d(0.035, 0.092, 0.040));
  return visual_hull(outlines, box, 0.0006);
}

std::vector<MaskedPhoto> masked_photos() {
  std::vector<MaskedPhoto> photos;
  if (!test::have_data("segmentation")) return photos;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(test::data("segmentation")))
    if (entry.path().extension() != ".png") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const fs::path mask = file.parent_path() / (file.stem().string() + "_gt.png");
    if (!fs::exists(mask)) continue;
    MaskedPhoto photo{file.stem().string(), io::read_photo(file).rgb, {}};
    photo.stencil = io::read_stencil(mask, photo.rgb.width(), photo.rgb.height());
    photos.push_back(std::move(photo));
  }
  return photos;
}

}  // namespace drape::lab
