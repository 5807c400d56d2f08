#include "branch/point_kind.hpp"

#include "branch/bounds.hpp"
#include "branch/contact_points.hpp"
#include "branch/cycle_at_hopf.hpp"
#include "branch/homoclinic_end.hpp"
#include "branch/multiplier_points.hpp"
#include "branch/parameter_points.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace graze {

namespace {

template <int Rank>
int always(const SpecialPoint&) {
    return Rank;
}

/// The properties of PointKind that an entry of the table has.
constexpr unsigned changes = 1, limits = 2, has_bifurcating_branch = 4, may_stop = 8, may_be_kept = 16;

constexpr PointKind kind(PointType type, std::string_view short_name, std::string_view name, unsigned properties = 0,
                         int mark = 0) {
    const auto has = [&](unsigned property) { return (properties & property) != 0; };
    return {type,          short_name,       name, has(changes), has(limits), has(has_bifurcating_branch),
            has(may_stop), has(may_be_kept), mark};
}

/// The table of all kinds, in the order of PointType; functions that a kind does not have stay null.
constexpr std::array table{
    PointRule{.kind = kind(PointType::fold, "SN", "fold", changes | may_stop | may_be_kept, 7),
              .test = test_fold,
              .confirm = confirm_fold,
              .condition = condition_of_fold},
    PointRule{.kind = kind(PointType::flip, "PD", "flip", changes | has_bifurcating_branch | may_stop | may_be_kept, 9),
              .test = test_flip,
              .confirm = confirm_flip,
              .condition = condition_of_flip,
              .leave = leave_flip},
    PointRule{.kind = kind(PointType::torus, "NS", "torus", changes | may_stop | may_be_kept, 13),
              .test = test_torus,
              .confirm = confirm_torus,
              .condition = condition_of_torus},
    PointRule{.kind = kind(PointType::branch_point, "BP", "branch point",
                           changes | has_bifurcating_branch | may_stop | may_be_kept, 5),
              .test = test_branch_point,
              .confirm = confirm_branch_point,
              .leave = leave_branch_point},
    PointRule{.kind = kind(PointType::asymmetry, "SB", "loss of symmetry",
                           changes | has_bifurcating_branch | may_stop | may_be_kept, 5),
              .test = test_asymmetry,
              .confirm = confirm_flip,
              .condition = condition_of_flip,
              .leave = leave_asymmetry},
    PointRule{.kind = kind(PointType::grazing, "GR", "grazing",
                           changes | limits | has_bifurcating_branch | may_stop | may_be_kept, 12),
              .test = test_grazing,
              .confirm = confirm_grazing,
              .rank = rank_of_grazing,
              .condition = condition_of_grazing,
              .leave = leave_grazing},
    PointRule{.kind =
                  kind(PointType::vanishing, "DZ", "vanishing segment", changes | limits | may_stop | may_be_kept, 8),
              .test = test_vanishing,
              .confirm = confirm_vanishing,
              .rank = always<3>,
              .condition = condition_of_vanishing,
              .leave = leave_order},
    PointRule{.kind =
                  kind(PointType::two_events, "EE", "two events at once", changes | limits | may_stop | may_be_kept, 4),
              .test = test_two_events,
              .confirm = confirm_two_events,
              .rank = always<4>,
              .condition = condition_of_two_events,
              .leave = leave_order},
    PointRule{.kind = kind(PointType::guard, "GU", "guard", changes | limits | may_stop | may_be_kept, 10),
              .test = test_guard,
              .confirm = confirm_guard,
              .rank = always<5>,
              .condition = condition_of_guard,
              .leave = leave_order},
    PointRule{.kind = kind(PointType::cusp, "CP", "cusp", may_stop, 3),
              .test = test_degeneracy<PointType::cusp>,
              .confirm = confirm_cusp},
    PointRule{.kind = kind(PointType::generalised, "GF", "generalised flip", may_stop, 11),
              .test = test_degeneracy<PointType::generalised>,
              .confirm = confirm_beside_flip},
    PointRule{.kind = kind(PointType::generalised_torus, "GT", "generalised torus", may_stop, 11),
              .test = test_degeneracy<PointType::generalised_torus>},
    PointRule{.kind = kind(PointType::resonance_1, "R1", "1:1 resonance", may_stop, 6),
              .test = test_degeneracy<PointType::resonance_1>,
              .confirm = confirm_resonance},
    PointRule{.kind = kind(PointType::resonance_2, "R2", "1:2 resonance", may_stop, 6),
              .test = test_degeneracy<PointType::resonance_2>,
              .confirm = confirm_resonance},
    PointRule{.kind = kind(PointType::resonance_3, "R3", "1:3 resonance", may_stop, 6),
              .test = test_degeneracy<PointType::resonance_3>},
    PointRule{.kind = kind(PointType::resonance_4, "R4", "1:4 resonance", may_stop, 6),
              .test = test_degeneracy<PointType::resonance_4>},
    PointRule{.kind = kind(PointType::sensitivity, "VS", "vanishing sensitivity", may_stop, 14),
              .test = test_sensitivity,
              .confirm = confirm_sensitivity},
    PointRule{.kind = kind(PointType::fold_degenerate, "DF", "fold-degenerate grazing", may_stop, 14),
              .confirm = confirm_degenerate_grazing},
    PointRule{.kind = kind(PointType::flip_degenerate, "DP", "flip-degenerate grazing", may_stop, 14),
              .confirm = confirm_degenerate_grazing},
    PointRule{.kind = kind(PointType::zero_acceleration, "ZA", "zero acceleration", limits | may_stop, 14),
              .test = test_acceleration,
              .confirm = confirm_acceleration,
              .rank = always<1>},
    PointRule{
        .kind = kind(PointType::double_grazing, "DG", "double grazing", limits | has_bifurcating_branch | may_stop, 12),
        .confirm = confirm_double_grazing,
        .rank = rank_of_grazing,
        .leave = leave_double_grazing},
    PointRule{.kind = kind(PointType::fold_flip, "FP", "fold-flip", may_stop, 15), .confirm = confirm_beside_flip},
    PointRule{.kind = kind(PointType::fold_torus, "FT", "fold-torus", may_stop, 15), .confirm = confirm_with_torus},
    PointRule{.kind = kind(PointType::flip_torus, "PT", "flip-torus", may_stop, 15), .confirm = confirm_with_torus},
    PointRule{.kind = kind(PointType::chatter, "CH", "onset of chatter", changes | limits, 15)},
    PointRule{
        .kind = kind(PointType::hopf, "HB", "Hopf point", changes | has_bifurcating_branch | may_stop | may_be_kept, 5),
        .leave = leave_hopf},
    PointRule{.kind = kind(PointType::boundary_equilibrium, "BE", "boundary equilibrium",
                           changes | limits | may_stop | may_be_kept, 10)},
    PointRule{.kind = kind(PointType::takens_bogdanov, "BT", "Bogdanov-Takens point", may_stop, 6)},
    PointRule{.kind = kind(PointType::zero_hopf, "ZH", "zero-Hopf point", may_stop, 15)},
    PointRule{.kind = kind(PointType::double_hopf, "HH", "double Hopf point", may_stop, 15)},
    PointRule{.kind = kind(PointType::generalised_hopf, "GH", "generalised Hopf point", may_stop, 11)},
    PointRule{.kind = kind(PointType::homoclinic, "HC", "homoclinic orbit", changes | may_be_kept, 3),
              .condition = condition_of_homoclinic},
    PointRule{
        .kind = kind(PointType::homoclinic_tangency, "HT", "homoclinic tangency", changes | may_stop | may_be_kept, 7),
        .test = test_homoclinic_tangency,
        .confirm = confirm_homoclinic_tangency,
        .condition = condition_of_fold},
    PointRule{.kind = kind(PointType::locking, "PL", "phase locking", changes, 6)},
    PointRule{.kind = kind(PointType::extremum, "EX", "extremum", may_stop, 1),
              .test = test_extremum,
              .confirm = confirm_extremum},
    PointRule{.kind = kind(PointType::bound, "BD", "bound"), .test = test_bounds, .confirm = confirm_bound},
    PointRule{.kind = kind(PointType::crossing, "UZ", "crossing", may_stop, 2),
              .test = test_crossings,
              .confirm = confirm_crossing},
    PointRule{.kind = kind(PointType::end, "EP", "end")},
    PointRule{.kind = kind(PointType::regular, "RG", "regular")},
};

constexpr auto kinds = [] {
    std::array<PointKind, table.size()> result;
    for (std::size_t i = 0; i < table.size(); ++i)
        result[i] = table[i].kind;
    return result;
}();

constexpr std::string_view digits = "0123456789";

/// Returns "-" if a type ends with a digit, to separate it from the number.
std::string_view separator_after(std::string_view type) {
    return digits.find(type.back()) != std::string_view::npos ? "-" : "";
}

/// Returns the number of segments of zero duration after a segment.
std::size_t zero_durations_after(const Orbit& orbit, std::size_t segment) {
    constexpr double nothing = 1e-8; // share of the period; located points are far more accurate
    const std::size_t count = orbit.durations.size();
    std::size_t result = 0;
    while (result + 1 < count &&
           std::abs(orbit.durations[(segment + result + 1) % count]) < nothing * orbit.return_time())
        ++result;
    return result;
}

} // namespace

