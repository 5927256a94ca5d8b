#include "light_problem.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace drape::texturing {
namespace {

using Eigen::Array3d;
using Row = LightShape::Row;

constexpr double even = 0.02;          // log differences as small as this are noise
constexpr double shared_weight = 2;    // of the same point in two photos, to neighbours in one
constexpr double ridge = 2e-2;         // against lights that the photos say nothing of
constexpr double weak = 0.01;          // of the ridge: for brightness, which photos do not tell
constexpr double noise_light = 0.008;  // linear: channels about as dark as this count less

// log, but a line below least_shading, so that every step has a slope.
double log_of(double s) {
  return s >= least_shading ? std::log(s) : std::log(least_shading) + s / least_shading - 1;
}
double slope_of(double s) {
  return 1 / std::max(s, least_shading);
}

// The log shading of one photo at one sample, and how it goes with the light.
struct Shade {
  int photo;
  int shape;
  Row row;
  Array3d log;
  double slope;
};
Shade shade_of(const Lights& lights, const LightEvidence& e, std::uint32_t sample, int photo) {
  const auto p = static_cast<std::size_t>(photo);
  const LightShape& shape = lights.shapes[static_cast<std::size_t>(lights.shape_of[p])];
  Shade s{photo, lights.shape_of[p], shape.row(e.samples[sample], sample), {}, {}};
  const double shading = shape.values.dot(s.row);
  s.log = log_of(shading) + lights.gains[p];
  s.slope = slope_of(shading);
  return s;
}

// residual = certainty * (what the photos show - first's log shading + second's)
struct Residual {
  Array3d value;
  Array3d certainty;
  double weight;
  Shade first;
  Shade second;
  [[nodiscard]] double size() const { return std::sqrt(even * even + value.square().sum()); }
};

template <class Visit>
void for_residuals(const LightProblem& p, const Lights& lights, Visit visit) {
  const auto one = [&](std::uint32_t a, std::uint32_t b, int other_photo, const Eigen::Vector3f& other,
                       double weight) {
    const LightSample& sample = p.evidence.samples[a];
    Residual r{{},
               certainty(sample.log_color, other),
               weight,
               shade_of(lights, p.evidence, a, sample.photo),
               shade_of(lights, p.evidence, b, other_photo)};
    r.value = r.certainty * ((sample.log_color - other).cast<double>().array() - r.first.log + r.second.log);
    visit(r);
  };
  for (const std::uint32_t i : p.pairs) {
    const LightPair& pair = p.evidence.pairs[i];
    const LightSample& b = p.evidence.samples[pair.b];
    one(pair.a, pair.b, b.photo, b.log_color, 1);
  }
  for (const std::uint32_t i : p.shared) {
    const SharedPoint& shared = p.evidence.shared[i];
    one(shared.sample, shared.sample, shared.photo, shared.log_color, shared_weight);
  }
}

// Where the unknowns are: the free shapes' strengths, then the gains of the photos under them; -1: held.
struct Layout {
  std::vector<Eigen::Index> shapes;
  std::vector<Eigen::Index> gains;
  Eigen::Index size = 0;
};
Layout layout_of(const LightProblem& p, const Lights& lights) {
  Layout layout{std::vector<Eigen::Index>(lights.shapes.size(), -1),
                std::vector<Eigen::Index>(lights.gains.size(), -1), 0};
  for (const int shape : p.free) {
    layout.shapes[static_cast<std::size_t>(shape)] = layout.size;
    layout.size += lights.shapes[static_cast<std::size_t>(shape)].values.size();
  }
  for (std::size_t photo = 0; photo < lights.gains.size(); ++photo) {
    if (layout.shapes[static_cast<std::size_t>(lights.shape_of[photo])] < 0) continue;
    layout.gains[photo] = layout.size;
    layout.size += 3;
  }
  return layout;
}

double weight_of_prior(const LightProblem& p) {
  return ridge * static_cast<double>(p.pairs.size() + p.shared.size()) / static_cast<double>(p.free.size());
}
// Towards even light of brightness 1.
double strength_of(Eigen::Index k) {
  return k == 0 ? weak : k < transfer_size ? 1 : 0.1;
}

double prior_cost(const LightProblem& p, const Lights& lights, const Layout& layout) {
  double sum = 0;
  for (const int shape : p.free) {
    const Eigen::VectorXd& values = lights.shapes[static_cast<std::size_t>(shape)].values;
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      const double off = values[k] - (k == 0 ? 1 : 0);
      sum += strength_of(k) * off * off;
    }
  }
  for (std::size_t i = 0; i < lights.gains.size(); ++i)
    if (layout.gains[i] >= 0) sum += weak * lights.gains[i].square().sum();
  return weight_of_prior(p) * sum;
}

