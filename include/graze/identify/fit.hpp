#pragma once

#include "graze/flow/system.hpp"
#include "graze/identify/estimate.hpp"
#include "graze/model/parameter_id.hpp"
#include "graze/symbolic/expression.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// A parameter of the model that the fit is to find, with an initial guess and bounds.
struct UnknownParameter {
    ParameterId parameter{};
    double guess = 0;
    double least = -std::numeric_limits<double>::infinity(), greatest = std::numeric_limits<double>::infinity();
};

/// A channel of the instrument: it reads gain * value + offset.
struct MeasuredOutput {
    std::string name{};
    Expression value{}; ///< function of states and independent parameters; may belong to any expression graph
    double gain = 1, offset = 0;
    /// True: it is fitted, and the number above is its initial guess.
    bool gain_unknown = false, offset_unknown = false;
    double noise = 0; ///< standard deviation of a reading; 0: estimated from the residuals
};

/// A measured record of one motion, with what is known about that motion.
struct FitRecord {
    struct Readings {
        std::size_t output = 0;
        std::vector<double> values{}; ///< one reading for each time
    };
    std::vector<double> times{}; ///< strictly increasing
    std::vector<Readings> readings{};
    /// Values of parameters that hold for this record alone, such as a voltage that was set.
    std::vector<std::pair<ParameterId, double>> known{};
    std::vector<double> start{}; ///< initial guess of the state at the first time; empty: the model's initial state
    std::size_t mode = 0;        ///< mode of the model at the first time
    /// Indices of states whose values at the first time are fitted. The other states have the values of the model's
    /// initial state at the fitted parameters.
    std::vector<std::size_t> unknown_states{};
};

/// Loss function: how the weight of a reading depends on its residual (P. J. Huber, Robust Statistics, 1981). Use
/// `huber` or `cauchy` where records contain outliers.
enum class FitLoss {
    squares, ///< least squares: the square of the residual
    huber,   ///< linear beyond 1.345 standard deviations
    cauchy,  ///< logarithmic beyond 2.385 standard deviations
};

/// Names of the losses, in the order of FitLoss.
const std::vector<std::string>& names_of_losses();

/// State of a running fit, passed to FitSettings::progress.
struct FitProgress {
    int stage = 0, stages = 0;
    int iteration = 0;
    double misfit = 0; ///< root mean square of the residuals, relative to the ranges of the outputs
};

/// Options of `fit_model`. The defaults suit most records.
struct FitSettings {
    /// Duration of the pieces into which records are cut (multiple shooting). 0: chosen by the number of readings.
    /// Shorter pieces help where motion is chaotic or the guess is poor; longer ones where readings are few.
    double piece = 0;
    FitLoss loss = FitLoss::squares;
    /// Time around a contact within which a reading may be compared with the motion on the other side of that contact.
    /// Negative: three times the usual distance of readings. Increase it when the guess shifts contacts by more than
    /// that.
    double reach = -1;
    int most_iterations = 100; ///< iterations of the minimiser allowed in each stage
    SimulationOptions simulation{.tolerance = 1e-13};
    std::function<bool(const FitProgress&)> progress{}; ///< called after every iteration; returning false ends the fit
    std::function<bool()> interrupted{}; ///< called at every integration step; returning true ends the fit
};

/// How a fit ended.
enum class FitEnding {
    converged,    ///< checked: the sum of squares is stationary, pieces join, and each motion covers its record
    unfinished,   ///< the limit of iterations was reached
    interrupted,  ///< ended by the caller
    apart,        ///< pieces do not join: no motion of this model near the guess reproduces the records
    broken,       ///< the model's motion ends before its record does
    undetermined, ///< converged, but the readings do not determine all numbers
    /// Converged, but the residuals are not random noise: true errors exceed the stated ones, or a contact was missed.
    misfit,
};
/// Stable name for tables and files, such as "converged".
std::string_view name_of(FitEnding ending);

/// A fitted parameter, gain, offset or initial state, with its estimate.
struct FittedNumber {
    enum class Kind { parameter, gain, offset, state } kind = Kind::parameter;
    std::string name{}, unit{};
    std::size_t record = 0; ///< index of the record (initial states only)
    std::size_t index = 0;  ///< index of the parameter, output or state
    Estimate estimate{};    ///< its freedom is 0 when the readings do not determine it, or when it lies at a bound
    bool at_bound = false;
};

