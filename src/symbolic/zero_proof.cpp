#include "symbolic/zero_proof.hpp"

#include "base/linear_systems.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace graze {

namespace {

/// Part of a box's width by which its image must lie in its interior: far more than what rounded constants in the
/// derivatives can change.
constexpr double inside_by = 1e-6;

bool is_inside(const IntervalBox& image, const IntervalBox& box) {
    for (std::size_t i = 0; i < box.size(); ++i) {
        const double margin = inside_by * box[i].width();
        if (!(image[i].lower > box[i].lower + margin && image[i].upper < box[i].upper - margin))
            return false;
    }
    return true;
}

double total_width(const IntervalBox& box, const Eigen::VectorXd& scales) {
    double total = 0;
    for (std::size_t i = 0; i < box.size(); ++i)
        total += box[i].width() / scales[static_cast<Eigen::Index>(i)];
    return total;
}

/// Krawczyk's operator about one point.
class Krawczyk {
public:
    /// @param inverse of the derivatives at the point, approximately
    Krawczyk(SquareSystem& system, std::span<const double> point, Eigen::MatrixXd inverse)
        : system_(system), point_(point.begin(), point.end()), inverse_(std::move(inverse)),
          newton_step_(product(inverse_, system.values_at(point))) {}

    /// Returns the image of a box that contains the point; none where the functions are not smooth.
    std::optional<IntervalBox> image(const IntervalBox& box) {
        const SquareSystem::Bounds bounds = system_.over(box);
        if (!bounds.smooth())
            return std::nullopt;
        const IntervalMatrix slopes = product(inverse_, bounds.derivatives);
        IntervalBox result;
        for (std::size_t row = 0; row < box.size(); ++row) {
            Interval sum = Interval::point(point_[row]) - newton_step_[row];
            for (std::size_t column = 0; column < box.size(); ++column)
                sum = sum + (Interval::point(row == column ? 1 : 0) - slopes(row, column)) *
                                (box[column] - Interval::point(point_[column]));
            result.push_back(sum);
        }
        return result;
    }

    IntervalBox box_of(double radius, const Eigen::VectorXd& scales) const {
        IntervalBox box;
        for (std::size_t i = 0; i < point_.size(); ++i) {
            // Rounding must not take the point out of its box.
            const double reach = std::max(radius * scales[static_cast<Eigen::Index>(i)],
                                          64 * std::numeric_limits<double>::epsilon() * std::abs(point_[i]));
            box.push_back({point_[i] - reach, point_[i] + reach});
        }
        return box;
    }

private:
    SquareSystem& system_;
    std::vector<double> point_;
    Eigen::MatrixXd inverse_;
    IntervalBox newton_step_;
};

} // namespace

std::optional<std::vector<double>> newton(SquareSystem& system, std::vector<double> start, const IntervalBox& within,
                                          const Eigen::VectorXd& scales) {
    constexpr int most_steps = 40;
    constexpr double small = 1e-10; // relative to the scales
    double before = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < most_steps; ++iteration) {
        const auto point = system.at(start);
        if (!point)
            return std::nullopt;
        const auto inverse = scaled_inverse(point->derivatives, scales);
        if (!inverse)
            return std::nullopt;
        const Eigen::VectorXd step = *inverse * point->values;
        const double size = step.cwiseQuotient(scales).cwiseAbs().maxCoeff();
        if (!std::isfinite(size))
            return std::nullopt;
        // Steps that no longer become smaller are round-off.
        if (size == 0 || (size < small && size >= before / 2))
            return start;
        before = size;
        for (std::size_t i = 0; i < start.size(); ++i) {
            start[i] -= step[static_cast<Eigen::Index>(i)];
            if (!within[i].contains(start[i]))
                return std::nullopt;
        }
    }
    return std::nullopt;
}

std::optional<VerifiedZero> prove_zero(SquareSystem& system, std::span<const double> zero, double radius,
                                       const Eigen::VectorXd& scales) {
    constexpr int most_tighter = 60;
    constexpr double smallest = 1e-14, smaller = 0.25, larger = 2, stalls = 1 - inside_by;
    const auto point = system.at(zero);
    const auto inverse = point ? scaled_inverse(point->derivatives, scales) : std::nullopt;
    if (!inverse)
        return std::nullopt;
    Krawczyk krawczyk(system, zero, *inverse);
    const auto proven = [&](const IntervalBox& box) {
        const auto image = krawczyk.image(box);
        return image && is_inside(*image, box);
    };
    IntervalBox alone;
    for (; radius >= smallest && alone.empty(); radius *= smaller)
        if (IntervalBox box = krawczyk.box_of(radius, scales); proven(box))
            alone = std::move(box);
    if (alone.empty())
        return std::nullopt;
    for (radius *= larger / smaller; radius <= 1; radius *= larger) {
        IntervalBox box = krawczyk.box_of(radius, scales);
        if (!proven(box))
            break;
        alone = std::move(box);
    }
    IntervalBox enclosure = alone;
    for (int attempt = 0; attempt < most_tighter; ++attempt) {
        const auto image = krawczyk.image(enclosure);
        if (!image)
            break;
        const double before = total_width(enclosure, scales);
        for (std::size_t i = 0; i < enclosure.size(); ++i)
            enclosure[i] = intersection(enclosure[i], (*image)[i]);
        if (!(total_width(enclosure, scales) < stalls * before))
            break;
    }
    return VerifiedZero{{zero.begin(), zero.end()}, enclosure, alone};
}

} // namespace graze