std::span<const PointRule> point_rules() {
    return table;
}

const PointRule& rule_of(PointType type) {
    require_index(static_cast<std::size_t>(type), table.size(), "type of points");
    return table[static_cast<std::size_t>(type)];
}

std::span<const PointKind> point_kinds() {
    return kinds;
}

const PointKind& kind_of(PointType type) {
    return rule_of(type).kind;
}

std::optional<PointType> point_type(std::string_view name) {
    for (const PointRule& rule : table)
        if (name == rule.kind.short_name)
            return rule.kind.type;
    return std::nullopt;
}

std::string point_label(PointType type, std::size_t number) {
    const std::string_view name = short_name(type);
    return fmt::format("{}{}{}", name, separator_after(name), number);
}

bool is_point_label(std::string_view text) {
    return std::any_of(table.begin(), table.end(), [&](const PointRule& rule) {
        const std::string begin = fmt::format("{}{}", rule.kind.short_name, separator_after(rule.kind.short_name));
        return text.size() > begin.size() && text.starts_with(begin) &&
               text.find_first_not_of(digits, begin.size()) == std::string_view::npos;
    });
}

std::optional<HeldLimit> held_limit_of(const SpecialPoint& point) {
    const auto held = [&](HeldLimit::Kind kind, std::size_t zero_durations = 0) {
        return HeldLimit{kind, point.segment, point.event, zero_durations};
    };
    if (point.type == PointType::grazing)
        return point.at_end ? held(HeldLimit::Kind::stop, zero_durations_after(point.solution.orbit, point.segment))
                            : held(HeldLimit::Kind::touch);
    if (point.type == PointType::vanishing)
        return held(HeldLimit::Kind::vanishing);
    return point.type == PointType::guard ? std::optional(held(HeldLimit::Kind::guard)) : std::nullopt;
}

