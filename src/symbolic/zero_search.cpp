#include "graze/symbolic/zero_search.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "symbolic/linear_contraction.hpp"
#include "symbolic/merged_boxes.hpp"
#include "symbolic/square_system.hpp"
#include "symbolic/zero_proof.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace graze {

namespace {

bool overlap(const IntervalBox& one, const IntervalBox& other) {
    for (std::size_t i = 0; i < one.size(); ++i)
        if (one[i].upper < other[i].lower || other[i].upper < one[i].lower)
            return false;
    return true;
}

bool contains(const IntervalBox& box, std::span<const double> point) {
    for (std::size_t i = 0; i < box.size(); ++i)
        if (!box[i].contains(point[i]))
            return false;
    return true;
}

std::vector<double> middle_of(const IntervalBox& box) {
    std::vector<double> middle;
    for (const Interval& side : box)
        middle.push_back(side.middle());
    return middle;
}

class Search {
public:
    Search(const Function& function, IntervalBox box, std::span<const double> parameters,
           const ZeroSearchSettings& settings)
        : settings_(settings), whole_(std::move(box)), system_(function, whole_.size(), parameters) {
        scales_.resize(static_cast<Eigen::Index>(whole_.size()));
        for (std::size_t i = 0; i < whole_.size(); ++i)
            scales_[static_cast<Eigen::Index>(i)] = whole_[i].width();
    }

    ZeroSearch run();

private:
    /// A box that may have zeros, with its place in the order in which boxes were made.
    struct Waiting {
        double size; ///< largest relative width
        std::size_t number;
        IntervalBox box;
        /// The largest come first, so that all regular zeros have been found where singular ones exhaust the search.
        friend bool operator<(const Waiting& one, const Waiting& other) {
            return one.size != other.size ? one.size < other.size : one.number > other.number;
        }
    };
    double relative_width(const IntervalBox& box, std::size_t i) const { return box[i].width() / whole_[i].width(); }
    double size_of(const IntervalBox& box) const;
    double volume_of(const IntervalBox& box) const;
    void add(IntervalBox box);
    void examine(IntervalBox box);
    bool cut_known(IntervalBox& box) const;
    bool contract_linear(IntervalBox& box, const SquareSystem::Bounds& bounds, std::span<const double> middle,
                         const IntervalBox& values) const;
    bool is_round_off(const SquareSystem::Bounds& bounds, const IntervalBox& values) const;
    void look_for_zero(const IntervalBox& box);
    bool is_beside(std::span<const double> one, std::span<const double> other) const;
    void take(VerifiedZero zero);
    void split(const IntervalBox& box);
    void merge(std::vector<IntervalBox>& boxes, double part) const;
    std::optional<std::pair<std::size_t, double>> place_of_cut(const IntervalBox& box) const;

