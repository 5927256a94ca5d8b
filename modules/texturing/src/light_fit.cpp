#include "light_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "light_problem.hpp"

namespace drape::texturing {
namespace {

using Eigen::Array3d;
using Eigen::Vector3d;

constexpr double worth_a_lamp = 0.997;     // of the cost without it
constexpr double candidate_radius = 0.05;  // rad
// Medians of how far the logs of two photos' albedos are apart.
constexpr double alike = 0.05;            // under one light: as much as noise and small shifts make
constexpr double worth_own_lights = 0.7;  // of what it is under one light

double median_of(std::vector<double>& values) {  // not of none
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void add_column(LightShape& light, const Lamp& lamp, std::vector<float> column) {
  light.values.conservativeResize(light.values.size() + 1);
  light.values[light.values.size() - 1] = 0.3;
  light.lamps.push_back(std::move(column));
  light.places.push_back(lamp);
}

std::vector<float> column_towards(const LightEvidence& e, const std::vector<std::uint8_t>& lit,
                                  const Vector3d& towards) {
  std::vector<float> column(e.samples.size());
  for (std::size_t i = 0; i < column.size(); ++i)
    column[i] = static_cast<float>(std::max(0.0, e.samples[i].place.normal.dot(towards)) * lit[i] / 255);
  return column;
}

// Whether a lamp explains the photos under one light better; where it does, it is added.
bool add_lamp(const LightEvidence& e, const std::vector<std::vector<std::uint8_t>>& lit_samples,
              const LampLight& lamp_light, int shape, Lights& lights) {
  constexpr int quick = 3;
  const auto at = static_cast<std::size_t>(shape);
  const LightProblem coarse = problem_of_one(e, lights, shape, 1500);
  const std::vector<Vector3d>& directions = LightTransfer::directions();
  std::vector<double> costs(directions.size());
  parallel_for(directions.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t d = begin; d < end; ++d) {
      Lights with = lights;
      add_column(with.shapes[at], {directions[d], candidate_radius, {}},
                 column_towards(e, lit_samples[d], directions[d]));
      costs[d] = refine(coarse, with, quick);
    }
  });
  const auto best = static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
  const LightProblem fine = problem_of_one(e, lights, shape, 8000);
  Lights without = lights;
  const double plain = refine(fine, without, 2 * quick);
  Lamp lamp{directions[best], candidate_radius, {}};
  double cost = std::numeric_limits<double>::infinity();
  Lights found;
  const auto attempt = [&](const Vector3d& towards, double radius) {
    Lights with = lights;
    add_column(with.shapes[at], {towards, radius, {}}, lamp_light(towards, radius));
    const double now = refine(fine, with, 2 * quick);
    if (!(now < cost)) return false;
    cost = now;
    lamp = {towards, radius, {}};
    found = std::move(with);
    return true;
  };
  attempt(lamp.towards, lamp.radius_rad);
  for (double step = 0.08; step > 0.015; step /= 2) {
    for (int k = 0; k < 4; ++k) {
      const Vector3d u = lamp.towards.unitOrthogonal();
      const Vector3d v = lamp.towards.cross(u);
      const double around = std::numbers::pi / 2 * k;
      attempt((lamp.towards + step * (std::cos(around) * u + std::sin(around) * v)).normalized(),
              lamp.radius_rad);
    }
  }
  for (const double radius : {0.12, 0.25}) attempt(lamp.towards, radius);
  if (cost > worth_a_lamp * plain) {
    lights = std::move(without);
    return false;
  }
  lights = std::move(found);
  return true;
}

// Up to two lamps for each light, and all lights at once.
double fit(const LightEvidence& e, const std::vector<std::vector<std::uint8_t>>& lit_samples,
           const LampLight& lamp_light, const Progress& progress, Lights& lights) {
  constexpr int thorough = 15;
  const LightProblem all = problem_of_all(e, lights);
  double cost = refine(all, lights, thorough);
  const auto shapes = static_cast<int>(lights.shapes.size());
  for (int l = 0; l < most_lamps; ++l) {
    bool any = false;
    for (int i = 0; i < shapes; ++i) {
      progress.update((l + static_cast<double>(i) / shapes) / most_lamps, "looking for lamps");
      // A second one only where there is a first.
      if (lights.shapes[static_cast<std::size_t>(i)].lamps.size() == static_cast<std::size_t>(l))
        any = add_lamp(e, lit_samples, lamp_light, i, lights) || any;
    }
    if (!any) break;
    cost = refine(all, lights, thorough);
  }
  return cost;
}

// Median over shared points and channels of how far the logs of two photos' albedos are apart.
double apart(const LightEvidence& e, const Lights& lights) {
  std::vector<double> values;
  for (const SharedPoint& shared : e.shared) {
    const LightSample& sample = e.samples[shared.sample];
    const Array3d difference = (sample.log_color - shared.log_color).cast<double>().array() -
                               log_shading(lights, e, shared.sample, sample.photo) +
                               log_shading(lights, e, shared.sample, shared.photo);
    for (const double d : difference) values.push_back(std::abs(d));
  }
  return values.empty() ? 0 : median_of(values);
}

// The mean log shading becomes 0, in each channel.
void normalize(const LightEvidence& e, Lights& lights) {
  Array3d sum = Array3d::Zero();
  for (std::uint32_t i = 0; i < e.samples.size(); ++i) sum += log_shading(lights, e, i, e.samples[i].photo);
  const Array3d mean = sum / static_cast<double>(std::max<std::size_t>(1, e.samples.size()));
  for (Array3d& gain : lights.gains) gain -= mean;
}

PhotoLight light_of(const Lights& lights, std::size_t photo) {
  const LightShape& shape = lights.shapes[static_cast<std::size_t>(lights.shape_of[photo])];
  const Array3d gain = lights.gains[photo].exp();
  PhotoLight light;
  light.around = harmonic_scale * shape.values.head<transfer_size>() * gain.matrix().transpose();
  light.darkest = least_shading * gain;
  light.lamps = shape.places;
  for (std::size_t l = 0; l < light.lamps.size(); ++l)
    light.lamps[l].color = shape.values[transfer_size + static_cast<Eigen::Index>(l)] * gain;
  return light;
}

}  // namespace

