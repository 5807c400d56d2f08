#include "graze/design/wish_list.hpp"

#include "base/enumerator_name.hpp"
#include "design/wish_programme.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

constexpr double open_range = 10;     ///< in scales: starting points in an infinite range
constexpr double least_weight = 1e-6; ///< relative to the largest weight: above it a limit is active
constexpr double imbalance = 1e-4;    ///< residual of gradients below which a design counts as stationary
constexpr double cap_slack = 1e-10;   ///< round-off added to caps

/// Returns point `number` of the Halton sequence within the ranges, at most `farthest` from the start in each
/// dimension.
Eigen::VectorXd scattered_points(const ScaledWishes& wishes, std::size_t number, double farthest) {
    Eigen::VectorXd result(wishes.size());
    std::size_t base = 1;
    for (Eigen::Index i = 0; i < result.size(); ++i) {
        const auto is_prime = [](std::size_t p) {
            for (std::size_t d = 2; d * d <= p; ++d)
                if (p % d == 0)
                    return false;
            return true;
        };
        do
            ++base;
        while (!is_prime(base));
        const double low = std::max(std::isfinite(wishes.lowest()[i]) ? wishes.lowest()[i] : -open_range, -farthest),
                     high = std::min(std::isfinite(wishes.highest()[i]) ? wishes.highest()[i] : open_range, farthest);
        result[i] = low + scattered_share(number, base) * (high - low);
    }
    return result;
}

class Search {
public:
    Search(const WishList& list, const WishOptions& options) : wishes_(list, options), options_(options) {}

    FoundDesign run() {
        search_from_starts();
        if (best_)
            reduce_other_violations();
        return report();
    }

private:
    static constexpr std::size_t first_looks = 64; ///< designs tried until one has all values

    bool met() const { return best_ && best_->violation <= options_.tolerance; }

    void search_from_starts() {
        begin_at(Eigen::VectorXd::Zero(wishes_.size()));
        if (wishes_.size() == 0)
            return;
        std::size_t number = 1;
        for (std::size_t start = 1; start < options_.starts || (!best_ && number < first_looks); ++start) {
            if (!wishes_.may_go_on() || (met() && best_->z.norm() <= limit_distance))
                return;
            begin_at(
                scattered_points(wishes_, number++, met() ? best_->z.norm() : std::numeric_limits<double>::infinity()));
        }
    }

    void begin_at(const Eigen::VectorXd& z) {
        const Evaluation at = wishes_.evaluate(z);
        if (!at.exists)
            return;
        Candidate here = minimise_penalty(wishes_, {z, at, wishes_.largest(at)});
        const auto order = [&](const Candidate& one) {
            return one.violation <= options_.tolerance ? std::pair(0.0, one.z.norm())
                                                       : std::pair(one.violation, one.z.norm());
        };
        if (!best_ || order(here) < order(*best_))
            best_ = std::move(here);
    }

    /// Caps the limits that determine the largest violation, and minimises the rest, repeatedly.
    void reduce_other_violations() {
        const std::size_t rounds = wishes_.rows().size();
        violation_ = best_->violation;
        for (std::size_t round = 0; round < rounds && !met() && wishes_.stop_reason == StopReason::none; ++round) {
            const Multipliers multipliers = multipliers_of_violation(wishes_, *best_);
            note(multipliers, round == 0);
            bool any = false;
            for (std::size_t k = 0; k < rounds; ++k) {
                LimitRow& row = wishes_.rows()[k];
                if (row.cap || !(multipliers.rows[index(k)] > least_weight * multipliers.rows.maxCoeff()))
                    continue;
                row.cap = wishes_.violation(row, best_->at) + cap_slack;
                any = true;
            }
            best_->violation = wishes_.largest(best_->at);
            if (!any || multipliers.residual > imbalance)
                return;
            best_ = minimise_penalty(wishes_, std::move(*best_));
        }
        if (violation_ <= options_.tolerance)
            note(multipliers_of_distance(wishes_, *best_), true);
        if (multipliers_.rows.size() > 0)
            snap();
    }

    /// Moves the design exactly onto active ends of ranges, where it lies to within round-off.
    void snap() {
        Candidate at = *best_;
        for (Eigen::Index i = 0; i < at.z.size(); ++i) {
            if (multipliers_.lowest[i] > 0)
                at.z[i] = wishes_.lowest()[i];
            if (multipliers_.highest[i] > 0)
                at.z[i] = wishes_.highest()[i];
        }
        if (at.z == best_->z)
            return;
        at.at = wishes_.evaluate(at.z);
        if (!at.at.exists)
            return;
        at.violation = wishes_.largest(at.at);
        const bool good = at.violation <= std::max(options_.tolerance, best_->violation + cap_slack);
        if (good && wishes_.keeps_caps(at.at))
            best_ = std::move(at);
    }

