// Rays against a triangle mesh, under the name by which the virtual world knows them.
#pragma once

#include "drape/geometry/ray_caster.hpp"

namespace drape::simulation {

using drape::RayCaster;
using drape::RayHit;

}  // namespace drape::simulation
