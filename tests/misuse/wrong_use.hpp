#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <limits>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "graze/base/input_error.hpp"

namespace graze::testing {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr std::size_t huge = static_cast<std::size_t>(-1);

/// A mistake that a user of the library might make.
struct WrongUse {
    std::string name;
    std::function<void()> use;
};
inline std::ostream& operator<<(std::ostream& stream, const WrongUse& use) {
    return stream << use.name;
}

/// Uses that look wrong but are accepted. They are run and must not be refused, so that the list stays correct. A star
/// matches anything.
inline constexpr std::string_view accepted[] = {
    // Enumerators that only a cast can make.
    "name_of_no_*_outcome",
    "name_of_no_ending",
    "name_of_no_label",
    "name_of_no_run_kind",
    "name_of_no_set",
    "*_event_of_no_kind",
    "*_section_in_no_direction",
    "probe_of_no_kind",
    "probe_in_no_direction",
    "microbeam_no_quadrature",
    "*_stop_at_nothing",
    "end_name_no_end",
    "to_string_no_end",
    "orbit_monitors_signature_no_end",
    // Buffers may be larger than needed.
    "evaluate_inputs_too_long",
    "evaluate_results_too_long",
    "error_bounds_*_too_long",
    "jet_*_times_too_long",
    "jet_*_values_too_long",
    "jet_*_slopes_too_long",
    "jet_*_references_too_long",
    "jet_*_steps_too_long",
    "jet_*_lengths_too_long",
    "step_check_series_too_long",
    "step_check_floors_too_long",
    "step_size_floors_too_long",
    // A part of the output may be requested.
    "step_check_series_too_short",
    "jet_*_find_disagreement_lengths",
    "jet_2_guard_steps_not_for_tangents",
    // Clamped to the nearest valid value.
    "order_for_tolerance_1_000000",
    "order_for_tolerance_inf",
    "step_size_tolerance_1_000000",
    "step_size_tolerance_inf",
    "step_check_tolerance_1_000000",
    "step_check_tolerance_inf",
    // Infinite means no bound; zero means nothing to do.
    "*_longest_return_infinite",
    "transient_*_time_infinite",
    "*_greatest_speed_infinite",
    "*_touch_infinite",
    "*_step_limit_0",
    "*_steps_0",
    "end_time_infinite",
    "extend_infinite",
    "extend_unfinished",
    "signature_search_no_segments",
    "*_contacts_of_nothing",
    "*_sampling_contact_of_nothing",
    "execute_no_chains",
    "execute_chains_without_points",
    "run_study_axis_without_values",
    "run_study_run_twice",
    "plan_of_default_run",
    "spectrum_of_nothing",
    "shortened_to_nothing",
    "shortened_to_too_little",
    "patience_negative",
    "sampler_period_negative",
    // The outcome or a returned value reports the problem.
    "continuation_start_direction_0",
    "continuation_along_direction_zero",
    "continuation_along_distance_negative",
    "continuation_at_row_zero",
    "continuation_next_step_infinite",
    "continuation_next_step_before_start_infinite",
    "continuation_between__1_000000",
    "continuation_between_2_000000",
    "orbit_branch_along_nothing",
    "orbit_branch_along_distance_negative",
    "*_duration_negative", // such orbits are marked as inadmissible
    "parameter_values_missing",
    // The name is made from mode and event.
    "*_transition_label_empty",
    // Detected at the first use.
    "branch_settings_monitor_of_*",
    "branch_settings_monitor_segment_*",
    "branches_at_monitor_of_*",
    "branches_at_monitor_segment_*",
    "orbit_branch_monitor_of_no_kind",
    "monitors_of_no_kind",
    "*_monitor_duration_of_expression",
    "monitors_duration_of_expression",
    "monitors_place_0",
    "monitors_held_nan",
    "monitors_crossing_nan",
    "monitors_bounds_reversed",
    "branches_at_orbit_without_tangent_of_type_1",
    "branches_at_orbit_without_tangent_of_type_3",
    "branches_at_orbit_without_tangent_of_type_4",
    "branches_at_grazing_time_negative",
    "branches_at_grazing_time_after_the_end",
    // Only the starts of the orbit are used; names of ends do not need the mode.
    "image_of_signature_longer",
    "image_of_segment_without_end",
    "image_of_start_*",
    "image_of_duration_*",
    "image_of_parameter*",
    "image_of_symmetry_*",
    "image_of_cycle_*",
    "image_of_mode_size", // the symmetric model has one mode more
    "image_of_section_size",
    "end_name_mode_*",
    "end_name_transition_of_another_mode",
    "to_string_transition_of_another_mode",
    "orbit_monitors_signature_transition_of_another_mode",
    // Unknown items of a file: the result is empty.
    "results_complete_unknown",
    "results_last_points_unknown",
    "results_last_points_of_empty_chains",
    "results_nearest_unknown",
    "results_nearest_coordinate_unknown",
    "results_nearest_direction_unknown",
    "results_nearest_to_nan",
    "results_orbit_unknown",
    "results_orbits_unknown",
    "results_orbits_of_sweep",
    "results_point_count_unknown",
    "results_point_unknown",
    "results_remove_unknown",
    // Other programs may write such files.
    "results_add_orbit_approach_speeds_missing",
    "results_add_point_no_label",
    "results_add_point_number_*",
    "results_begin_run_column_twice",
    "results_begin_run_column_without_name",
    "results_begin_run_settings_no_json",
    // The same as in SQL.
    "query_select__1",
};

/// Calls in another order than documented, which must be refused as such.
inline constexpr std::string_view out_of_order[] = {
    "run_before_start",
    "extend_before_start",
    "propose_before_start",
    "mode_flow_before_parameters",
    "second_order_before_parameters",
    "tangent_steps_carry_before_a_step",
};

/// Uses that are not run, because their behaviour is undefined.
inline constexpr std::string_view unchecked[] = {
    // A moved-from model may only be assigned to or destroyed.
    "moved_model_*",
    "moved_monitors",
    "moved_simulation",
    "moved_system",
    "moved_variational_system",
    "moved_trajectory_start",
    "moved_trajectory_extend",
    "moved_trajectory_carry",
    "orbit_branch_moved_start",
    "orbit_branch_moved_found",
    "orbit_branch_moved_outcome",
    "rows_is_*_moved",
    "rows_number_moved",
    "rows_integer_moved",
    "rows_text_moved",
    "rows_moved_*",
    // A tape that was modified by hand.
    "make_jet_tape_*",
    // Called at every step and documented as unchecked.
    "step_state_of_no_step",
    "preview_of_another_width",
    "preview_length_*",
    "preview_agrees_*",
    "preview_state_lane_*",
    "preview_least_lane_*",
    "preview_size_lane_*",
    "propose_after_end",
    "propose_with_another_models_jet",
    "advance_after_end",
    "advance_lane_*",
    "advance_with_another_models_preview",
    // Calls in another order than documented.
    "attractor_search_proceed_*",
    "transient_search_proceed_*",
    "*_search_trajectory_before_begin",
    // Would exceed memory or time.
    "dense_problem_unknowns_huge",
    "execute_points_that_overflow",
};

inline bool matches(std::string_view name, std::string_view pattern) {
    const std::size_t star = pattern.find('*');
    if (star == std::string_view::npos)
        return name == pattern;
    const std::string_view end = pattern.substr(star + 1);
    return name.size() + 1 >= pattern.size() && name.starts_with(pattern.substr(0, star)) && name.ends_with(end);
}
inline bool is_among(std::span<const std::string_view> patterns, std::string_view name) {
    return std::any_of(patterns.begin(), patterns.end(), [&](const auto& pattern) { return matches(name, pattern); });
}

/// Collects wrong uses under names that are valid in GoogleTest.
class WrongUses {
public:
    /// @param use takes nothing, or one object, which is made for it
    template <class Use>
    void operator()(std::string name, Use use) {
        add(std::move(name), callable(std::move(use)));
    }
    /// Adds a use for each value of a list.
    /// @param use takes a value, or an object, which is made for it, and a value
    template <class Value, class Use>
    void operator()(const std::string& name, const std::vector<std::pair<std::string, Value>>& values, Use use) {
        for (const auto& [how, value] : values)
            add(name + "_" + how, callable(use), value);
    }
    /// Adds uses of an object with a mistake, each under its own name and that of the mistake.
    template <class Object>
    class Spoiled {
    public:
        using Uses = std::vector<std::pair<std::string, std::function<void(Object&)>>>;
        /// @param make returns the object without a mistake
        Spoiled(WrongUses& wrong, std::function<Object()> make, Uses uses)
            : wrong_(wrong), make_(std::move(make)), uses_(std::move(uses)) {}
        void operator()(const std::string& mistake, const std::function<void(Object&)>& spoil) const {
            for (const auto& [name, use] : uses_)
                wrong_(name + "_" + mistake, [make = make_, spoil, use = use] {
                    Object object = make();
                    spoil(object);
                    use(object);
                });
        }
        /// The same for a mistake with each value of a list.
        template <class Value>
        void operator()(const std::string& mistake, const std::vector<std::pair<std::string, Value>>& values,
                        const std::type_identity_t<std::function<void(Object&, Value)>>& spoil) const {
            for (const auto& [how, value] : values)
                (*this)(mistake + "_" + how, [spoil, value = value](Object& object) { spoil(object, value); });
        }

