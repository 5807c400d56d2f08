#include "branch/point_kind.hpp"

#include "branch/bounds.hpp"
#include "branch/contact_points.hpp"
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

/// The table of all kinds, in the order of PointType; functions that a kind does not have stay null.
constexpr std::array table{
    PointRule{.kind = {.type = PointType::fold,
                       .short_name = "SN",
                       .name = "fold",
                       .changes = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 7},
              .test = test_fold,
              .confirm = confirm_fold,
              .condition = condition_of_fold},
    PointRule{.kind = {.type = PointType::flip,
                       .short_name = "PD",
                       .name = "flip",
                       .changes = true,
                       .leads_on = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 9},
              .test = test_flip,
              .confirm = confirm_flip,
              .condition = condition_of_flip,
              .leave = leave_flip},
    PointRule{.kind = {.type = PointType::torus,
                       .short_name = "NS",
                       .name = "torus",
                       .changes = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 13},
              .test = test_torus,
              .confirm = confirm_torus,
              .condition = condition_of_torus},
    PointRule{.kind = {.type = PointType::branch_point,
                       .short_name = "BP",
                       .name = "branch point",
                       .changes = true,
                       .leads_on = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 5},
              .test = test_branch_point,
              .confirm = confirm_branch_point,
              .leave = leave_branch_point},
    PointRule{.kind = {.type = PointType::asymmetry,
                       .short_name = "SB",
                       .name = "loss of symmetry",
                       .changes = true,
                       .leads_on = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 5},
              .test = test_asymmetry,
              .confirm = confirm_flip,
              .condition = condition_of_flip,
              .leave = leave_asymmetry},
    PointRule{.kind = {.type = PointType::grazing,
                       .short_name = "GR",
                       .name = "grazing",
                       .changes = true,
                       .limits = true,
                       .leads_on = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 12},
              .test = test_grazing,
              .confirm = confirm_grazing,
              .rank = rank_of_grazing,
              .condition = condition_of_grazing,
              .leave = leave_grazing},
    PointRule{.kind = {.type = PointType::vanishing,
                       .short_name = "DZ",
                       .name = "vanishing segment",
                       .changes = true,
                       .limits = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 8},
              .test = test_vanishing,
              .confirm = confirm_vanishing,
              .rank = always<3>,
              .condition = condition_of_vanishing,
              .leave = leave_order},
    PointRule{.kind = {.type = PointType::two_events,
                       .short_name = "EE",
                       .name = "two events at once",
                       .changes = true,
                       .limits = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 4},
              .test = test_two_events,
              .confirm = confirm_two_events,
              .rank = always<4>,
              .condition = condition_of_two_events,
              .leave = leave_order},
    PointRule{.kind = {.type = PointType::guard,
                       .short_name = "GU",
                       .name = "guard",
                       .changes = true,
                       .limits = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 10},
              .test = test_guard,
              .confirm = confirm_guard,
              .rank = always<5>,
              .condition = condition_of_guard,
              .leave = leave_order},
    PointRule{.kind = {.type = PointType::cusp, .short_name = "CP", .name = "cusp", .may_stop = true, .mark = 3},
              .test = test_degeneracy<PointType::cusp>,
              .confirm = confirm_cusp},
    PointRule{.kind = {.type = PointType::generalised,
                       .short_name = "GF",
                       .name = "generalised flip",
                       .may_stop = true,
                       .mark = 11},
              .test = test_degeneracy<PointType::generalised>,
              .confirm = confirm_generalised},
    PointRule{.kind = {.type = PointType::generalised_torus,
                       .short_name = "GT",
                       .name = "generalised torus",
                       .may_stop = true,
                       .mark = 11},
              .test = test_degeneracy<PointType::generalised_torus>},
    PointRule{
        .kind =
            {.type = PointType::resonance_1, .short_name = "R1", .name = "1:1 resonance", .may_stop = true, .mark = 6},
        .test = test_degeneracy<PointType::resonance_1>,
        .confirm = confirm_resonance},
    PointRule{
        .kind =
            {.type = PointType::resonance_2, .short_name = "R2", .name = "1:2 resonance", .may_stop = true, .mark = 6},
        .test = test_degeneracy<PointType::resonance_2>,
        .confirm = confirm_resonance},
    PointRule{
        .kind =
            {.type = PointType::resonance_3, .short_name = "R3", .name = "1:3 resonance", .may_stop = true, .mark = 6},
        .test = test_degeneracy<PointType::resonance_3>},
    PointRule{
        .kind =
            {.type = PointType::resonance_4, .short_name = "R4", .name = "1:4 resonance", .may_stop = true, .mark = 6},
        .test = test_degeneracy<PointType::resonance_4>},
    PointRule{.kind = {.type = PointType::sensitivity,
                       .short_name = "VS",
                       .name = "vanishing sensitivity",
                       .may_stop = true,
                       .mark = 14},
              .test = test_sensitivity,
              .confirm = confirm_sensitivity},
    PointRule{.kind = {.type = PointType::fold_degenerate,
                       .short_name = "DF",
                       .name = "fold-degenerate grazing",
                       .may_stop = true,
                       .mark = 14},
              .confirm = confirm_degenerate_grazing},
    PointRule{.kind = {.type = PointType::flip_degenerate,
                       .short_name = "DP",
                       .name = "flip-degenerate grazing",
                       .may_stop = true,
                       .mark = 14},
              .confirm = confirm_degenerate_grazing},
    PointRule{.kind = {.type = PointType::zero_acceleration,
                       .short_name = "ZA",
                       .name = "zero acceleration",
                       .limits = true,
                       .may_stop = true,
                       .mark = 14},
              .test = test_acceleration,
              .confirm = confirm_acceleration,
              .rank = always<1>},
    PointRule{.kind = {.type = PointType::double_grazing,
                       .short_name = "DG",
                       .name = "double grazing",
                       .limits = true,
                       .leads_on = true,
                       .may_stop = true,
                       .mark = 12},
              .confirm = confirm_double_grazing,
              .rank = rank_of_grazing,
              .leave = leave_double_grazing},
    PointRule{
        .kind = {.type = PointType::fold_flip, .short_name = "FP", .name = "fold-flip", .may_stop = true, .mark = 15},
        .confirm = confirm_fold_flip},
    PointRule{
        .kind = {.type = PointType::fold_torus, .short_name = "FT", .name = "fold-torus", .may_stop = true, .mark = 15},
        .confirm = confirm_with_torus},
    PointRule{
        .kind = {.type = PointType::flip_torus, .short_name = "PT", .name = "flip-torus", .may_stop = true, .mark = 15},
        .confirm = confirm_with_torus},
    PointRule{.kind = {.type = PointType::chatter,
                       .short_name = "CH",
                       .name = "onset of chatter",
                       .changes = true,
                       .limits = true,
                       .mark = 15}},
    PointRule{.kind = {.type = PointType::hopf, .short_name = "HB", .name = "Hopf point", .changes = true, .mark = 5}},
    PointRule{
        .kind = {.type = PointType::extremum, .short_name = "EX", .name = "extremum", .may_stop = true, .mark = 1},
        .test = test_extremum,
        .confirm = confirm_extremum},
    PointRule{.kind = {.type = PointType::bound, .short_name = "BD", .name = "bound"},
              .test = test_bounds,
              .confirm = confirm_bound},
    PointRule{
        .kind = {.type = PointType::crossing, .short_name = "UZ", .name = "crossing", .may_stop = true, .mark = 2},
        .test = test_crossings,
        .confirm = confirm_crossing},
    PointRule{.kind = {.type = PointType::end, .short_name = "EP", .name = "end"}},
    PointRule{.kind = {.type = PointType::regular, .short_name = "RG", .name = "regular"}},
};

