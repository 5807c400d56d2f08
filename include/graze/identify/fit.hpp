#pragma once

#include "graze/flow/system.hpp"
#include "graze/identify/estimate.hpp"
#include "graze/model/parameter_id.hpp"
#include "graze/symbolic/expression.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// A parameter of the model that is to be found.
struct UnknownParameter {
    ParameterId parameter{};
    double guess = 0;
    double least = -std::numeric_limits<double>::infinity(), greatest = std::numeric_limits<double>::infinity();
};

/// What an instrument tells: gain * value + offset.
struct MeasuredOutput {
    std::string name{};
    Expression value{}; ///< in states and independent parameters, of any graph
    double gain = 1, offset = 0;
    bool gain_unknown = false, offset_unknown = false; ///< then the numbers above are guesses
    double noise = 0;                                  ///< standard deviation of readings; 0: found from what is left
};

/// A record of a motion.
struct FitRecord {
    struct Readings {
        std::size_t output = 0;
        std::vector<double> values{}; ///< one for each time
    };
    std::vector<double> times{}; ///< strictly rising
    std::vector<Readings> readings{};
    /// Parameters that are known for this record alone, such as a voltage that was set.
    std::vector<std::pair<ParameterId, double>> known{};
    std::vector<double> start{}; ///< guess of the state at the first time; empty: the model's initial state
    std::size_t mode = 0;        ///< at the first time
    /// States whose values at the first time are to be found. Others have those of the model's initial state, at the
    /// parameters that are found.
    std::vector<std::size_t> unknown_states{};
};

/// How much a reading counts that is far off (P. J. Huber, Robust Statistics, 1981).
enum class FitLoss {
    squares, ///< as the square of its distance
    huber,   ///< as the distance, beyond 1.345 standard deviations
    cauchy,  ///< as its logarithm, beyond 2.385 standard deviations
};

/// Their names, in the order of FitLoss.
const std::vector<std::string>& names_of_losses();

struct FitProgress {
    int stage = 0, stages = 0;
    int iteration = 0;
    double misfit = 0; ///< root of the mean square of what is left, relative to the ranges of the outputs
};

struct FitSettings {
    double piece = 0; ///< length of pieces; 0: chosen by the number of readings
    FitLoss loss = FitLoss::squares;
    /// A reading so close to a contact of the motion may belong to the other side of it: time; negative: three times
    /// the usual distance of readings.
    double reach = -1;
    int most_iterations = 100; ///< in each stage
    SimulationOptions simulation{.tolerance = 1e-13};
    std::function<bool(const FitProgress&)> progress{}; ///< asked after every iteration: false ends the fit
    std::function<bool()> interrupted{};                ///< asked at every step of a motion: true ends the fit
};

enum class FitEnding {
    converged,    ///< and checked: the sum of squares is stationary, pieces join, and each motion comes to its end
    unfinished,   ///< the limit of iterations was reached
    interrupted,  ///< by the caller
    apart,        ///< pieces do not join: these records are no motion of this model near the guess
    broken,       ///< a motion ends before its record does
    undetermined, ///< converged, but readings do not tell all that is to be found
    misfit,       ///< converged, but what is left is no noise: errors are larger than told, or a contact was missed
};
/// Stable name for tables and files, such as "converged".
std::string_view name_of(FitEnding ending);

struct FittedNumber {
    enum class Kind { parameter, gain, offset, state } kind = Kind::parameter;
    std::string name{}, unit{};
    std::size_t record = 0; ///< of a state at the first time
    std::size_t index = 0;  ///< of parameter, output or state
    Estimate estimate{};    ///< without freedom where readings do not tell it, or a bound does
    bool at_bound = false;
};

/// Numbers that may change together without any change of what was measured.
struct FreeCombination {
    struct Part {
        std::size_t number = 0; ///< in Fit::numbers
        double change = 0;      ///< relative to its value, or its scale where that is 0; the largest is 1
    };
    std::vector<Part> parts{}; ///< the larger ones, by size
    double strength = 0;       ///< singular value of the scaled derivatives, relative to the largest
    std::string text{};        ///< such as "m (+1 %), k (+1 %)"
};

