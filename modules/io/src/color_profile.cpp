#include "color_profile.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace drape::io {
namespace {

// Linear values at even steps from 0 to 1; bytes are at every 17th.
constexpr std::size_t steps_per_byte = 17;
constexpr std::size_t curve_steps = 255 * steps_per_byte;
using Curve = std::array<double, curve_steps + 1>;

double at_sample(const Curve& curve, std::uint8_t value) {
  return curve[steps_per_byte * value];
}
double at_sample(const Curve& curve, std::uint16_t value) {
  const double place = value * (static_cast<double>(curve_steps) / 65535);
  const auto below = std::min(static_cast<std::size_t>(place), curve_steps - 1);
  return curve[below] + (place - static_cast<double>(below)) * (curve[below + 1] - curve[below]);
}

struct Profile {
  Eigen::Matrix3d xyz_from_linear;  // D50, as the profile connection space has it
  std::array<Curve, 3> curves;
};

/// Big-endian numbers of an ICC profile; nothing beyond its end.
class IccBytes {
 public:
  explicit IccBytes(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::optional<std::uint32_t> number(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes_[at + i]);
    return value;
  }
  [[nodiscard]] std::optional<double> fixed(std::size_t at) const {  // s15Fixed16Number
    const auto value = number(at, 4);
    return value ? std::optional<double>(static_cast<std::int32_t>(*value) / 65536.0) : std::nullopt;
  }
  [[nodiscard]] std::string_view text(std::size_t at) const {
    return at > bytes_.size() ? std::string_view() : bytes_.substr(at, 4);
  }

  /// Where a tag's data lie.
  [[nodiscard]] std::optional<std::size_t> tag(std::string_view name) const {
    const std::uint32_t count = std::min(number(128, 4).value_or(0), 1000U);
    for (std::size_t i = 0; i < count; ++i)
      if (text(132 + 12 * i) == name) return number(136 + 12 * i, 4);
    return std::nullopt;
  }

 private:
  std::string_view bytes_;
};

std::optional<Eigen::Vector3d> xyz_of(const IccBytes& icc, std::string_view tag) {
  const auto at = icc.tag(tag);
  if (!at || icc.text(*at) != "XYZ ") return std::nullopt;
  Eigen::Vector3d xyz;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = icc.fixed(*at + 8 + 4 * k);
    if (!value) return std::nullopt;
    xyz[static_cast<Eigen::Index>(k)] = *value;
  }
  return xyz;
}

/// ICC.1:2010 10.15, parametricCurveType.
std::optional<Curve> parametric_curve(const IccBytes& icc, std::size_t at) {
  static constexpr std::array<std::size_t, 5> parameter_counts{1, 3, 4, 5, 7};
  const auto type = icc.number(at + 8, 2);
  if (!type || *type >= parameter_counts.size()) return std::nullopt;
  std::array<double, 7> p{1, 1, 0, 0, 0, 0, 0};  // g a b c d e f
  for (std::size_t i = 0; i < parameter_counts[*type]; ++i) {
    const auto value = icc.fixed(at + 12 + 4 * i);
    if (!value) return std::nullopt;
    p[i] = *value;
  }
  const auto [g, a, b, c, d, e, f] = p;
  const auto power = [g = g, a = a, b = b](double x) { return std::pow(std::max(0.0, a * x + b), g); };
  const double limit = *type < 3 ? (a != 0 ? -b / a : 0) : d;
  Curve curve{};
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double x = static_cast<double>(i) / curve_steps;
    const bool above = *type == 0 || x >= limit;
    switch (*type) {
      case 2:
        curve[i] = (above ? power(x) : 0) + c;
        break;
      case 3:
        curve[i] = above ? power(x) : c * x;
        break;
      case 4:
        curve[i] = above ? power(x) + e : c * x + f;
        break;
      default:
        curve[i] = above ? power(x) : 0;
        break;
    }
  }
  return curve;
}

/// ICC.1:2010 10.5, curveType: a gamma, or a table that is interpolated linearly.
std::optional<Curve> sampled_curve(const IccBytes& icc, std::size_t at) {
  const auto count = icc.number(at + 8, 4);
  if (!count || !icc.number(at + 12, 2 * std::min<std::size_t>(*count, 2))) return std::nullopt;
  Curve curve{};
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double x = static_cast<double>(i) / curve_steps;
    if (*count == 0) {
      curve[i] = x;
    } else if (*count == 1) {
      curve[i] = std::pow(x, *icc.number(at + 12, 2) / 256.0);
    } else {
      const double place = x * (*count - 1.0);
      const auto below = static_cast<std::size_t>(place);
      const auto low = icc.number(at + 12 + 2 * below, 2);
      const auto high = icc.number(at + 12 + 2 * std::min<std::size_t>(below + 1, *count - 1), 2);
      if (!low || !high) return std::nullopt;
      curve[i] = (*low + (place - static_cast<double>(below)) * (static_cast<double>(*high) - *low)) / 65535;
    }
  }
  return curve;
}

