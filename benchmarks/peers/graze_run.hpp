#pragma once

#include "heyoka_peer.hpp"
#include "testbed_course.hpp"

#include "graze/trajectory/ensemble.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace peers {

/// What graze tells during a run: the same as HeyokaPeer.
struct Told : graze::Observer {
    void contact(const graze::Contact& contact) override;
    void passage(const graze::Passage& passage) override;

    std::size_t impacts = 0;
    std::vector<Course::State> passages; ///< in units of the model
};

/// Runs of graze along a course, with the interface of HeyokaPeer.
class GrazeRun {
public:
    /// @param course must outlive this
    /// @param directions number of inputs by which derivatives are taken
    GrazeRun(const Course& course, double tolerance, HeyokaOutput output, std::size_t directions = 0);
    GrazeRun(const GrazeRun&) = delete;
    GrazeRun& operator=(const GrazeRun&) = delete;

    void run();

    Course::State state() const { return course_->nondimensional(trajectory_.state()); }
    double derivative(std::size_t state, std::size_t direction) const;
    std::size_t steps() const { return trajectory_.steps(); }
    std::size_t impacts() const { return told_.impacts; }
    std::vector<Course::State> passages() const;

private:
    const Course* course_;
    graze::Simulation simulation_;
    graze::JetSet jets_;
    Told told_;
    graze::Trajectory trajectory_;
    std::vector<std::string> inputs_;
};

/// The same for many voltages by graze's Ensemble.
class GrazeGroup {
public:
    /// @param voltages nondimensional
    GrazeGroup(const Course& course, std::span<const double> voltages, double tolerance);
    GrazeGroup(const GrazeGroup&) = delete;
    GrazeGroup& operator=(const GrazeGroup&) = delete;

    void run();

    Course::State state(std::size_t i) const { return course_->nondimensional(trajectories_[i].state()); }
    std::size_t impacts() const; ///< of all together

private:
    const Course* course_;
    graze::Simulation simulation_;
    graze::Ensemble ensemble_;
    std::vector<Told> told_;
    std::vector<graze::Trajectory> trajectories_;
};

} // namespace peers
