#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A variable of the optimisation, with its range.
struct Dimension {
    std::string name;
    double start = 0; ///< initial value, within the range
    double lowest = -std::numeric_limits<double>::infinity(), highest = std::numeric_limits<double>::infinity();
    /// Unit of changes: distances of designs are measured in it. 0: the width of the range, or the magnitude of the
    /// start if the range is infinite.
    double scale = 0;
};

/// Value of one requirement at one design.
struct WantedValue {
    std::optional<double> value;  ///< empty if the design has no such value
    std::vector<double> gradient; ///< derivatives by each dimension; empty: computed by differences
    std::string problem;          ///< why there is no value, in one line
};

/// A requirement: a value must lie within limits, of which one may be infinite; equal limits require an exact value.
struct Want {
    std::string name;
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
    /// Unit of violations. 0: the magnitude of the larger limit.
    double scale = 0;
    /// Returns the value at a design, given one number for each dimension within its range. Values that are not finite
    /// count as missing.
    std::function<WantedValue(std::span<const double> design)> value{};
    double importance = 1; ///< weight of a violation
    std::string text{};    ///< name in messages, such as "the trip value"; empty: `name`
    std::string limits{};  ///< limits in words, such as "at most 3"; empty: the numbers

    /// Describes it, such as "the trip value (at most 3 is wanted)".
    std::string in_words() const;
    /// Describes its limits, such as "at most 3 is wanted".
    std::string limits_in_words() const;
};

/// An optimisation problem: variables and requirements.
struct WishList {
    std::vector<Dimension> dimensions;
    std::vector<Want> wants;
    /// @throws InputError naming the dimension or requirement that is invalid
    void validate() const;
};

/// Options of `design_for`.
struct WishOptions {
    double tolerance = 1e-9;        ///< a requirement with at most this violation (in its scale) is met
    std::size_t evaluations = 4000; ///< largest number of evaluated designs, including those of differences
    /// Number of starting points: the given start, and others all over the ranges; more make a local minimum less
    /// likely.
    std::size_t starts = 8;
    double difference = 3e-5; ///< step of finite differences, in scales of the dimension
    std::function<bool()> interrupted;
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// How a search ended.
enum class WishOutcome {
    met,         ///< all requirements are met
    unmet,       ///< no design was found that meets all; the result is the closest to it
    unfinished,  ///< the limit of evaluations was reached first; the result is the best design so far
    interrupted, ///< the caller ended the search; the result is the best design so far
    nowhere,     ///< no design was found for which all values exist
};
/// Stable name for tables and files, such as "met".
std::string_view name_of(WishOutcome outcome);

/// A dimension of the result.
struct FoundDimension {
    double value = 0;
    bool at_lowest = false, at_highest = false;
    bool binds = false; ///< active: a wider range would give a better design
    double weight = 0;  ///< multiplier: improvement per scale of width, see FoundDesign
};

/// A requirement at the result.
struct FoundWant {
    std::optional<double> value;
    double violation = 0; ///< violation in scales; 0 within its limits
    bool met = false;
    bool binds = false; ///< active: a looser limit would give a better design
    double weight = 0;  ///< multiplier: improvement per scale of the limit, see FoundDesign
};

/// Returns the status of a requirement with this value (empty: no such value). `binds` and `weight` are unknown.
FoundWant found_want(const Want& want, std::optional<double> value, double tolerance = WishOptions().tolerance);

/// Describes a status: "met", or "not met: at most 3 is wanted, 5 percent off".
std::string words_of(const Want& want, const FoundWant& found);

/// Result of `design_for`. Weights are Lagrange multipliers: to first order, the decrease of `distance` (if all
/// requirements are met) or of the largest violation (if not) when a limit is moved by one scale. Only active limits
/// have a weight; equivalent requirements share it.
struct FoundDesign {
    WishOutcome outcome = WishOutcome::nowhere;
    std::string reason; ///< why requirements are not met, in one line; empty if all are met
    std::vector<FoundDimension> dimensions;
    std::vector<FoundWant> wants;
    double distance = 0;         ///< distance from the start, in scales (Euclidean norm)
    double violation = 0;        ///< largest violation
    bool stationary = false;     ///< the multipliers show that no small change gives a better design
    std::size_t evaluations = 0; ///< number of evaluated designs
    std::size_t missing = 0;     ///< number of these without all values
    std::string problem;         ///< reason of the last of these
};

/// Finds the design that meets all requirements and is closest to the start. If none does, it minimises the largest
/// violation, then the next largest, and so on (lexicographic), so that every requirement that can be met is met.
///
/// The distance is minimised together with an exact penalty: one elastic variable by which all limits are relaxed (R.
/// Fletcher, "Practical Methods of Optimization", 1987, chapter 14), by sequential quadratic programming on scaled
/// variables (D. Kraft, "A software package for sequential quadratic programming", DFVLR-FB 88-28, 1988, in NLopt's
/// version). Next to designs without values it continues in shrinking trust regions. The search is local, from several
/// deterministic starting points: `unmet` is not a proof that no design exists.
/// @throws InputError for invalid lists and options, and gradients of the wrong size; exceptions of callbacks
FoundDesign design_for(const WishList& wishes, const WishOptions& options = {});

} // namespace graze
