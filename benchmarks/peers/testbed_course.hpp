#pragma once

#include "../testbed.hpp"
#include "hybrid_case.hpp"
#include "reference.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace peers {

/// The motion of the vibro-impactor that graze and heyoka follow: on the period-3 orbit, from a phase where neither
/// section nor impact is near. Numbers are nondimensional, as those of OdeintPeer.
class Course {
public:
    using State = OdeintPeer::State;

    explicit Course(int periods);

    State nondimensional(std::span<const double> state) const;
    double duration() const { return one.duration / one.time_unit; }
    /// The same, exactly as graze and heyoka run: the rounding of their end times is no error of theirs.
    Reference::Real duration_of_graze() const;
    Reference::Real duration_of_heyoka() const;
    /// Starts the reference at the orbit's voltage, or at that of other equations of motion.
    Reference reference(const Motions& motions) const;
    Reference reference() const { return reference(one.motions); }

    Testbed testbed;
    OdeintPeer::Parameters groups = testbed.groups();
    HybridCase one;
    State start;
    double phase; ///< at the start
    /// Inputs of derivatives, in the order of HeyokaPeer, and their units.
    std::vector<std::string> inputs = {"q", "v", "I", "theta", "V0", "zeta", "R", "Ll"};
    std::vector<double> input_units;
};

/// What the reference finds along a course.
struct Truth {
    Truth(const Course& course, Reference::Real duration);

    std::vector<Course::State> sections; ///< where the voltage passes zero
    Course::State end;
    std::vector<Course::State> columns; ///< derivatives at the end, by the first inputs
    std::size_t impacts = 0;
};

Course::State state_of(const Reference& reference);
double largest_difference(const Course::State& a, const Course::State& b);

} // namespace peers