SpecialPoint grazing_at(const SpecialPoint& point, const OrbitTouch& touch) {
    SpecialPoint result = point;
    result.type = PointType::grazing;
    result.segment = touch.segment;
    result.event = touch.event;
    result.time = touch.time;
    result.at_end = touch.at_end;
    return result;
}

std::optional<OrbitMinimum> touch_in(const Certificate& certificate, std::size_t segment, std::size_t event) {
    std::optional<OrbitMinimum> nearest;
    for (const OrbitMinimum& one : certificate.minima)
        if (one.segment == segment && one.event == event &&
            (!nearest || std::abs(one.value) < std::abs(nearest->value)))
            nearest = one;
    return nearest;
}

std::optional<OrbitMinimum> nearest_touch(const Certificate& certificate, std::size_t event) {
    double distance = 1e-2;
    std::optional<OrbitMinimum> nearest;
    for (const OrbitMinimum& one : certificate.minima)
        if (one.event == event && std::abs(one.value) < distance * one.size) {
            distance = std::abs(one.value) / one.size;
            nearest = one;
        }
    return nearest;
}

std::vector<BranchTest> branch_tests(const TestedPoint& point) {
    // A homoclinic orbit has no multipliers, but contacts that may change, and quantities with bounds and extrema.
    const bool to_cycle = point.equations.cycle_ends() != nullptr,
               homoclinic = to_cycle || point.equations.homoclinic_ends() != nullptr;
    const auto applies = [homoclinic, to_cycle](const PointKind& kind) {
        if (kind.type == PointType::homoclinic_tangency)
            return to_cycle;
        return !homoclinic || kind.limits || kind.type == PointType::extremum || kind.type == PointType::bound ||
               kind.type == PointType::crossing;
    };
    std::vector<BranchTest> tests;
    for (const PointRule& rule : table)
        if (rule.test && applies(rule.kind))
            rule.test(point, tests);
    if (homoclinic) // of which the period is infinite
        std::erase_if(tests, [](const BranchTest& one) { return one.type == PointType::extremum && !one.parameter; });
    return tests;
}

} // namespace graze
