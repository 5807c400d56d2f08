#include "design/scaled_wishes.hpp"

#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr double round_off = 1e-13; ///< in scales: closer to an end of a range, the end itself is meant

double width_of(const Dimension& one) {
    const double width = one.highest - one.lowest;
    if (one.scale > 0)
        return one.scale;
    return std::isfinite(width) && width > 0 ? width : one.start != 0 ? std::abs(one.start) : 1;
}

} // namespace

double scale_of(const Want& want) {
    if (want.scale > 0)
        return want.scale / want.importance;
    const double least = std::isfinite(want.least) ? std::abs(want.least) : 0,
                 most = std::isfinite(want.most) ? std::abs(want.most) : 0;
    return std::max(least, most) / want.importance;
}

double scattered_share(std::size_t number, std::size_t base) {
    double part = 1, share = 0;
    for (; number > 0; number /= base) {
        part /= static_cast<double>(base);
        share += part * static_cast<double>(number % base);
    }
    return share;
}

ScaledWishes::ScaledWishes(const WishList& wishes, const WishOptions& options)
    : wishes_(wishes), options_(options), scale_(index(wishes.dimensions.size())), lowest_(scale_.size()),
      highest_(scale_.size()) {
    for (Eigen::Index i = 0; i < size(); ++i) {
        const Dimension& one = wishes.dimensions[static_cast<std::size_t>(i)];
        scale_[i] = width_of(one);
        lowest_[i] = (one.lowest - one.start) / scale_[i];
        highest_[i] = (one.highest - one.start) / scale_[i];
    }
    for (std::size_t j = 0; j < wishes.wants.size(); ++j) {
        const Want& want = wishes.wants[j];
        want_scale_.push_back(graze::scale_of(want));
        if (std::isfinite(want.most))
            rows_.push_back({j, want.most, 1, {}});
        if (std::isfinite(want.least))
            rows_.push_back({j, want.least, -1, {}});
    }
}

std::vector<double> ScaledWishes::design(const Eigen::VectorXd& z) const {
    std::vector<double> result;
    for (Eigen::Index i = 0; i < size(); ++i) {
        const Dimension& one = wishes_.dimensions[static_cast<std::size_t>(i)];
        const double near = round_off * (1 + std::abs(z[i]));
        const double value = z[i] <= lowest_[i] + near    ? one.lowest
                             : z[i] >= highest_[i] - near ? one.highest
                                                          : one.start + z[i] * scale_[i];
        result.push_back(std::clamp(value, one.lowest, one.highest));
    }
    return result;
}

double ScaledWishes::violation(const LimitRow& row, const Evaluation& at) const {
    return row.sign * (at.values[index(row.want)] - row.limit) / scale_of(row.want);
}

double ScaledWishes::largest(const Evaluation& at) const {
    double result = 0;
    for (const LimitRow& row : rows_)
        if (!row.cap)
            result = std::max(result, violation(row, at));
    return result;
}

bool ScaledWishes::keeps_caps(const Evaluation& at) const {
    return std::ranges::all_of(rows_, [&](const LimitRow& row) { return !row.cap || violation(row, at) <= *row.cap; });
}

bool ScaledWishes::may_go_on() {
    if (stop_reason != StopReason::none)
        return false;
    if (options_.interrupted && options_.interrupted())
        stop_reason = StopReason::interrupted;
    else if (evaluations >= options_.evaluations)
        stop_reason = StopReason::exhausted;
    return stop_reason == StopReason::none;
}

const Evaluation& ScaledWishes::evaluate(const Eigen::VectorXd& z) {
    if (evaluation_ && last_ == z)
        return *evaluation_;
    std::vector<bool> unknown;
    evaluation_ = values(z, unknown);
    if (evaluation_->exists)
        complete(z, *evaluation_, unknown);
    last_ = z;
    return *evaluation_;
}

/// @param unknown set for requirements without a gradient
Evaluation ScaledWishes::values(const Eigen::VectorXd& z, std::vector<bool>& unknown) {
    Evaluation result;
    if (!may_go_on())
        return result;
    ++evaluations;
    const std::vector<double> at = design(z);
    const std::size_t wants = wishes_.wants.size();
    result.values.resize(index(wants));
    result.gradient.resize(index(wants), size());
    unknown.assign(wants, false);
    for (std::size_t j = 0; j < wants; ++j) {
        const WantedValue one = wishes_.wants[j].value(at);
        if (!one.value || !std::isfinite(*one.value)) {
            ++missing;
            problem =
                one.problem.empty() ? fmt::format("'{}' has no finite value", wishes_.wants[j].name) : one.problem;
            return result;
        }
        result.values[index(j)] = *one.value;
        if (!one.gradient.empty()) {
            require_size(one.gradient.size(), wishes_.dimensions.size(), "derivatives of a want");
            result.gradient.row(index(j)) =
                Eigen::Map<const Eigen::RowVectorXd>(one.gradient.data(), size()).cwiseProduct(scale_.transpose()) /
                scale_of(j);
        }
        unknown[j] = one.gradient.empty() || !result.gradient.row(index(j)).allFinite();
    }
    result.exists = true;
    return result;
}

/// Computes missing gradients by differences that stay within the ranges and among designs that have all values.
void ScaledWishes::complete(const Eigen::VectorXd& z, Evaluation& result, const std::vector<bool>& unknown) {
    if (std::find(unknown.begin(), unknown.end(), true) == unknown.end())
        return;
    std::vector<bool> there;
    for (Eigen::Index i = 0; i < size(); ++i) {
        Eigen::VectorXd above = z, below = z;
        above[i] = std::min(z[i] + options_.difference, highest_[i]);
        below[i] = std::max(z[i] - options_.difference, lowest_[i]);
        const Evaluation high = above[i] > z[i] ? values(above, there) : result,
                         low = below[i] < z[i] ? values(below, there) : result;
        if (stop_reason != StopReason::none) {
            result.exists = false;
            return;
        }
        const double step = (high.exists ? above[i] : z[i]) - (low.exists ? below[i] : z[i]);
        for (std::size_t j = 0; j < unknown.size(); ++j)
            if (unknown[j]) {
                const double gain =
                    (high.exists ? high : result).values[index(j)] - (low.exists ? low : result).values[index(j)];
                result.gradient(index(j), i) = step > 0 ? gain / step / scale_of(j) : 0;
            }
    }
}

} // namespace graze