/// Other numbers with which the readings are met as well: the mirror image, say.
struct FitTwin {
    std::vector<std::pair<std::size_t, double>> numbers{}; ///< those that differ, in Fit::numbers, and their values
    std::string text{};                                    ///< such as "a = -0.002, theta(0) = 3.1416"
};

struct FittedOutput {
    std::string name{};
    std::size_t readings = 0;
    double deviation = 0;     ///< standard deviation of what is left, in the unit of the readings
    double share = 0;         ///< part of the readings' variance that is explained
    double chi_square = 0;    ///< by degree of freedom, where the noise was given; 0 otherwise
    double correlation = 0;   ///< of neighbouring residuals
    bool independent = true;  ///< that is no more than chance makes it (four standard deviations)
    std::size_t outliers = 0; ///< readings further off than five standard deviations
    bool unchanging = false;  ///< all its readings are the same, which tells nothing of their noise
};

struct FittedRecord {
    std::vector<std::vector<double>> fitted{}; ///< for each of the record's readings, as they should be
    std::vector<double> start{};               ///< state at the first time
    std::vector<double> joints{};              ///< times at which pieces join
    std::size_t contacts = 0;
    std::size_t misplaced = 0; ///< times at which the other side of a contact was nearer
};

struct Fit {
    FitEnding ending = FitEnding::unfinished;
    std::string detail{};                ///< why it is not converged; empty if it is
    std::vector<FittedNumber> numbers{}; ///< parameters, gains, offsets, states at the beginnings of records
    std::vector<double> correlations{};  ///< of the numbers, row by row; 0 where nothing is known
    std::vector<FreeCombination> free{}; ///< empty if all is determined
    std::vector<FitTwin> twins{};        ///< of a fit that has converged, some of those there may be
    double condition = 0;                ///< ratio of singular values of the derivatives, with columns of length 1
    std::vector<FittedOutput> outputs{};
    std::vector<FittedRecord> records{};
    std::size_t readings = 0, pieces = 0;
    int iterations = 0;
    double freedom = 0;               ///< readings less numbers
    double gap = 0;                   ///< largest jump that is left between pieces, relative to the sizes of the states
    std::vector<double> parameters{}; ///< of the model, all independent ones, with those that were found
};

/// What is to be found, and from what.
struct FitTask {
    std::vector<UnknownParameter> parameters{};
    std::vector<MeasuredOutput> outputs{};
    std::vector<FitRecord> records{};
    std::vector<double> values{}; ///< of all independent parameters; empty: the model's own
};

/// Finds parameters, gains, offsets and initial states by least squares from records of motions with contacts.
///
/// Records are cut into pieces, whose first states are unknowns too (multiple shooting: H. G. Bock, in: Modelling of
/// Chemical Reaction Systems, Springer 1981, p. 102): what is far off at the guess, or diverges in chaotic motion,
/// stays within a piece. That the pieces join is demanded step by step, at last to a hundred-thousandth of what
/// readings may be off. Derivatives are exact, through contacts too. Where the motion's contact and the recorded one
/// are a little apart, readings between are compared with that side of the contact to which they belong: sums of
/// squares stay smooth. Steps are those of Levenberg and Marquardt, within bounds, by Ceres Solver.
///
/// Errors and intervals are those of the linearised problem in which the pieces join, and are taken from the scatter
/// (noise that is given for outputs tells their ratio, and chi square). Of robust losses they are P. J. Huber's.
/// All numbers are scaled by what they do; units make no difference. Ceres may tell its log (glog, whose level is the
/// program's) of steps that fail and are made otherwise.
/// @throws InputError for tasks without meaning: sizes that do not fit, nothing to be found, guesses beyond bounds, too
///         few readings
Fit fit_model(const System& system, const FitTask& task, const FitSettings& settings = {});

} // namespace graze
