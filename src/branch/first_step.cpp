#include "branch/first_step.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// True when a curve of torus points that starts at a resonance goes to the side where the pair is real.
bool is_beyond_torus(const DescribedPoint& start, const DescribedPoint& here) {
    const auto value = [](const std::vector<BranchTest>& tests, PointType type) {
        const auto test = std::ranges::find(tests, type, &BranchTest::type);
        return test == tests.end() ? 0 : test->value;
    };
    // The tests are the sum of the pair minus 2 and minus -2; the other resonance may be passed within one step.
    const bool from_one =
        std::abs(value(start.tests, PointType::resonance_1)) < std::abs(value(start.tests, PointType::resonance_2));
    return from_one ? value(here.tests, PointType::resonance_1) > 0 : value(here.tests, PointType::resonance_2) < 0;
}

/// True when a curve that starts at a contact of zero speed goes to the side of negative speeds.
bool has_no_contact(const SpecialPoint& kept, const Certificate& start, const Certificate& here) {
    constexpr double without_speed = 1e-6; // relative to the speed after the first step
    // The speed is zero all along: its sign is round-off.
    const bool without = is_grazing(kept.type) && kept.at_end;
    const auto& first = start.approach_speeds;
    const auto& then = here.approach_speeds;
    for (std::size_t s = 0; s < std::min(first.size(), then.size()); ++s)
        if (!(without && s == kept.segment) && then[s] < 0 && std::abs(first[s]) < without_speed * std::abs(then[s]))
            return true;
    return false;
}

} // namespace

std::optional<std::pair<BranchOutcome, std::string>>
wrong_side(const BranchSettings& settings, const DescribedPoint& start, const DescribedPoint& here) {
    using End = std::pair<BranchOutcome, std::string>;
    const Certificate& before = start.point.solution.certificate;
    const Certificate& after = here.point.solution.certificate;
    if (!settings.kept || here.point.step != 1)
        return std::nullopt;
    // The first orbit may be the limit of admissible ones.
    if (settings.stop_when_unphysical && !before.admissible && !after.admissible)
        return End{BranchOutcome::unphysical, before.reason};
    if (settings.kept->type == PointType::torus && is_beyond_torus(start, here))
        return End{BranchOutcome::stopped, "in this direction the two multipliers are real"};
    if (settings.stop_when_unphysical && has_no_contact(*settings.kept, before, after))
        return End{BranchOutcome::stopped, "in this direction the new contact has a negative speed"};
    return std::nullopt;
}

} // namespace graze