/// A combination of numbers that can change together without changing what was measured.
struct FreeCombination {
    struct Part {
        std::size_t number = 0; ///< index in Fit::numbers
        /// Change relative to the number's value, or to its scale if the value is 0; the largest is 1.
        double change = 0;
    };
    std::vector<Part> parts{}; ///< the parts of noticeable size, largest first
    double strength = 0;       ///< singular value of the scaled derivatives, relative to the largest
    std::string text{};        ///< such as "m (+1 %), k (+1 %)"
};

/// Another set of numbers that fits the readings equally well, such as the mirror image of a symmetric motion.
struct AlternativeSolution {
    /// The numbers that differ (index in Fit::numbers), with their values.
    std::vector<std::pair<std::size_t, double>> numbers{};
    std::string text{}; ///< such as "a = -0.002, theta(0) = 3.1416"
};

/// How well a fit reproduces one output.
struct FittedOutput {
    std::string name{};
    std::size_t readings = 0;
    double deviation = 0;     ///< standard deviation of the residuals, in the unit of the readings
    double share = 0;         ///< fraction of the readings' variance that the model explains (R^2)
    double chi_square = 0;    ///< chi square per degree of freedom if the noise was given; otherwise 0
    double correlation = 0;   ///< correlation of neighbouring residuals
    bool independent = true;  ///< that correlation is within four standard deviations of 0
    std::size_t outliers = 0; ///< readings more than five standard deviations from the fit
    bool unchanging = false;  ///< all its readings are equal, so that their noise is unknown
};

/// The fitted motion of one record.
struct FittedRecord {
    std::vector<std::vector<double>> fitted{}; ///< fitted values, [output of the record][time]
    std::vector<double> start{};               ///< fitted state at the first time
    std::vector<double> joints{};              ///< times at which pieces join (shooting nodes)
    std::size_t contacts = 0;
    std::size_t misplaced = 0; ///< readings compared with the other side of a contact, because it fitted better
};

/// Result of `fit_model`.
struct Fit {
    FitEnding ending = FitEnding::unfinished;
    std::string detail{};                ///< why it has not converged; empty if it has
    std::vector<FittedNumber> numbers{}; ///< parameters, gains, offsets, then initial states of records
    std::vector<double> correlations{};  ///< correlation matrix of the numbers, row by row; 0 where unknown
    std::vector<FreeCombination> free{}; ///< undetermined combinations; empty if everything is determined
    std::vector<AlternativeSolution>
        alternatives{};   ///< other solutions that were found (not necessarily all) if the fit has converged
    double condition = 0; ///< condition number of the derivatives, with columns scaled to length 1
    std::vector<FittedOutput> outputs{};
    std::vector<FittedRecord> records{};
    std::size_t readings = 0, pieces = 0;
    int iterations = 0;
    double freedom = 0;               ///< degrees of freedom: readings less numbers
    double gap = 0;                   ///< largest remaining gap between pieces, relative to the scales of the states
    std::vector<double> parameters{}; ///< all independent parameters of the model, including the fitted ones
};

/// Input of `fit_model`: the unknowns, and the records to find them from.
struct FitTask {
    std::vector<UnknownParameter> parameters{};
    std::vector<MeasuredOutput> outputs{};
    std::vector<FitRecord> records{};
    std::vector<double> values{}; ///< values of all independent parameters; empty: the model's own
};

/// Finds parameters, gains, offsets and initial states by least squares from records of motions with contacts.
///
/// Records are cut into pieces whose initial states are unknowns too (multiple shooting: H. G. Bock, in: Modelling of
/// Chemical Reaction Systems, Springer 1981, p. 102): so neither a poor guess nor the divergence of chaotic motion
/// spreads beyond a piece. The pieces are made to join gradually, in the end to 1e-5 of the readings' noise.
/// Derivatives are exact, through contacts too. When a contact of the motion and the recorded one are slightly apart,
/// the readings between them are compared with the side of the contact that they belong to, which keeps the sum of
/// squares smooth. The steps are Levenberg-Marquardt steps within bounds, by Ceres Solver.
///
/// Standard errors are those of the linearised problem in which the pieces join exactly, scaled by the scatter of the
/// residuals (given noise of outputs sets their relative weights, and chi square). For robust losses they are P. J.
/// Huber's. All numbers are scaled by their effect on the readings, so units make no difference. Ceres may log (by
/// glog, at the level that the program sets) steps that fail and are retried.
/// @throws InputError for an invalid task: inconsistent sizes, no unknowns, guesses outside bounds, too few readings
Fit fit_model(const System& system, const FitTask& task, const FitSettings& settings = {});

} // namespace graze