std::optional<Profile> parsed(std::string_view bytes) {
  const IccBytes icc(bytes);
  if (icc.text(36) != "acsp" || icc.text(16) != "RGB " || icc.text(20) != "XYZ ") return std::nullopt;
  Profile profile;
  static constexpr std::array<std::string_view, 3> colorants{"rXYZ", "gXYZ", "bXYZ"},
      curves{"rTRC", "gTRC", "bTRC"};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto xyz = xyz_of(icc, colorants[k]);
    const auto at = icc.tag(curves[k]);
    if (!xyz || !at) return std::nullopt;
    const auto curve = icc.text(*at) == "para"   ? parametric_curve(icc, *at)
                       : icc.text(*at) == "curv" ? sampled_curve(icc, *at)
                                                 : std::nullopt;
    if (!curve || !std::all_of(curve->begin(), curve->end(), [](double x) { return std::isfinite(x); }))
      return std::nullopt;
    profile.xyz_from_linear.col(static_cast<Eigen::Index>(k)) = *xyz;
    profile.curves[k] = *curve;
  }
  return profile;
}

double encoded(double linear) {  // IEC 61966-2-1
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

// sRGB values of linear ones in even steps: between them it is straight to a hundredth of a 16-bit step.
constexpr std::size_t encoding_steps = 65535;
std::vector<double> encoding_table() {
  std::vector<double> table(encoding_steps + 2);
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = encoded(std::min(1.0, static_cast<double>(i) / encoding_steps));
  return table;
}

/// sRGB's primaries adapted to D50 (Bradford), as its ICC profiles have them (sRGB IEC61966-2.1, ICC).
Eigen::Matrix3d srgb_from_xyz() {
  Eigen::Matrix3d xyz_from_srgb;
  xyz_from_srgb << 0.43607, 0.38515, 0.14307, 0.22249, 0.71687, 0.06061, 0.01392, 0.09708, 0.71410;
  return xyz_from_srgb.inverse();
}

class Converter {
 public:
  explicit Converter(const Profile& profile)
      : curves_(profile.curves),
        srgb_from_linear_(srgb_from_xyz() * profile.xyz_from_linear),
        table_(encoding_table()) {}

  template <class Sample>
  [[nodiscard]] std::array<Sample, 3> operator()(Sample r, Sample g, Sample b) const {
    const Eigen::Vector3d linear =
        srgb_from_linear_ *
        Eigen::Vector3d(at_sample(curves_[0], r), at_sample(curves_[1], g), at_sample(curves_[2], b));
    std::array<Sample, 3> samples{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double place = std::clamp(linear[static_cast<Eigen::Index>(k)], 0.0, 1.0) * encoding_steps;
      const auto below = static_cast<std::size_t>(place);
      const double value =
          table_[below] + (place - static_cast<double>(below)) * (table_[below + 1] - table_[below]);
      samples[k] = static_cast<Sample>(std::lround(value * std::numeric_limits<Sample>::max()));
    }
    return samples;
  }

  /// Whether no colour of a coarse lattice moves by more than one step: rounding moves some by one.
  [[nodiscard]] bool changes_nothing() const {
    for (int r = 0; r < 256; r += 51)
      for (int g = 0; g < 256; g += 51)
        for (int b = 0; b < 256; b += 51) {
          const auto in = std::array{r, g, b};
          const auto out = (*this)(static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g),
                                   static_cast<std::uint8_t>(b));
          for (std::size_t k = 0; k < 3; ++k)
            if (std::abs(out[k] - in[k]) > 1) return false;
        }
    return true;
  }

 private:
  std::array<Curve, 3> curves_;
  Eigen::Matrix3d srgb_from_linear_;
  std::vector<double> table_;
};

template <class Sample>
Image<Sample> converted(Image<Sample> rgb, const Converter& convert) {
  std::vector<Sample>& data = rgb.data();
  for (std::size_t i = 0; i + 2 < data.size(); i += 3) {
    const auto samples = convert(data[i], data[i + 1], data[i + 2]);
    std::copy(samples.begin(), samples.end(), data.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return rgb;
}

}  // namespace

SrgbPicture to_srgb(Image8 rgb, std::string_view icc) {
  if (icc.empty()) return {std::move(rgb), ProfileKind::none};
  const auto profile = parsed(icc);
  if (!profile) return {std::move(rgb), ProfileKind::not_applied};
  const Converter convert(*profile);
  if (convert.changes_nothing()) return {std::move(rgb), ProfileKind::none};
  return {converted(std::move(rgb), convert), ProfileKind::applied};
}

std::optional<Image16> to_srgb(const Image16& rgb, std::string_view icc) {
  const auto profile = parsed(icc);
  if (!profile) return std::nullopt;
  const Converter convert(*profile);
  if (convert.changes_nothing()) return std::nullopt;
  return converted(rgb, convert);
}

}  // namespace drape::io
