#pragma once

#include "graze/flow/system.hpp"
#include "graze/tape/jet.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// How strongly the rates of a mode's states depend on the states, somewhere: the sizes of the Jacobian's entries, and
/// what follows from them whatever units states are counted in.
///
/// What one state's errors do to the others tells how accurate these need be. Within the response time no disturbance
/// outgrows itself by way of others, so that the sizes to which a disturbance can bring all states are well defined.
class Couplings {
public:
    /// Which couplings there are. @throws InputError, here and below, for a mode or numbers that do not fit the system
    Couplings(const System& system, std::size_t mode);
    /// @param parameters as many as the system has
    void set_parameters(std::span<const double> parameters);
    /// Finds the Jacobian at a place, from the coefficients of the first variational equations.
    void measure(std::span<const double> states);

    /// The reciprocal of a bound on the eigenvalues: of the largest sum of a row's entries among states that depend on
    /// each other, in units in which rows and columns are about as large (Osborne 1960). Infinity where no state
    /// depends on itself, 0 where the Jacobian is not finite.
    double response_time() const { return response_time_; }

    /// Units of the states in which rows and columns of the Jacobian are about as large.
    std::span<const double> units() const { return units_; }

    /// Raises sizes of states until no coupling, over a time, makes any larger: s_i >= time |J_ij| s_j for all i, j.
    /// @param time at most the response time
    /// @param sizes [state * width + lane]
    /// @param through all couplings, or those alone that are the same at all places
    enum class Through { all, constant };
    void spread(double time, std::span<double> sizes, std::size_t width, Through through = Through::all) const;
    /// Whether something acts on a state through a coupling that is the same at all places, and its rate is a
    /// polynomial of low degree in the states: nothing that is small may become large within a small part of a step.
    bool is_pushed_steadily(std::size_t state) const { return steady_[state]; }
    /// Whether that is so of any state.
    bool push_steadily() const { return std::find(steady_.begin(), steady_.end(), true) != steady_.end(); }

private:
    struct Entry {
        std::size_t row, column;
        double strength = 0;
        bool returns = false;  ///< whether its row's state acts on its column's again
        bool constant = false; ///< of a state whose rate is a polynomial of low degree
    };

    /// What one state does to another, by an entry.
    struct Pull {
        std::size_t to, from, entry;
    };
    void find_ways();
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
    std::unique_ptr<Jet> jet_;                      ///< of the first variational equations, once something is measured
    std::vector<Entry> entries_;                    ///< row by row
    std::vector<std::size_t> row_starts_;           ///< in `entries_`
    std::vector<std::vector<std::size_t>> columns_; ///< entries of each
    std::vector<Pull> ways_[2];                     ///< all pulls, in two sequences: up and down the states
    /// Entries between states that act on each other, sorted by one of the two: `starts` has where those of each begin.
    struct Sorted {
        std::vector<std::size_t> starts, entries, others;
        std::vector<double> strengths;
        void note_strengths(const std::vector<Entry>& all);
    };
    Sorted in_rows_, in_columns_;
    std::vector<bool> steady_;    ///< states
    std::vector<bool> vanishing_; ///< entries that were zero when cycles were found
    std::vector<double> units_;   ///< in which rows and columns are about as large
    std::vector<double> row_;     ///< of the Jacobian, one number for each state
    /// Derivatives of intermediate quantities by states.
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
    /// Those of a mode, measured or not.
    Couplings& of(std::size_t mode);
    /// Those of a mode at a place.
    const Couplings& measured(std::size_t mode, std::span<const double> states);

private:
    System system_;
    std::vector<double> parameters_;
    std::vector<std::unique_ptr<Couplings>> all_;
};

} // namespace graze