    void note(const Multipliers& multipliers, bool first) {
        if (first) {
            multipliers_ = multipliers;
            return;
        }
        multipliers_.rows = multipliers_.rows.cwiseMax(multipliers.rows);
        multipliers_.lowest = multipliers_.lowest.cwiseMax(multipliers.lowest);
        multipliers_.highest = multipliers_.highest.cwiseMax(multipliers.highest);
    }

    FoundDesign report() const {
        FoundDesign result;
        result.evaluations = wishes_.evaluations;
        result.missing = wishes_.missing;
        result.problem = wishes_.problem;
        const Eigen::VectorXd z = best_ ? best_->z : Eigen::VectorXd::Zero(wishes_.size());
        for (const double value : wishes_.design(z))
            result.dimensions.push_back({value, false, false, false, 0});
        result.wants.resize(wishes_.list().wants.size());
        if (best_)
            fill(result);
        tell(result);
        return result;
    }

    void fill(FoundDesign& result) const {
        const bool known = multipliers_.rows.size() > 0 || wishes_.rows().empty();
        double most = 0;
        if (known && multipliers_.rows.size() > 0)
            most = std::max({multipliers_.rows.maxCoeff(),
                             multipliers_.lowest.size() ? multipliers_.lowest.maxCoeff() : 0.0,
                             multipliers_.highest.size() ? multipliers_.highest.maxCoeff() : 0.0});
        for (std::size_t i = 0; i < result.dimensions.size(); ++i) {
            FoundDimension& one = result.dimensions[i];
            one.at_lowest = one.value <= wishes_.list().dimensions[i].lowest;
            one.at_highest = one.value >= wishes_.list().dimensions[i].highest;
            if (multipliers_.rows.size() > 0)
                one.weight = multipliers_.lowest[index(i)] + multipliers_.highest[index(i)];
            one.binds = one.weight > least_weight * most;
        }
        for (std::size_t j = 0; j < result.wants.size(); ++j)
            result.wants[j].value = best_->at.values[index(j)];
        for (std::size_t k = 0; k < wishes_.rows().size(); ++k) {
            FoundWant& want = result.wants[wishes_.rows()[k].want];
            want.violation = std::max(want.violation, wishes_.violation(wishes_.rows()[k], best_->at));
            if (multipliers_.rows.size() > 0)
                want.weight += multipliers_.rows[index(k)];
            want.binds = want.weight > least_weight * most;
        }
        for (FoundWant& want : result.wants) {
            want.met = want.violation <= options_.tolerance;
            result.violation = std::max(result.violation, want.violation);
        }
        result.distance = best_->z.norm();
        result.stationary = known && multipliers_.residual <= imbalance;
    }

    void tell(FoundDesign& result) const {
        if (best_ && result.violation <= options_.tolerance) {
            result.outcome = WishOutcome::met;
        } else if (wishes_.stop_reason == StopReason::interrupted) {
            result.outcome = WishOutcome::interrupted;
            result.reason = "the search was interrupted";
        } else if (wishes_.stop_reason == StopReason::exhausted) {
            result.outcome = WishOutcome::unfinished;
            result.reason = fmt::format("{} devices were tried, as many as are allowed; {}", wishes_.evaluations,
                                        best_ ? "the best of them misses " + missed(result)
                                              : "none of them has all required values: " + wishes_.problem);
        } else if (!best_) {
            result.outcome = WishOutcome::nowhere;
            result.reason = fmt::format("none of the {} devices that were tried has all required values: {}",
                                        wishes_.evaluations, wishes_.problem);
        } else {
            result.outcome = WishOutcome::unmet;
            result.reason = conflict(result);
        }
    }

    /// Names the requirements of which something is true or not.
    std::string names_of(const FoundDesign& result, bool FoundWant::*property, bool value) const {
        std::string names;
        for (std::size_t j = 0; j < result.wants.size(); ++j)
            if (result.wants[j].*property == value)
                names += (names.empty() ? "" : ", ") + wishes_.list().wants[j].in_words();
        return names;
    }

    std::string missed(const FoundDesign& result) const { return names_of(result, &FoundWant::met, false); }

    std::string conflict(const FoundDesign& result) const {
        std::string names = names_of(result, &FoundWant::binds, true);
        for (std::size_t i = 0; i < result.dimensions.size(); ++i)
            if (result.dimensions[i].binds) {
                const Dimension& one = wishes_.list().dimensions[i];
                names += fmt::format("{}the range of '{}' ({:.6g} to {:.6g})", names.empty() ? "" : ", ", one.name,
                                     one.lowest, one.highest);
            }
        if (!result.stationary && wishes_.missing > 0)
            return fmt::format("missed: {}; the closest device is next to others without all required values: {}",
                               missed(result), wishes_.problem);
        return result.stationary ? "no device near this one comes closer; in the way: " + names
                                 : "missed: " + missed(result) + "; no closer device was found";
    }