    const ZeroSearchSettings& settings_;
    IntervalBox whole_;
    SquareSystem system_;
    Eigen::VectorXd scales_;
    std::priority_queue<Waiting> waiting_;
    std::size_t made_ = 0;
    /// Where Newton's method has converged of late, but the proof has failed: it is not tried again there.
    std::deque<std::vector<double>> unproven_;
    std::vector<VerifiedZero> known_; ///< all that are proven, those outside the searched box included
    ZeroSearch result_;
};

double Search::size_of(const IntervalBox& box) const {
    double size = 0;
    for (std::size_t i = 0; i < box.size(); ++i)
        size = std::max(size, relative_width(box, i));
    return size;
}

/// Relative; widths below the resolution count as the resolution.
double Search::volume_of(const IntervalBox& box) const {
    double volume = 1;
    for (std::size_t i = 0; i < box.size(); ++i)
        volume *= std::max(relative_width(box, i), settings_.resolution);
    return volume;
}

void Search::add(IntervalBox box) {
    const double size = size_of(box);
    waiting_.push({size, made_++, std::move(box)});
}

/// Removes what is in the box in which a known zero is alone, as far as the rest is a box. False if nothing is left.
bool Search::cut_known(IntervalBox& box) const {
    for (const VerifiedZero& zero : known_) {
        if (!overlap(box, zero.alone))
            continue;
        std::size_t outside = 0, side = 0;
        for (std::size_t i = 0; i < box.size(); ++i)
            if (!zero.alone[i].contains(box[i])) {
                ++outside;
                side = i;
            }
        if (outside == 0)
            return false;
        if (outside > 1)
            continue;
        if (zero.alone[side].lower <= box[side].lower)
            box[side].lower = zero.alone[side].upper;
        else if (zero.alone[side].upper >= box[side].upper)
            box[side].upper = zero.alone[side].lower;
    }
    return true;
}

/// Shrinks a box by the mean-value form of each function, then by combinations of them that have nearly one unknown
/// each. False if it has no zero.
bool Search::contract_linear(IntervalBox& box, const SquareSystem::Bounds& bounds, std::span<const double> middle,
                             const IntervalBox& values) const {
    const std::size_t n = box.size();
    bool all_continuous = true;
    for (std::size_t row = 0; row < n; ++row) {
        if (!bounds.values[row].continuous) {
            all_continuous = false; // the mean-value form does not hold
            continue;
        }
        if (!contract(box, middle, bounds.derivatives.row(row), values[row]))
            return false;
    }
    if (!all_continuous || !bounds.smooth())
        return true;
    Eigen::MatrixXd slopes(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
    Eigen::VectorXd widths(static_cast<Eigen::Index>(n));
    for (std::size_t row = 0; row < n; ++row) {
        for (std::size_t column = 0; column < n; ++column)
            slopes(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
                bounds.derivatives(row, column).middle();
        widths[static_cast<Eigen::Index>(row)] =
            whole_[row].width() * std::max(relative_width(box, row), settings_.resolution);
    }
    const auto inverse = scaled_inverse(slopes, widths);
    if (!inverse)
        return true;
    const IntervalMatrix combined = product(*inverse, bounds.derivatives);
    const IntervalBox constants = product(*inverse, values);
    for (std::size_t row = 0; row < n; ++row)
        if (!contract(box, middle, combined.row(row), constants[row]))
            return false;
    return true;
}

/// True if the functions vary no more in a box than round-off lets them vary at a point: smaller boxes tell no more.
bool Search::is_round_off(const SquareSystem::Bounds& bounds, const IntervalBox& values) const {
    constexpr double much = 8;
    for (std::size_t row = 0; row < values.size(); ++row)
        if (!values[row].contains(0) || !values[row].bounded() ||
            !(bounds.values[row].width() <= much * values[row].width()))
            return false;
    return true;
}

void Search::take(VerifiedZero zero) {
    // Enclosures that overlap belong to the same zero. Should they not, smaller boxes tell.
    if (std::ranges::none_of(known_, [&](const auto& other) { return overlap(zero.enclosure, other.enclosure); }))
        known_.push_back(std::move(zero));
}

/// True if two points are closer to each other than the resolution.
bool Search::is_beside(std::span<const double> one, std::span<const double> other) const {
    for (std::size_t i = 0; i < one.size(); ++i)
        if (!(std::abs(one[i] - other[i]) <= settings_.resolution * whole_[i].width()))
            return false;
    return true;
}

/// Looks for a zero from the middle of a box, and proves it.
void Search::look_for_zero(const IntervalBox& box) {
    constexpr double beyond = 1; // parts of the box's extent
    constexpr std::size_t most_unproven = 1000;
    IntervalBox near;
    for (std::size_t i = 0; i < box.size(); ++i) {
        const double reach = std::max(beyond * box[i].width(), settings_.resolution * whole_[i].width());
        near.push_back({box[i].lower - reach, box[i].upper + reach});
    }
    const auto zero = newton(system_, middle_of(box), near, scales_);
    if (!zero)
        return;
    if (std::ranges::any_of(known_, [&](const VerifiedZero& other) { return contains(other.alone, *zero); }))
        return;
    if (std::ranges::any_of(unproven_, [&](const auto& other) { return is_beside(*zero, other); }))
        return;
    const double radius = std::max(size_of(box), settings_.resolution);
    if (auto proven = prove_zero(system_, *zero, radius, scales_))
        take(std::move(*proven));
    else
        unproven_.push_back(*zero);
    if (unproven_.size() > most_unproven)
        unproven_.pop_front();
}

/// Returns where a box is divided best: at a side of the box of a known zero, or in two parts of similar extent, where
/// the box is relatively largest. None if it is too small.
std::optional<std::pair<std::size_t, double>> Search::place_of_cut(const IntervalBox& box) const {
    constexpr double fraction = 0.4937; // zeros are often in the middle, where parts would share them
    constexpr double sliver = 0.05;
    std::vector<bool> divisible(box.size());
    std::optional<std::size_t> widest;
    for (std::size_t i = 0; i < box.size(); ++i) {
        const double place = box[i].lower + fraction * box[i].width();
        divisible[i] = relative_width(box, i) > settings_.resolution && box[i].lower < place && place < box[i].upper;
        if (divisible[i] && (!widest || relative_width(box, i) > relative_width(box, *widest)))
            widest = i;
    }
    if (!widest)
        return std::nullopt;
    for (const VerifiedZero& zero : known_) {
        if (!overlap(box, zero.alone))
            continue;
        double best = sliver;
        std::optional<std::pair<std::size_t, double>> cut;
        for (std::size_t i = 0; i < box.size(); ++i) {
            if (!divisible[i])
                continue;
            for (const double side : {zero.alone[i].lower, zero.alone[i].upper}) {
                const double least = std::min(side - box[i].lower, box[i].upper - side) / box[i].width();
                if (least > best) {
                    best = least;
                    cut = std::pair(i, side);
                }
            }
        }
        if (cut)
            return cut;
    }
    return std::pair(*widest, box[*widest].lower + fraction * box[*widest].width());
}

void Search::split(const IntervalBox& box) {
    const auto cut = place_of_cut(box);
    if (!cut) {
        result_.undecided.push_back(box);
        return;
    }
    IntervalBox first = box, second = box;
    first[cut->first].upper = second[cut->first].lower = cut->second;
    add(std::move(first));
    add(std::move(second));
}

void Search::examine(IntervalBox box) {
    constexpr double worthwhile = 0.3; // a box that shrinks to this part of its volume is examined again undivided
    if (!cut_known(box))
        return;
    const SquareSystem::Bounds bounds = system_.over(box);
    if (!std::ranges::all_of(bounds.values, [](const Interval& value) { return value.contains(0); }))
        return;
    const double volume = volume_of(box);
    if (!system_.narrow(box))
        return;
    const std::vector<double> middle = middle_of(box);
    const IntervalBox values = system_.values_at(middle);
    if (!contract_linear(box, bounds, middle, values))
        return;
    look_for_zero(box);
    if (!cut_known(box))
        return;
    if (is_round_off(bounds, values))
        result_.undecided.push_back(std::move(box));
    else if (volume_of(box) < worthwhile * volume)
        add(std::move(box));
    else
        split(box);
}

/// Merges boxes outside the known zeros' that touch, or whose distance is a part of their extent.
void Search::merge(std::vector<IntervalBox>& boxes, double part) const {
    std::erase_if(boxes, [&](IntervalBox& box) { return !cut_known(box); });
    std::vector<double> gaps;
    for (const Interval& side : whole_)
        gaps.push_back(2 * settings_.resolution * side.width());
    boxes = merged_boxes(std::move(boxes), gaps, part);
}

ZeroSearch Search::run() {
    add(whole_);
    while (!waiting_.empty()) {
        if (result_.boxes >= settings_.boxes)
            result_.ending = ZeroSearch::Ending::too_many_boxes;
        else if (settings_.interrupted && settings_.interrupted())
            result_.ending = ZeroSearch::Ending::interrupted;
        if (result_.ending != ZeroSearch::Ending::complete)
            break;
        ++result_.boxes;
        IntervalBox box = waiting_.top().box;
        waiting_.pop();
        examine(std::move(box));
    }
    for (; !waiting_.empty(); waiting_.pop())
        result_.unexamined.push_back(waiting_.top().box);
    merge(result_.undecided, 0.5);
    merge(result_.unexamined, 0);
    for (VerifiedZero& zero : known_) {
        if (!overlap(zero.enclosure, whole_))
            continue;
        // A zero on the edge, as far as its enclosure tells, has its value there.
        for (std::size_t i = 0; i < whole_.size(); ++i)
            zero.values[i] = std::clamp(zero.values[i], std::max(zero.enclosure[i].lower, whole_[i].lower),
                                        std::min(zero.enclosure[i].upper, whole_[i].upper));
        result_.zeros.push_back(std::move(zero));
    }
    std::ranges::sort(result_.zeros, {}, &VerifiedZero::values);
    return std::move(result_);
}

} // namespace

ZeroSearch find_zeros(const Function& function, std::span<const double> lower, std::span<const double> upper,
                      std::span<const double> parameters, const ZeroSearchSettings& settings) {
    require_size(upper.size(), lower.size(), "upper ends of a box");
    if (lower.empty())
        throw InputError("a box in which zeros are looked for has no unknowns", "");
    if (!(settings.resolution >= 1e-14 && settings.resolution <= 0.1))
        throw InputError("the resolution of a search for zeros is not within 1e-14 .. 0.1", "");
    if (settings.boxes == 0)
        throw InputError("a search for zeros may examine no box", "allow at least one");
    IntervalBox box;
    for (std::size_t i = 0; i < lower.size(); ++i) {
        const Interval side{lower[i], upper[i]};
        if (!(std::isfinite(side.width()) && side.width() > 0))
            throw InputError("a box in which zeros are looked for is not finite, or has no extent",
                             "give ends that are finite and rise");
        box.push_back(side);
    }
    return Search(function, std::move(box), parameters, settings).run();
}

} // namespace graze