    private:
        WrongUses& wrong_;
        std::function<Object()> make_;
        Uses uses_;
    };
    template <class Object>
    Spoiled<Object> spoiled(std::function<Object()> make, typename Spoiled<Object>::Uses uses) {
        return {*this, std::move(make), std::move(uses)};
    }
    const std::vector<WrongUse>& list() const { return list_; }

private:
    /// Lambdas without captures are functions: then a compiler makes the code around them once for all that take the
    /// same.
    template <class Use>
    static auto callable(Use use) {
        if constexpr (requires { +use; })
            return std::function(+use);
        else
            return std::function(std::move(use));
    }
    void add(std::string name, std::function<void()> use) {
        for (char& c : name)
            if (!std::isalnum(static_cast<unsigned char>(c)))
                c = '_';
        if (is_among(unchecked, name))
            return;
        std::size_t same = 0;
        for (const WrongUse& other : list_)
            same += other.name == name || other.name.starts_with(name + "_again");
        if (same > 0)
            name += "_again" + std::to_string(same);
        list_.push_back({std::move(name), std::move(use)});
    }
    template <class Object>
    void add(std::string name, std::function<void(Object&)> use) {
        add(std::move(name), std::function([use] {
                Object object;
                use(object);
            }));
    }
    template <class Value>
    void add(std::string name, std::function<void(Value)> use, Value value) {
        add(std::move(name), std::function([=] { use(value); }));
    }
    template <class Object, class Value>
    void add(std::string name, std::function<void(Object&, Value)> use, Value value) {
        add(std::move(name), std::function([=](Object& object) { use(object, value); }));
    }
    std::vector<WrongUse> list_;
};

/// Keeps the compiler from discarding a returned value.
template <class T>
void keep(const T& value) {
    asm volatile("" : : "r"(&value) : "memory");
}

/// Returns indices that are out of range for a size.
inline std::vector<std::pair<std::string, std::size_t>> wrong_indices(std::size_t size) {
    return {{"size", size}, {"size_plus_1", size + 1}, {"huge", huge}};
}
/// Returns wrong lengths for spans of a given length.
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
/// Returns values that are not positive numbers.
inline std::vector<std::pair<std::string, double>> not_positive() {
    return {{"zero", 0}, {"negative", -1}, {"nan", not_a_number}, {"infinite", infinity}};
}
/// Returns values that are not nonnegative numbers.
inline std::vector<std::pair<std::string, double>> negative() {
    return {{"negative", -1}, {"nan", not_a_number}, {"infinite", infinity}};
}

/// Expects that a wrong use is refused with a message of the library, not accepted and not refused by an exception of
/// the standard library, which would name nothing. Accepted uses must not be refused.
inline void expect_refusal(const WrongUse& wrong) {
    if (is_among(accepted, wrong.name)) {
        EXPECT_NO_THROW(wrong.use()) << "ACCEPTED " << wrong.name << ": take it out of the list";
        return;
    }
    try {
        wrong.use();
    } catch (const std::exception& refusal) {
        const std::string what = refusal.what();
        ::testing::Test::RecordProperty("type", typeid(refusal).name());
        ::testing::Test::RecordProperty("what", what);
        const Error* const error = dynamic_cast<const Error*>(&refusal);
        EXPECT_TRUE(error && error->kind() != ErrorKind::internal)
            << "FOREIGN " << wrong.name << ": " << typeid(refusal).name() << ": " << what;
        EXPECT_TRUE(!is_among(out_of_order, wrong.name) || (error && error->kind() == ErrorKind::order))
            << wrong.name << ": " << what;
        EXPECT_FALSE(what.empty());
        for (const std::string foreign : {"vector::", "basic_string", "bad_", "map::at", "array::at", "_M_", "std::"})
            EXPECT_EQ(what.find(foreign), std::string::npos) << "FOREIGN " << wrong.name << ": " << what;
        return;
    }
    ADD_FAILURE() << "SILENT " << wrong.name << ": no exception";
}

/// Visits all uses, or only those whose names begin with the environment variable WRONG_USE, to isolate one that
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

/// Expects that all uses that some functions add are refused.
inline void expect_refusals(const std::vector<void (*)(WrongUses&)>& functions) {
    WrongUses wrong;
    for (const auto add : functions)
        add(wrong);
    each_of(wrong.list(), expect_refusal);
}

} // namespace graze::testing
