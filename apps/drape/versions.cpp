#include "versions.hpp"

#include <CGAL/version.h>
#include <pcl/pcl_config.h>

#include <opencv2/core/version.hpp>

#include "commands.hpp"

namespace drape::app {

std::vector<std::pair<std::string, std::string>> versions() {
  return {{"drape", DRAPE_VERSION},
          {"compiler", DRAPE_COMPILER},
          {"PCL", PCL_VERSION_PRETTY},
          {"CGAL", CGAL_VERSION_STR},
          {"OpenCV", CV_VERSION},
          {"Eigen", DRAPE_EIGEN_VERSION},
          {"OSMesa", DRAPE_OSMESA_VERSION},
          {"TBB", DRAPE_TBB_VERSION},
          {"yaml-cpp", DRAPE_YAML_CPP_VERSION},
          {"CLI11", DRAPE_CLI11_VERSION},
          {"spdlog", DRAPE_SPDLOG_VERSION},
          {"nlohmann-json", DRAPE_JSON_VERSION},
          {"nanoflann", DRAPE_NANOFLANN_VERSION},
          {"meshoptimizer", DRAPE_MESHOPTIMIZER_VERSION}};
}

}  // namespace drape::app