    ScaledWishes wishes_;
    const WishOptions& options_;
    std::optional<Candidate> best_;
    double violation_ = 0; ///< largest violation
    Multipliers multipliers_;
};

[[noreturn]] void refuse(const std::string& problem, const std::string& remedy) {
    throw InputError(problem, remedy);
}

} // namespace

std::string Want::limits_in_words() const {
    if (!limits.empty())
        return limits + " is wanted";
    if (least == most)
        return fmt::format("{:.6g} is wanted", least);
    if (!std::isfinite(least))
        return fmt::format("at most {:.6g} is wanted", most);
    if (!std::isfinite(most))
        return fmt::format("at least {:.6g} is wanted", least);
    return fmt::format("{:.6g} to {:.6g} is wanted", least, most);
}

std::string Want::in_words() const {
    return fmt::format("{} ({})", text.empty() ? "'" + name + "'" : text, limits_in_words());
}

FoundWant found_want(const Want& want, std::optional<double> value, double tolerance) {
    FoundWant found;
    found.value = value;
    found.violation = std::numeric_limits<double>::infinity();
    if (value)
        found.violation = std::max({0.0, *value - want.most, want.least - *value}) / scale_of(want);
    found.met = found.violation <= tolerance;
    return found;
}

std::string words_of(const Want& want, const FoundWant& found) {
    if (found.met)
        return found.binds ? "met, binds" : "met";
    std::string text = "not met: " + want.limits_in_words();
    if (found.value) {
        constexpr double percent = 100;
        const double limit = *found.value > want.most ? want.most : want.least;
        if (want.scale == 0 && limit != 0)
            text += fmt::format(", {:.3g} percent off", percent * std::abs((*found.value - limit) / limit));
    }
    if (want.importance != 1)
        text += fmt::format(", counted {:g} times", want.importance);
    return text + (found.binds ? ", binds" : "");
}

void WishList::validate() const {
    for (const Dimension& one : dimensions) {
        if (!std::isfinite(one.start) || !(one.lowest <= one.start && one.start <= one.highest))
            refuse(fmt::format("'{}' starts at {}, outside of its range {} to {}", one.name, one.start, one.lowest,
                               one.highest),
                   "start within the range");
        if (!(one.scale >= 0 && std::isfinite(one.scale)))
            refuse(fmt::format("the scale {} of '{}' is out of range", one.scale, one.name),
                   "give a positive number, or 0 for the width of its range");
    }
    for (const Want& want : wants) {
        if (!want.value)
            refuse(fmt::format("nothing gives the value of '{}'", want.name), "give it a function");
        if (!(want.least <= want.most))
            refuse(
                fmt::format("nothing lies between {} and {}, as is wanted of '{}'", want.least, want.most, want.name),
                "give the lower limit first");
        const bool below = std::isfinite(want.least), above = std::isfinite(want.most);
        if (!below && !above)
            refuse(fmt::format("'{}' has no limit", want.name), "give a finite one");
        if (!(want.scale >= 0 && std::isfinite(want.scale)))
            refuse(fmt::format("the scale {} of '{}' is out of range", want.scale, want.name),
                   "give a positive number");
        if (!(want.importance > 0 && std::isfinite(want.importance)))
            refuse(fmt::format("the importance {} of '{}' is out of range", want.importance, want.name),
                   "give a positive number");
        if (want.scale == 0 && !((below && want.least != 0) || (above && want.most != 0)))
            refuse(fmt::format("'{}' has no scale", want.name), "say which departure counts as one");
    }
}

void WishOptions::validate() const {
    constexpr std::size_t most = 100'000'000;
    const auto check = [](bool right, std::string_view what, const std::string& remedy) {
        if (!right)
            refuse(fmt::format("{} is out of range", what), remedy);
    };
    check(tolerance >= 1e-14 && tolerance <= 1, "the tolerance of wants", "choose from 1e-14 to 1");
    check(evaluations >= 1 && evaluations <= most, "the number of evaluations",
          fmt::format("choose from 1 to {}", most));
    check(starts >= 1 && starts <= most, "the number of starts", fmt::format("choose from 1 to {}", most));
    check(difference >= 1e-12 && difference <= 0.1, "the step of differences", "choose from 1e-12 to 0.1");
}

std::string_view name_of(WishOutcome outcome) {
    constexpr std::string_view names[] = {"met", "unmet", "unfinished", "interrupted", "nowhere"};
    return enumerator_name(names, outcome, "nowhere");
}

FoundDesign design_for(const WishList& wishes, const WishOptions& options) {
    wishes.validate();
    options.validate();
    return Search(wishes, options).run();
}

} // namespace graze
