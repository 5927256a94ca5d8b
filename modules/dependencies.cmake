# Every library that drape uses, as targets that only the modules that need them link.
# Third-party headers are SYSTEM: their warnings are not ours.

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(nlohmann_json REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nanoflann REQUIRED)
find_package(meshoptimizer REQUIRED)
pkg_check_modules(LCMS2 REQUIRED IMPORTED_TARGET lcms2)
pkg_check_modules(OPENEXR REQUIRED IMPORTED_TARGET OpenEXR)
pkg_check_modules(PUGIXML REQUIRED IMPORTED_TARGET pugixml)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib)
pkg_check_modules(OSMESA REQUIRED IMPORTED_TARGET osmesa)

# CGAL is header-only here; its own CMake package changes global flags, so only its libraries are taken.
find_path(DRAPE_CGAL_INCLUDE_DIR CGAL/version.h REQUIRED)
find_library(DRAPE_GMP_LIBRARY gmp REQUIRED)
find_library(DRAPE_MPFR_LIBRARY mpfr REQUIRED)
add_library(drape_cgal INTERFACE)
target_include_directories(drape_cgal SYSTEM INTERFACE ${DRAPE_CGAL_INCLUDE_DIR})
target_compile_definitions(drape_cgal INTERFACE CGAL_EIGEN3_ENABLED CGAL_LINKED_WITH_TBB CGAL_HEADER_ONLY=1
                                                CGAL_NDEBUG)
# CGAL's kernels ask for IEEE rounding that -frounding-math keeps (CGAL manual, "Compiler flags").
target_compile_options(drape_cgal INTERFACE -frounding-math)
target_link_libraries(drape_cgal INTERFACE Eigen3::Eigen TBB::tbb ${DRAPE_GMP_LIBRARY} ${DRAPE_MPFR_LIBRARY}
                                           Threads::Threads)

# find_package(PCL) drags VTK and Qt into the compile flags and the link line, so PCL's plain libraries are found.
file(GLOB drape_pcl_include_candidates /usr/include/pcl-* /usr/local/include/pcl-*)
find_path(DRAPE_PCL_INCLUDE_DIR pcl/pcl_config.h HINTS ${drape_pcl_include_candidates} REQUIRED)
find_package(Boost REQUIRED)
add_library(drape_pcl INTERFACE)
target_include_directories(drape_pcl SYSTEM INTERFACE ${DRAPE_PCL_INCLUDE_DIR})
target_link_libraries(drape_pcl INTERFACE Eigen3::Eigen Boost::headers)
foreach(component common kdtree search octree filters features sample_consensus registration)
  find_library(DRAPE_PCL_${component}_LIBRARY pcl_${component} REQUIRED)
  target_link_libraries(drape_pcl INTERFACE ${DRAPE_PCL_${component}_LIBRARY})
endforeach()
pkg_check_modules(FLANN REQUIRED IMPORTED_TARGET flann)
target_link_libraries(drape_pcl INTERFACE PkgConfig::FLANN)

# OpenCV's CMake package comes only with the package that brings Qt along, so its plain libraries are found.
find_path(DRAPE_OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
add_library(drape_opencv INTERFACE)
target_include_directories(drape_opencv SYSTEM INTERFACE ${DRAPE_OPENCV_INCLUDE_DIR})
foreach(component core imgproc imgcodecs ml)
  find_library(DRAPE_OPENCV_${component}_LIBRARY opencv_${component} REQUIRED)
  target_link_libraries(drape_opencv INTERFACE ${DRAPE_OPENCV_${component}_LIBRARY})
endforeach()