Array3d PhotoLight::shading(const Transfer& transfer, std::span<const float> lamp_light) const {
  Array3d sum = (around.transpose() * transfer.cast<double>()).array();
  for (std::size_t l = 0; l < lamps.size(); ++l) sum += lamps[l].color * static_cast<double>(lamp_light[l]);
  return sum.max(darkest);
}

std::vector<PhotoLight> fitted_lights(const LightEvidence& evidence,
                                      const std::vector<std::vector<std::uint8_t>>& lit_samples,
                                      const LampLight& lamp_light, const Progress& progress) {
  Lights lights = even_lights(evidence.photos, true);
  fit(evidence, lit_samples, lamp_light, progress.part(0, 0.3), lights);
  const double together = apart(evidence, lights);
  if (together > alike) {
    Lights own = even_lights(evidence.photos, false);
    fit(evidence, lit_samples, lamp_light, progress.part(0.3, 1), own);
    if (apart(evidence, own) < worth_own_lights * together) lights = std::move(own);
  }
  normalize(evidence, lights);
  std::vector<PhotoLight> result;
  for (std::size_t i = 0; i < lights.gains.size(); ++i) result.push_back(light_of(lights, i));
  return result;
}

Arrivals arrivals_of(const std::vector<PhotoLight>& lights, const LampLight& lamp_light) {
  Arrivals arrivals(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i)
    for (const Lamp& lamp : lights[i].lamps) arrivals[i].push_back(lamp_light(lamp.towards, lamp.radius_rad));
  return arrivals;
}

Array3d shading_at(const LightSample& sample, std::size_t index, const PhotoLight& light,
                   const std::vector<std::vector<float>>& arrivals) {
  std::vector<float> arrives;
  for (const std::vector<float>& lamp : arrivals) arrives.push_back(lamp[index]);
  return light.shading(sample.transfer, arrives);
}

AlbedoSpread albedo_spread(const LightEvidence& evidence, const std::vector<PhotoLight>& lights,
                           const Arrivals& arrivals) {
  if (evidence.shared.empty()) return {};
  const auto log_shading = [&](std::uint32_t sample, int photo) {
    const auto p = static_cast<std::size_t>(photo);
    return Array3d(shading_at(evidence.samples[sample], sample, lights[p], arrivals[p]).log());
  };
  // Exposures are matched pair by pair: by the median difference.
  const auto spread = [&](bool lit) {
    std::vector<std::vector<double>> of_pairs(
        static_cast<std::size_t>(evidence.photos * evidence.photos * 3));
    for (const SharedPoint& shared : evidence.shared) {
      const LightSample& sample = evidence.samples[shared.sample];
      Array3d difference = (sample.log_color - shared.log_color).cast<double>().array();
      if (lit)
        difference += log_shading(shared.sample, shared.photo) - log_shading(shared.sample, sample.photo);
      for (int c = 0; c < 3; ++c)
        of_pairs[static_cast<std::size_t>((sample.photo * evidence.photos + shared.photo) * 3 + c)].push_back(
            difference[c]);
    }
    std::vector<double> apart;
    for (std::vector<double>& values : of_pairs) {
      if (values.empty()) continue;
      const double middle = lit ? 0 : median_of(values);
      for (const double v : values) apart.push_back(std::abs(v - middle));
    }
    return median_of(apart);
  };
  return {spread(false), spread(true)};
}

}  // namespace drape::texturing
