#include "graze/sweep/escape_law.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace graze {

namespace {

constexpr std::size_t fewest_leaving = 10; ///< fewest motions that leave
constexpr double in_19_of_20 = 1.96;       ///< 95 % of a normal distribution, in standard errors
/// 90 % quantile of Kolmogorov's distribution: a constant rate is rejected by mistake in one of ten cases.
constexpr double contradicts = 1.22;
/// Mean lifetimes that may pass, after the first motion has left, before the law holds. Later than that it would be the
/// law of less than a hundredth of the motions: of the slowest ones to settle, not of a transient.
constexpr double most_lifetimes_before = 5;
constexpr std::size_t possible_starts =
    40; ///< possible beginnings of the law, in equal shares of the motions that leave

/// The motions that are still there after a number of returns.
class Remainder {
public:
    /// @param sorted by their numbers of returns
    Remainder(std::span<const Stay> sorted, std::size_t from) : from_(from) {
        for (const Stay& stay : sorted)
            if (stay.cycles > from)
                stays_.push_back(stay);
        for (const Stay& stay : stays_) {
            left_ += stay.left ? stay.motions : 0;
            motions_ += stay.motions;
            at_risk_ += static_cast<double>(stay.cycles - from) * static_cast<double>(stay.motions);
        }
    }

    std::size_t left() const { return left_; }

    /// Returns whether motions leave in proportion to the total number of returns that they make.
    bool leave_steadily() const {
        double risk = 0, largest = 0; // up to the previous return
        std::size_t gone = 0, time = from_, before = 0, motions = motions_;
        const auto compare = [&](double returns, std::size_t leaving) {
            largest = std::max(
                largest, std::abs(static_cast<double>(leaving) / static_cast<double>(left_) - returns / at_risk_));
        };
        while (before < stays_.size()) {
            const std::size_t next = stays_[before].cycles;
            const auto there = static_cast<double>(motions);
            compare(risk + there * static_cast<double>(next - 1 - time), gone);
            risk += there * static_cast<double>(next - time);
            time = next;
            for (; before < stays_.size() && stays_[before].cycles == next; ++before) {
                gone += stays_[before].left ? stays_[before].motions : 0;
                motions -= stays_[before].motions;
            }
            compare(risk, gone);
        }
        return largest * std::sqrt(static_cast<double>(left_)) < contradicts;
    }

    EscapeLaw law() const {
        const double share = static_cast<double>(left_) / at_risk_; // share that leaves in each return
        EscapeLaw law;
        law.rate = -std::log1p(-share);
        law.error = in_19_of_20 * std::sqrt(share / (at_risk_ * (1 - share)));
        law.from = from_;
        law.left = left_;
        law.remaining = motions_ - left_;
        return law;
    }

private:
    std::size_t from_, left_ = 0, motions_ = 0;
    double at_risk_ = 0; ///< total number of returns of all motions
    std::vector<Stay> stays_;
};

/// The time after which a motion leaves, by its number among those that leave in order.
std::size_t time_of(std::span<const Stay> leaving, std::size_t motion) {
    std::size_t before = 0;
    return std::ranges::find_if(leaving, [&](const Stay& stay) { return motion < (before += stay.motions); })->cycles;
}

} // namespace

std::optional<EscapeLaw> escape_law(std::span<const Stay> stays) {
    std::vector<Stay> sorted(stays.begin(), stays.end());
    std::ranges::sort(sorted, [](const Stay& a, const Stay& b) { return a.cycles < b.cycles; });
    std::vector<Stay> leaving;
    std::size_t all = 0;
    for (const Stay& stay : sorted)
        if (stay.left && stay.motions > 0) {
            leaving.push_back(stay);
            all += stay.motions;
        }
    if (all < fewest_leaving)
        return std::nullopt;
    std::size_t before = 0;
    for (std::size_t part = 0; part < possible_starts; ++part) {
        const std::size_t from = part == 0 ? 0 : time_of(leaving, part * all / possible_starts);
        if (part > 0 && from == before)
            continue;
        before = from;
        const Remainder remainder(sorted, from);
        if (remainder.left() < fewest_leaving)
            return std::nullopt;
        if (!remainder.leave_steadily())
            continue;
        const EscapeLaw law = remainder.law();
        // If all leave at once there is no law: this is only the time in which escape is detected.
        if (law.rate < 20 && law.rate * (static_cast<double>(from) - static_cast<double>(leaving.front().cycles)) <
                                 most_lifetimes_before)
            return law;
    }
    return std::nullopt;
}

} // namespace graze
