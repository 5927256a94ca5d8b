// What a photo shows: the subject and what is about it, and what each ray meets.
#pragma once

#include <optional>
#include <vector>

#include "drape/geometry/ray_caster.hpp"
#include "drape/simulation/virtual_camera.hpp"

namespace drape::simulation {

struct SurfacePoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;     // unit, on the side that is seen
  Eigen::Vector3f albedo;     // linear
  Eigen::Vector3f sky_light;  // irradiance from everything but the sun, linear
  double gloss = 0;
  bool subject = false;
};

class Scene {
 public:
  Scene(const Subject& subject, const Camera& camera, const PhotoStyle& style);

  /// What the ray meets first; nothing above the wall's and table's horizon.
  [[nodiscard]] std::optional<SurfacePoint> look(const Eigen::Vector3d& origin,
                                                 const Eigen::Vector3d& direction) const;
  /// Whether the first thing that the ray meets is the subject.
  [[nodiscard]] bool sees_subject(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  /// Whether light from `direction` (unit) reaches a surface.
  [[nodiscard]] bool lit_from(const SurfacePoint& point, const Eigen::Vector3d& direction) const;

  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] const Eigen::Matrix3d& world_from_set() const { return world_from_set_; }

 private:
  struct Thing {
    Subject what;  // its mesh is part of mesh_
    Eigen::Affine3d own_from_world;
    std::uint32_t first_face;
  };

  void place(Subject what, const Eigen::Affine3d& world_from_own);
  void place_clutter();
  void light_vertices();
  void light_table();
  [[nodiscard]] Eigen::Vector3f sky_light(const Eigen::Vector3d& position,
                                          const Eigen::Vector3d& normal) const;
  [[nodiscard]] SurfacePoint on_thing(const RayHit& hit, const Eigen::Vector3d& direction) const;
  [[nodiscard]] SurfacePoint on_table(const Eigen::Vector3d& position) const;
  [[nodiscard]] SurfacePoint on_wall(const Eigen::Vector3d& position) const;

  PhotoStyle style_;
  double size_ = 0;         // radius of the subject's bounding sphere
  Eigen::Vector3d center_;  // on the table, under the middle of the subject
  Eigen::Matrix3d
      world_from_set_;         // the set's axes: x to the right as the camera sees it, y away from it, z up
  double wall_ = 0;            // its distance behind the center
  std::vector<Thing> things_;  // the subject is the first
  TriangleMesh mesh_;          // all of them in the world
  std::optional<RayCaster> caster_;
  std::vector<Eigen::Vector3f> vertex_light_;
  std::vector<Eigen::Vector3f> table_light_;  // on a square lattice about the center
};

/// Paint of the table and of the wall: position in the set, in metres for a subject of 0.1 m radius. sRGB.
[[nodiscard]] Eigen::Vector3f table_paint(Table table, const Eigen::Vector2d& position);
[[nodiscard]] Eigen::Vector3f wall_paint(Table table, const Eigen::Vector2d& position);

/// sRGB's transfer function (IEC 61966-2-1), per channel.
[[nodiscard]] Eigen::Vector3f linear_from_srgb(const Eigen::Vector3f& color);
[[nodiscard]] Eigen::Vector3f srgb_from_linear(const Eigen::Vector3f& color);

}  // namespace drape::simulation