constexpr auto kinds = [] {
    std::array<PointKind, table.size()> result;
    for (std::size_t i = 0; i < table.size(); ++i)
        result[i] = table[i].kind;
    return result;
}();

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

namespace {

constexpr std::string_view digits = "0123456789";

/// Returns "-" if a type ends with a digit, to separate it from the number.
std::string_view separator_after(std::string_view type) {
    return digits.find(type.back()) != std::string_view::npos ? "-" : "";
}

} // namespace

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

namespace {

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

std::optional<HeldLimit> held_limit_of(const SpecialPoint& point) {
    const auto held = [&](HeldLimit::Kind kind) { return HeldLimit{kind, point.segment, point.event, 0}; };
    switch (point.type) {
    case PointType::grazing:
        if (!point.at_end)
            return held(HeldLimit::Kind::touch);
        return HeldLimit{HeldLimit::Kind::stop, point.segment, point.event,
                         zero_durations_after(point.solution.orbit, point.segment)};
    case PointType::vanishing:
        return held(HeldLimit::Kind::vanishing);
    case PointType::guard:
        return held(HeldLimit::Kind::guard);
    default:
        return std::nullopt;
    }
}

std::vector<BranchTest> branch_tests(const TestedPoint& point) {
    std::vector<BranchTest> tests;
    for (const PointRule& rule : table)
        if (rule.test)
            rule.test(point, tests);
    return tests;
}

} // namespace graze