double cost_of(const LightProblem& p, const Lights& lights, const Layout& layout) {
  double sum = 0;
  for_residuals(p, lights, [&](const Residual& r) { sum += r.weight * r.size(); });
  return sum + prior_cost(p, lights, layout);
}

struct Normal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
};

// Of one photo's two samples: gains cancel.
void add_within(const Residual& r, double weight, Eigen::Index at, Normal& n) {
  if (at < 0) return;
  const Row d = r.first.slope * r.first.row - r.second.slope * r.second.row;
  n.matrix.block(at, at, d.size(), d.size()).noalias() +=
      weight * r.certainty.square().sum() * d * d.transpose();
  n.right.segment(at, d.size()) += weight * (r.certainty * r.value).sum() * d;
}

void add_across(const Residual& r, double weight, const Layout& layout, Normal& n) {
  using Slopes = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * (transfer_size + most_lamps), 1>;
  std::array<Eigen::Index, 2 * (transfer_size + most_lamps)> places{};
  Slopes slopes(2 * (transfer_size + most_lamps));
  Eigen::Index count = 0;
  const auto add = [&](const Shade& shade, double sign) {
    const Eigen::Index at = layout.shapes[static_cast<std::size_t>(shade.shape)];
    for (Eigen::Index k = 0; at >= 0 && k < shade.row.size(); ++k, ++count) {
      places[static_cast<std::size_t>(count)] = at + k;
      slopes[count] = sign * shade.slope * shade.row[k];
    }
  };
  add(r.first, 1);
  add(r.second, -1);
  const std::array<std::pair<Eigen::Index, double>, 2> gains = {
      {{layout.gains[static_cast<std::size_t>(r.first.photo)], 1},
       {layout.gains[static_cast<std::size_t>(r.second.photo)], -1}}};
  const double squares = weight * r.certainty.square().sum();
  const double along = weight * (r.certainty * r.value).sum();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index row = places[static_cast<std::size_t>(i)];
    n.right[row] += along * slopes[i];
    for (Eigen::Index j = 0; j < count; ++j)
      n.matrix(row, places[static_cast<std::size_t>(j)]) += squares * slopes[i] * slopes[j];
    for (const auto& [at, sign] : gains)
      for (Eigen::Index c = 0; at >= 0 && c < 3; ++c) {
        const double w = weight * r.certainty[c] * r.certainty[c] * sign * slopes[i];
        n.matrix(row, at + c) += w;
        n.matrix(at + c, row) += w;
      }
  }
  for (const auto& [at, sign] : gains)
    for (Eigen::Index c = 0; at >= 0 && c < 3; ++c) {
      n.right[at + c] += weight * r.certainty[c] * r.value[c] * sign;
      for (const auto& [other, other_sign] : gains)
        if (other >= 0)
          n.matrix(at + c, other + c) += weight * r.certainty[c] * r.certainty[c] * sign * other_sign;
    }
}

// Reweighted least squares about the lights as they are.
Normal normal_equations(const LightProblem& p, const Lights& lights, const Layout& layout) {
  Normal n{Eigen::MatrixXd::Zero(layout.size, layout.size), Eigen::VectorXd::Zero(layout.size)};
  for_residuals(p, lights, [&](const Residual& r) {
    const double weight = r.weight / r.size();
    if (r.first.photo == r.second.photo)
      add_within(r, weight, layout.shapes[static_cast<std::size_t>(r.first.shape)], n);
    else
      add_across(r, weight, layout, n);
  });
  const double prior = 2 * weight_of_prior(p);
  for (const int shape : p.free) {
    const Eigen::VectorXd& values = lights.shapes[static_cast<std::size_t>(shape)].values;
    const Eigen::Index at = layout.shapes[static_cast<std::size_t>(shape)];
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      n.matrix(at + k, at + k) += prior * strength_of(k);
      n.right[at + k] += prior * strength_of(k) * ((k == 0 ? 1 : 0) - values[k]);
    }
  }
  for (std::size_t i = 0; i < lights.gains.size(); ++i)
    for (Eigen::Index c = 0; layout.gains[i] >= 0 && c < 3; ++c) {
      n.matrix(layout.gains[i] + c, layout.gains[i] + c) += prior * weak;
      n.right[layout.gains[i] + c] -= prior * weak * lights.gains[i][c];
    }
  return n;
}

