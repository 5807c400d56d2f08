#include "branch/equilibrium_locator.hpp"

#include "base/signs.hpp"
#include "base/special_numbers.hpp"
#include "branch/boundary_equilibrium.hpp"
#include "branch/bounds.hpp"
#include "branch/branch_state.hpp"
#include "branch/crossing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace graze {

namespace {

constexpr double located_within = 1e-14; ///< accuracy of located points, as a fraction of the step

} // namespace

std::vector<SpecialPoint> EquilibriumLocator::locate_all(const DescribedEquilibrium& before,
                                                         const DescribedEquilibrium& here) {
    constexpr double beside = 1e-6; // share of the step: a fold at a branch point is the other branch's
    std::vector<SpecialPoint> found;
    const std::size_t count = std::min(before.tests.size(), here.tests.size());
    for (std::size_t i = 0; i < count; ++i)
        for (const Bracket& bracket : brackets_of(i, before.tests[i], here.tests[i]))
            if (auto special = locate(i, bracket, before, here))
                found.push_back(std::move(*special));
    history_.add(before.at.arclength, before.tests);
    const double length = here.at.arclength - before.at.arclength;
    std::erase_if(found, [&](const SpecialPoint& one) {
        return one.type == PointType::fold && std::ranges::any_of(found, [&](const SpecialPoint& other) {
                   return other.type == PointType::branch_point &&
                          std::abs(other.arclength - one.arclength) < beside * length;
               });
    });
    std::ranges::stable_sort(found, {}, &SpecialPoint::arclength);
    // What lies beyond a bound does not belong to the branch.
    const auto bound = std::ranges::find(found, PointType::bound, &SpecialPoint::type);
    if (bound != found.end())
        found.erase(bound + 1, found.end());
    path_->problem()->evaluate(here.at.u);
    return found;
}

std::vector<EquilibriumLocator::Bracket> EquilibriumLocator::brackets_of(std::size_t test, const BranchTest& before,
                                                                         const BranchTest& here) {
    const TestValue low{0, before.value}, high{1, here.value};
    const double noise = std::max(before.noise, here.noise);
    if (noise > 0 && std::abs(low.value) <= noise && std::abs(high.value) <= noise)
        return {};
    if (here.type == PointType::bound && !(low.value > 0))
        return {};
    if (have_opposite_signs(low.value, high.value) || (high.value == 0 && low.value != 0))
        return {{low, high}};
    if (!have_same_sign(low.value, high.value))
        return {};
    const double begin = continuation_->previous().arclength, length = continuation_->point().arclength - begin;
    // Smaller values than this share of those at the ends are round-off, as where a test only touches zero.
    constexpr double round_off = 1e-10;
    const double least = std::max(noise, round_off * std::min(std::abs(low.value), std::abs(high.value)));
    const auto dip = history_.find_dip(test, begin, length, low, high, least, [&](double fraction) {
        const auto there = describe_between(fraction);
        return there ? there->tests[test].value : not_a_number;
    });
    return dip ? std::vector<Bracket>{{dip->before, dip->within}, {dip->within, dip->behind}} : std::vector<Bracket>();
}

std::optional<DescribedEquilibrium> EquilibriumLocator::describe_between(double fraction) {
    ContinuationPoint at;
    return continuation_->between(fraction, at) ? path_->describe(at) : std::nullopt;
}

/// The zero of a test by the secant method kept within a bracket (Illinois variant of regula falsi).
std::optional<DescribedEquilibrium> EquilibriumLocator::zero_of(std::size_t test, TestValue low, TestValue high) {
    constexpr int most = 80;
    std::optional<DescribedEquilibrium> there;
    int side = 0;
    for (int i = 0; i < most && high.fraction - low.fraction > located_within; ++i) {
        double fraction = low.fraction - low.value * (high.fraction - low.fraction) / (high.value - low.value);
        if (!(fraction > low.fraction && fraction < high.fraction) || i % 8 == 7)
            fraction = 0.5 * (low.fraction + high.fraction);
        auto next = describe_between(fraction);
        if (!next)
            return std::nullopt;
        there = std::move(next);
        const double value = there->tests[test].value;
        if (value == 0 || !std::isfinite(value))
            break;
        if ((value < 0) == (low.value < 0)) {
            low = {fraction, value};
            high.value *= side == -1 ? 0.5 : 1;
            side = -1;
        } else {
            high = {fraction, value};
            low.value *= side == 1 ? 0.5 : 1;
            side = 1;
        }
    }
    return there;
}

