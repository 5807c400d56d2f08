#pragma once

#include "graze/flow/system.hpp"
#include "graze/tape/jet.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// The couplings between the states of a mode at one point of state space: the sizes of the Jacobian's entries, and
/// quantities derived from them that do not depend on the units of the states.
///
/// They determine how accurate a state must be, given the effect of its errors on other states. Within the response
/// time no disturbance grows beyond itself through other states, so that the sizes to which a disturbance can bring all
/// states are well defined.
class Couplings {
public:
    /// Finds which couplings exist. @throws InputError, here and below, for a mode or numbers that do not match the
    /// system
    Couplings(const System& system, std::size_t mode);
    /// @param parameters one for each parameter of the system
    void set_parameters(std::span<const double> parameters);
    /// Computes the Jacobian at a point from the coefficients of the first variational equations.
    void measure(std::span<const double> states);

    /// Returns the reciprocal of a bound on the eigenvalues: the largest row sum over states that depend on each other,
    /// in units in which rows and columns are about equally large (Osborne 1960). Infinity where no state depends on
    /// itself, 0 where the Jacobian is not finite.
    double response_time() const { return response_time_; }

    /// Returns the units of the states in which rows and columns of the Jacobian are about equally large.
    std::span<const double> units() const { return units_; }

    /// Raises sizes of states until they are consistent with the couplings over a time: s_i >= time |J_ij| s_j for all
    /// i, j.
    /// @param time at most the response time
    /// @param sizes [state * width + lane]
    /// @param through all couplings, or only those that are constant in state space
    enum class Through { all, constant };
    void spread(double time, std::span<double> sizes, std::size_t width, Through through = Through::all) const;
    /// True if another state acts on this one through a coupling that is constant in state space, and its rate is a
    /// polynomial of low degree in the states: then no small term can become large within a small part of a step.
    bool has_constant_drive(std::size_t state) const { return steady_[state]; }
    /// True if any state has a constant drive.
    bool any_constant_drive() const { return std::find(steady_.begin(), steady_.end(), true) != steady_.end(); }

private:
    struct Entry {
        std::size_t row, column;
        double strength = 0;
        bool returns = false;  ///< the row's state acts on the column's state, directly or not (they form a cycle)
        bool constant = false; ///< constant in state space, and the row's rate is a polynomial of low degree
    };

    /// The effect of state `from` on state `to`.
    struct Coupling {
        std::size_t to, from, entry;
    };
    void order_sweeps();
    void find_entries(const Tape& tape);
    void find_constants(const Tape& tape);
    void find_strengths();
    Jet& jet();
    void find_cycles();
    void sort_cycles();
    void balance();
    double largest_row() const;

    std::size_t states_;
    System system_;
    std::size_t mode_;
    std::vector<double> parameters_;
    std::unique_ptr<Jet> jet_;            ///< jet of the first variational equations, made by the first `measure`
    std::vector<Entry> entries_;          ///< row by row
    std::vector<std::size_t> row_starts_; ///< in `entries_`
    std::vector<std::vector<std::size_t>> columns_; ///< entries of each column
    std::vector<Coupling> sweeps_[2];               ///< all couplings in two orders: by rising and by falling state
    /// Entries between states that act on each other, sorted by row or by column: `starts` has the beginning of each.
    struct Sorted {
        std::vector<std::size_t> starts, entries, others;
        std::vector<double> strengths;
        void note_strengths(const std::vector<Entry>& all);
    };
    Sorted in_rows_, in_columns_;
    std::vector<bool> steady_;    ///< has_constant_drive of each state
    std::vector<bool> vanishing_; ///< entries that were zero when cycles were found
    std::vector<double> units_;   ///< units in which rows and columns are about equally large
    std::vector<double> row_;     ///< a row of the Jacobian
    /// Derivatives of intermediate quantities with respect to states.
    struct Part {
        std::size_t column;
        double value;
    };
    std::vector<std::vector<Part>> intermediates_;
    double response_time_ = 0;
    bool fresh_ = true;
};

/// Couplings for the modes of a system, made when first needed.
class ModeCouplings {
public:
    explicit ModeCouplings(const System& system) : system_(system), all_(system.model().modes.size()) {}
    void set_parameters(std::span<const double> parameters);
    /// Returns the couplings of a mode, measured or not.
    Couplings& of(std::size_t mode);
    /// Returns the couplings of a mode measured at a point.
    const Couplings& measured(std::size_t mode, std::span<const double> states);

private:
    System system_;
    std::vector<double> parameters_;
    std::vector<std::unique_ptr<Couplings>> all_;
};

} // namespace graze