Lights moved_by(const Eigen::VectorXd& step, const Layout& layout, Lights lights) {
  for (std::size_t s = 0; s < lights.shapes.size(); ++s) {
    if (layout.shapes[s] < 0) continue;
    Eigen::VectorXd& values = lights.shapes[s].values;
    values += step.segment(layout.shapes[s], values.size());
    // The last transfer is of bounced light, and lamps follow.
    auto positive = values.tail(values.size() - transfer_size + 1);
    positive = positive.cwiseMax(0.0).eval();
  }
  for (std::size_t i = 0; i < lights.gains.size(); ++i)
    if (layout.gains[i] >= 0) lights.gains[i] += step.segment<3>(layout.gains[i]).array();
  return lights;
}

template <class Of>
std::vector<std::uint32_t> thinned(std::size_t count, std::size_t most, Of of_it) {
  std::vector<std::uint32_t> list;
  for (std::uint32_t i = 0; i < count; ++i)
    if (of_it(i)) list.push_back(i);
  const std::size_t step = list.size() / most + 1;
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < list.size(); i += step) kept.push_back(list[i]);
  return kept;
}

}  // namespace

Array3d certainty(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const auto one = [](const Eigen::Vector3f& log_color) {
    const Array3d light = log_color.cast<double>().array().exp();
    return Array3d(light.square() / (light.square() + noise_light * noise_light));
  };
  return one(a) * one(b);
}

Row LightShape::row(const LightSample& sample, std::size_t index) const {
  Row row(transfer_size + static_cast<Eigen::Index>(lamps.size()));
  row.head<transfer_size>() = harmonic_scale * sample.transfer.cast<double>();
  for (std::size_t l = 0; l < lamps.size(); ++l)
    row[transfer_size + static_cast<Eigen::Index>(l)] = lamps[l][index];
  return row;
}

Lights even_lights(int photos, bool shared) {
  Lights lights;
  lights.shapes.resize(shared ? 1 : static_cast<std::size_t>(photos));
  for (LightShape& shape : lights.shapes) {
    shape.values = Eigen::VectorXd::Zero(transfer_size);
    shape.values[0] = 1;
  }
  for (int i = 0; i < photos; ++i) lights.shape_of.push_back(shared ? 0 : i);
  lights.gains.assign(static_cast<std::size_t>(photos), Array3d::Zero());
  return lights;
}

LightProblem problem_of_all(const LightEvidence& evidence, const Lights& lights) {
  LightProblem p{evidence, {}, {}, {}};
  for (std::uint32_t i = 0; i < evidence.pairs.size(); ++i) p.pairs.push_back(i);
  for (std::uint32_t i = 0; i < evidence.shared.size(); ++i) p.shared.push_back(i);
  for (int i = 0; i < static_cast<int>(lights.shapes.size()); ++i) p.free.push_back(i);
  return p;
}

LightProblem problem_of_one(const LightEvidence& evidence, const Lights& lights, int shape,
                            std::size_t most) {
  const auto under = [&](int photo) { return lights.shape_of[static_cast<std::size_t>(photo)] == shape; };
  const auto photo_of = [&](std::uint32_t sample) { return evidence.samples[sample].photo; };
  LightProblem p{evidence, {}, {}, {shape}};
  p.pairs = thinned(evidence.pairs.size(), most,
                    [&](std::uint32_t i) { return under(photo_of(evidence.pairs[i].a)); });
  p.shared = thinned(evidence.shared.size(), most, [&](std::uint32_t i) {
    return under(evidence.shared[i].photo) || under(photo_of(evidence.shared[i].sample));
  });
  return p;
}

double refine(const LightProblem& p, Lights& lights, int iterations) {
  const Layout layout = layout_of(p, lights);
  double cost = cost_of(p, lights, layout);
  double damping = 1e-4;
  for (int i = 0; i < iterations; ++i) {
    const Normal n = normal_equations(p, lights, layout);
    bool better = false;
    for (int attempt = 0; attempt < 4 && !better; ++attempt, damping *= 8) {
      Eigen::MatrixXd damped = n.matrix;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += 1e-9;
      Lights moved = moved_by(damped.ldlt().solve(n.right), layout, lights);
      const double moved_cost = cost_of(p, moved, layout);
      better = moved_cost < cost;
      if (!better) continue;
      const bool little = moved_cost > cost * (1 - 1e-5);
      lights = std::move(moved);
      cost = moved_cost;
      damping = std::max(1e-6, damping / 64);
      if (little) return cost;
    }
    if (!better) return cost;
  }
  return cost;
}

Array3d log_shading(const Lights& lights, const LightEvidence& evidence, std::uint32_t sample, int photo) {
  return shade_of(lights, evidence, sample, photo).log;
}

}  // namespace drape::texturing