std::optional<SpecialPoint> EquilibriumLocator::locate(std::size_t test, const Bracket& bracket,
                                                       const DescribedEquilibrium& before,
                                                       const DescribedEquilibrium& here) {
    const BranchTest& known = here.tests[test];
    std::optional<DescribedEquilibrium> there;
    if (!known.singular)
        there = zero_of(test, bracket.first, bracket.second);
    if (!there) { // at or near a branch point Newton's method may fail: interpolate between safe points
        const PointTest value = [&](const ContinuationPoint& sample) {
            if (known.singular)
                return sample.determinant;
            const auto described = path_->describe(sample);
            return described ? described->tests[test].value : not_a_number;
        };
        if (const auto at = locate_crossing(*continuation_, value, bracket.first, bracket.second))
            there = path_->describe(*at);
    }
    if (!there)
        return std::nullopt;
    SpecialPoint special = special_of_type(known.type, there->point);
    special.bracket = std::minmax(before.point.parameter, here.point.parameter);
    special.event = known.event;
    const double size = std::max(std::abs(bracket.first.value), std::abs(bracket.second.value));
    return confirm(special, there->tests[test], *there, size) ? std::optional(special) : std::nullopt;
}

bool EquilibriumLocator::confirm(SpecialPoint& special, const BranchTest& test, const DescribedEquilibrium& there,
                                 double size) {
    constexpr double solved = 3e-11, small = 1e-3, neutral = 1e-7;
    const double field = there.evaluation.field.norm();
    const BranchSettings& settings = path_->settings();
    if (test.singular) // two branches that do not cross: the interpolated point is no solution
        return there.point.solution.residual < solved;
    special.located = std::abs(test.value) <= small * size;
    if (!special.located)
        return false;
    switch (test.type) {
    case PointType::hopf:
    case PointType::double_hopf:
    case PointType::zero_hopf:
        // The pair nearest to the axis may be another one on either side.
        if ((test.type != PointType::zero_hopf || path_->keeps(PointType::fold)) &&
            !(std::abs(test.value) <= neutral * field))
            return false;
        if (test.type == PointType::hopf)
            special.detail = hopf_in_words(there);
        return true;
    case PointType::boundary_equilibrium: {
        const auto others = meeting_equilibria(path_->system(), special.solution.orbit, test.event, path_->settings());
        special.detail =
            fmt::format("at '{}': {}", path_->model().events[test.event].name,
                        boundary_in_words(path_->model(), admissible_direction(there.evaluation, test.event), others));
        Certificate& certificate = special.solution.certificate;
        certificate.admissible = true; // on the surface round-off would decide
        certificate.reason.clear();
        return true;
    }
    case PointType::extremum: {
        const std::size_t place = path_->problem()->equations().free()[*test.parameter].place();
        special.detail = fmt::format("{} = {:.10g}", path_->model().independent_parameters()[place],
                                     special.solution.orbit.parameters[place]);
        return true;
    }
    case PointType::crossing:
        special.detail = fmt::format("{} = {:.10g}", settings.monitors[*test.monitor].name,
                                     settings.monitors[*test.monitor].crossings[test.crossing]);
        return true;
    case PointType::bound:
        return confirm_bound(special, test);
    default:
        return true;
    }
}

