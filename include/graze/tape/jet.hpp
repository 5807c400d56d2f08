#pragma once

#include "graze/tape/series.hpp"
#include "graze/tape/tape.hpp"

#include <memory>
#include <span>
#include <string_view>

namespace graze {

/// Instruction sets for which the kernels are compiled.
enum class InstructionSet { baseline, avx2, avx512 };
/// The widest that this processor has.
InstructionSet best_instruction_set();
bool is_supported(InstructionSet set);
std::string_view name_of(InstructionSet set);

/// What the lanes of a jet are.
enum class LaneKind {
    single,   ///< one trajectory
    ensemble, ///< independent trajectories of one tape, side by side
};

/// Highest order for which kernels exist.
inline constexpr int highest_order = 32;

/// By how much ends of steps may differ from what the model says there.
struct EndAllowance {
    double rates = 0, values = 0; ///< shares of the sizes of states and outputs that differences may come to
    double smallest = 0;          ///< added to sizes
};

/// Computes Taylor coefficients of states and outputs of a tape (Jorba and Zou 2005; Griewank and Walther 2008,
/// chapter 13). Every number is stored `width()` times over: coefficient k of a series, lane l, is at
/// [k * width() + l]. The arithmetic of `single` and of each lane of `ensemble` is the same bit for bit (for one
/// instruction set).
class Jet {
public:
    virtual ~Jet() = default;
    Jet(const Jet&) = delete;
    Jet& operator=(const Jet&) = delete;

    virtual int order() const = 0;
    virtual int width() const = 0;

    /// @param parameters [parameter * width() + lane]
    /// @throws InputError (here and below) when there are fewer numbers than there must be, or no such state or output
    virtual void set_parameters(std::span<const double> parameters) = 0;
    /// Computes coefficients 0 .. order() from states [state * width() + lane].
    virtual void compute(std::span<const double> states) = 0;
    /// Computes only coefficients 0 and 1: cheap evaluation at a point, from which `compute` of the same states goes
    /// on. All other coefficients are left undefined.
    virtual void begin(std::span<const double> states) = 0;

    /// Coefficients of a state or output: (order() + 1) * width() numbers, valid until the next `compute`.
    virtual const double* state(std::size_t index) const = 0;
    virtual const double* output(std::size_t index) const = 0;

    /// Computes the followers of some groups, once all states and outputs have been computed (or, for
    /// `begin_followers`, once coefficients 0 and 1 have been: so many of the followers it finds). Those of group 0 are
    /// among them, and a group may be empty.
    /// @throws OrderError when they have not
    virtual void follow(std::span<const std::uint32_t> groups) = 0;
    virtual void begin_followers(std::span<const std::uint32_t> groups) = 0;
    /// Coefficients of a follower as those of an output are; of one that is a constant, coefficient 0 alone.
    virtual const double* follower(std::size_t index) const = 0;
    virtual std::size_t followers() const = 0;

    /// Lane 0 of all states, then of all outputs; other lanes are that many numbers behind. Valid until the next
    /// `compute`.
    virtual std::span<const Series> series() const = 0;

    /// How far the series of all states and outputs may be followed in each lane: the largest step at which the last
    /// two terms of each, relative to its size, are at most a tolerance (Jorba and Zou 2005), and do not grow, as
    /// `guard_steps` leaves it.
    /// @param log_tolerance to base 2; @param references [lane] lengths over which sizes are taken, such as the last
    /// step
    /// @param steps [lane] infinity where all last two terms are zero, NaN where something is not finite
    virtual void find_steps(double log_tolerance, std::span<const double> references,
                            std::span<double> steps) const = 0;
    /// Shortens steps over which arguments of exponentials, sines and the like change so much, or quotients and roots
    /// come so close to their singularities, that series of this order cannot follow them, even where they are lost
    /// beside what they are added to: far from a narrow peak or a steep slope nothing else shows it.
    /// @param steps [lane] those that are not finite are left as they are
    virtual void guard_steps(std::span<double> steps) const = 0;

    /// Sums the series of all states, in each lane at its own time.
    /// @param times [lane]
    /// @param values [state * width() + lane]
    virtual void evaluate_states(std::span<const double> times, std::span<double> values) const = 0;
    /// The same, and their derivatives with respect to time there. @param slopes [state * width() + lane]
    virtual void evaluate_states(std::span<const double> times, std::span<double> values,
                                 std::span<double> slopes) const = 0;
    /// Whether ends of steps are what the model says: by how much differences exceed what is allowed, the worst of all
    /// states and outputs; at most 0 where none does, infinity where something is not finite.
    /// @param end jet of the same tape and order, begun at the ends; @param lengths [lane]
    /// @param values, slopes of the states there, as from `evaluate_states`; @param worst [lane]
    /// @throws InputError for a jet of another tape
    virtual void find_disagreement(const Jet& end, const EndAllowance& allowance, std::span<const double> lengths,
                                   std::span<const double> values, std::span<const double> slopes,
                                   std::span<double> worst) const = 0;
    /// Sums the series of one output, in each lane at its own time. @param values [lane]
    virtual void evaluate_output(std::size_t index, std::span<const double> times, std::span<double> values) const = 0;
    /// Bounds the first outputs from below on [0, lengths[lane]] by their partial sums at the end, of which they are
    /// convex combinations throughout, less their round-off; -infinity if they are not finite.
    /// @param least [output * width() + lane], of as many outputs as it has room for; @param sizes of the series, as
    /// many: sum |c_k| length^k
    virtual void bound_outputs(std::span<const double> lengths, std::span<double> least,
                               std::span<double> sizes) const = 0;

protected:
    Jet() = default;
};

/// Lanes of a jet.
int lanes_of(LaneKind kind, InstructionSet set);

/// The tape is not needed afterwards. Nothing is allocated while computing. Without parameters set, they are 0.
/// @param order 1 .. highest_order
/// @throws InputError when the instruction set is not supported or the order out of range
std::unique_ptr<Jet> make_jet(const Tape& tape, int order, LaneKind kind, InstructionSet set = best_instruction_set());

} // namespace graze
