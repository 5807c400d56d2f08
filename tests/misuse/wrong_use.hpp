#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <limits>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include "graze/symbolic/input_error.hpp"

namespace graze::testing {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr std::size_t huge = static_cast<std::size_t>(-1);

/// Something that a user might do by mistake.
struct WrongUse {
    std::string name;
    std::function<void()> use;
};
inline std::ostream& operator<<(std::ostream& stream, const WrongUse& use) {
    return stream << use.name;
}

/// Uses that look wrong and are allowed after all, by what is in their names.
inline bool is_allowed(const std::string& name) {
    static const std::vector<std::string> parts = {
        "moved", // may be assigned to or destroyed, no more
        "_no_kind",
        "_no_direction",
        "_no_end",
        "_no_set",
        "stop_at_nothing", // enumerators that only a cast makes
        "_without_end",
        "name_of_no_",
        "no_quadrature",
        "add_orbit_no_type",
        "function_inputs_too_long",
        "inputs_too_long",
        "errors_too_long", // rooms may be larger than is needed
        "results_too_long",
        "bounds_too_long",
        "times_too_long",
        "values_too_long",
        "slopes_too_long",
        "references_too_long",
        "steps_too_long",
        "lengths_too_long",
        "guard_steps_too_long",
        "floors_too_long",
        "series_too_long",
        "shortened_to",
        "infinite_end",
        "end_time_infinite",
        "extend_infinite",
        "extend_unfinished",        // changes nothing
        "duration_negative",        // such orbits are marked as unphysical
        "transition_label_empty",   // named by mode and event
        "parameter_values_missing", // NaN, as is said
        "steps_0",
        "step_limit_0",
        "touch_infinite",
        "no_segments", // little is asked for, or much
        "direction_zero",
        "distance_negative",
        "row_zero",
        "between_2",
        "between__1",
        "next_step_infinite",
        "next_step_before_start_infinite",
        "start_direction_0",
        "along_nothing", // an outcome says what becomes of it
        "settings_monitor_",
        "branches_at_monitor_",
        "orbit_branch_monitor_duration", // found where it is used
        "monitors_bounds",
        "monitors_crossing",
        "monitors_held",
        "monitors_place",
        "monitors_duration_of",
        "image_of_duration",
        "image_of_parameter",
        "image_of_start",
        "image_of_signature",
        "image_of_section",
        "image_of_symmetry",
        "image_of_mode",
        "image_of_segment", // looks at nothing of the orbit but values at its starts
        "mode_huge_",
        "mode_size_",
        "of_another_mode",             // names of ends do not need the mode
        "dense_problem_unknowns_huge", // does not fit into memory
        "make_jet_tape",               // a tape that was spoiled by hand
        "outlook_",
        "advance_",
        "propose_",
        "step_state_of", // asked at every step, and said to be unchecked
        "sampler_period",
        "grazing_time",
        "orbit_without_tangent", // no number that could be compared
        "search_proceed",
        "search_trajectory", // in another order than is said
        "longest_return_infinite",
        "time_infinite",
        "speed_infinite",
        "contacts_of_nothing",
        "contact_of_nothing",
        "no_chains",
        "without_points",
        "points_that_overflow",
        "plan_of_default",
        "axis_without_values", // no bound, or nothing to do
        "order_for_tolerance_1",
        "order_for_tolerance_inf",
        "tolerance_1_",
        "tolerance_inf", // count as the nearest
        "series_too_short",
        "not_for_tangents",
        "find_disagreement_lengths", // parts of what there is are allowed
        "patience_negative",
        "query_select",
        "query_values",
        "rows_number_of",
        "run_twice",
        "spectrum_of_nothing",
        // What the file does not have: nothing is found.
        "results_complete_unknown",
        "results_last_points",
        "results_nearest",
        "results_orbit_unknown",
        "results_orbits",
        "results_point_count",
        "results_point_unknown",
        "results_remove_unknown",
        // What other programs may write as well.
        "results_add_orbit_approach",
        "results_add_point_no_label",
        "results_add_point_number",
        "results_begin_run_column",
        "results_begin_run_settings",
    };
    return std::any_of(parts.begin(), parts.end(),
                       [&](const std::string& part) { return name.find(part) != std::string::npos; });
}

/// Gathers wrong uses under names that GoogleTest admits.
class WrongUses {
public:
    void operator()(std::string name, std::function<void()> use) {
        for (char& c : name)
            if (!std::isalnum(static_cast<unsigned char>(c)))
                c = '_';
        if (is_allowed(name))
            return;
        std::size_t same = 0;
        for (const WrongUse& other : list_)
            same += other.name == name || other.name.starts_with(name + "_again");
        if (same > 0)
            name += "_again" + std::to_string(same);
        list_.push_back({std::move(name), std::move(use)});
    }
    const std::vector<WrongUse>& list() const { return list_; }

private:
    std::vector<WrongUse> list_;
};

/// What a call returns is not thrown away by the compiler.
template <class T>
void keep(const T& value) {
    asm volatile("" : : "r"(&value) : "memory");
}

/// Indices that something of a size does not have.
inline std::vector<std::pair<std::string, std::size_t>> wrong_indices(std::size_t size) {
    return {{"size", size}, {"size_plus_1", size + 1}, {"huge", huge}};
}
/// Lengths of spans that should have another.
inline std::vector<std::pair<std::string, std::size_t>> wrong_lengths(std::size_t length) {
    std::vector<std::pair<std::string, std::size_t>> result = {{"too_long", length + 1}};
    if (length > 0)
        result.emplace_back("empty", 0);
    if (length > 1)
        result.emplace_back("too_short", length - 1);
    return result;
}
inline std::vector<std::pair<std::string, double>> not_finite() {
    return {{"nan", not_a_number}, {"infinite", infinity}, {"minus_infinite", -infinity}};
}
/// What is no positive number.
inline std::vector<std::pair<std::string, double>> not_positive() {
    return {{"zero", 0}, {"negative", -1}, {"nan", not_a_number}, {"infinite", infinity}};
}
/// What is no number from 0 on.
inline std::vector<std::pair<std::string, double>> negative() {
    return {{"negative", -1}, {"nan", not_a_number}, {"infinite", infinity}};
}

/// Demands that a wrong use is refused in words of the library: neither by nothing nor by what the standard library
/// says of itself (which names nothing).
inline void expect_refusal(const WrongUse& wrong) {
    try {
        wrong.use();
    } catch (const std::exception& refusal) {
        const std::string what = refusal.what();
        ::testing::Test::RecordProperty("type", typeid(refusal).name());
        ::testing::Test::RecordProperty("what", what);
        EXPECT_TRUE(dynamic_cast<const InputError*>(&refusal) || dynamic_cast<const std::logic_error*>(&refusal))
            << "FOREIGN " << wrong.name << ": " << typeid(refusal).name() << ": " << what;
        EXPECT_FALSE(what.empty());
        for (const std::string foreign : {"vector::", "basic_string", "bad_", "map::at", "array::at", "_M_", "std::"})
            EXPECT_EQ(what.find(foreign), std::string::npos) << "FOREIGN " << wrong.name << ": " << what;
        return;
    }
    ADD_FAILURE() << "SILENT " << wrong.name << ": no exception";
}

/// Goes through all of them, or those alone whose names begin as the environment's WRONG_USE says: for one that
/// crashes.
inline void each_of(const std::vector<WrongUse>& uses, const std::function<void(const WrongUse&)>& visit) {
    const char* chosen = std::getenv("WRONG_USE");
    for (const WrongUse& use : uses) {
        if (chosen && !use.name.starts_with(chosen))
            continue;
        SCOPED_TRACE(use.name);
        if (chosen)
            std::fprintf(stderr, "%s\n", use.name.c_str());
        visit(use);
    }
}

} // namespace graze::testing