bool EquilibriumLocator::confirm_bound(SpecialPoint& special, const BranchTest& test) {
    const BranchSettings& settings = path_->settings();
    if (test.monitor) {
        special.detail =
            fmt::format("{} = {:.10g}", settings.monitors[*test.monitor].name, special.monitors[*test.monitor]);
        return true;
    }
    const FreeBounds bounds = test.free ? settings.free_bounds[*test.free]
                                        : FreeBounds{settings.parameter, settings.least, settings.greatest};
    const ParameterId parameter = bounds.parameter;
    double& value = special.solution.orbit.parameters[parameter.place()];
    const bool is_lower =
        !bounds.greatest || (bounds.least && std::abs(value - *bounds.least) < std::abs(value - *bounds.greatest));
    value = is_lower ? *bounds.least : *bounds.greatest; // round-off would leave it on either side
    special.parameter = special.solution.orbit.parameters[settings.parameter.place()];
    special.detail = fmt::format("{} = {:.10g}", path_->model().independent_parameters()[parameter.place()],
                                 special.solution.orbit.parameters[parameter.place()]);
    return true;
}

std::string EquilibriumLocator::hopf_in_words(const DescribedEquilibrium& there) const {
    const auto form = path_->form_at(there.evaluation, product_of_nearest_pair(there.point.solution.eigenvalues));
    if (!form)
        return "";
    std::size_t others = 0;
    for (const auto one : without_pair(there.point.solution.eigenvalues, form->frequency * form->frequency))
        others += one.real() > 0 ? 1 : 0;
    return in_words(*form, others);
}

std::optional<SpecialPoint> EquilibriumLocator::crossing_of_several(const DescribedEquilibrium& before,
                                                                    const DescribedEquilibrium& here) {
    double low = 0, high = 1;
    std::optional<DescribedEquilibrium> there;
    while (high - low > located_within) {
        const double middle = 0.5 * (low + high);
        auto next = describe_between(middle);
        if (!next)
            break;
        (next->unstable == before.unstable ? low : high) = middle;
        there = std::move(next);
    }
    path_->problem()->evaluate(here.at.u);
    if (!there)
        return std::nullopt;
    const std::vector<std::complex<double>>& all = there->point.solution.eigenvalues;
    const auto nearest =
        std::ranges::min_element(all, {}, [](std::complex<double> one) { return std::abs(one.real()); });
    const bool turns = nearest != all.end() && nearest->imag() != 0;
    SpecialPoint special = special_of_type(turns ? PointType::hopf : PointType::branch_point, there->point);
    special.located = false;
    special.detail =
        fmt::format("the number of unstable eigenvalues changes from {} to {} at once: what begins there is "
                    "not computed",
                    before.unstable, here.unstable);
    special.bracket = std::minmax(before.point.parameter, here.point.parameter);
    return special;
}

bool EquilibriumLocator::explains(const std::vector<SpecialPoint>& found, const DescribedEquilibrium& before,
                                  const DescribedEquilibrium& here) {
    std::size_t unstable = before.unstable;
    for (const SpecialPoint& one : found) {
        if (one.type == PointType::boundary_equilibrium || one.type == PointType::bound)
            return true; // the rest of the step may not belong to the branch
        const bool is_pair = one.type == PointType::hopf;
        if (!is_pair && one.type != PointType::fold && one.type != PointType::branch_point)
            continue;
        // The eigenvalues that stay on their sides there: all but the one or two that cross.
        std::vector<std::complex<double>> others = one.solution.eigenvalues;
        if (is_pair)
            others = without_pair(others, product_of_nearest_pair(others));
        else if (!others.empty())
            others.erase(std::ranges::min_element(others, {}, [](auto value) { return std::abs(value); }));
        const auto stay = static_cast<std::size_t>(
            std::ranges::count_if(others, [](std::complex<double> value) { return value.real() > 0; }));
        const std::size_t crossing = is_pair ? 2 : 1;
        if (unstable != stay && unstable != stay + crossing)
            return false;
        unstable = 2 * stay + crossing - unstable;
    }
    return unstable == here.unstable;
}

} // namespace graze
