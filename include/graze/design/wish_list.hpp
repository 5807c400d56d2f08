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

/// What one may choose of a device.
struct Dimension {
    std::string name;
    double start = 0; ///< within the range
    double lowest = -std::numeric_limits<double>::infinity(), highest = std::numeric_limits<double>::infinity();
    /// The change that counts as one: distances of designs are measured in it. 0: the width of the range, or the size
    /// of the start where that is infinite.
    double scale = 0;
};

/// What one design has of what is wanted.
struct WantedValue {
    std::optional<double> value;  ///< none where the design has no such value
    std::vector<double> gradient; ///< by each dimension; empty: found by differences
    std::string problem;          ///< why there is no value, in one line
};

/// A value that is wanted within limits, of which one may be infinite; equal ones are a value that is to be met.
struct Want {
    std::string name;
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
    /// The departure that counts as one: violations are measured in it. 0: the size of the greater limit.
    double scale = 0;
    /// Asked with one number for each dimension, within their ranges. Numbers that are not finite are taken for none.
    std::function<WantedValue(std::span<const double> design)> value{};
    double importance = 1; ///< how many times a violation counts
    std::string text{};    ///< for messages, as "the trip value"; empty: the name
    std::string limits{};  ///< in words, as "at most 3"; empty: the numbers

    /// "the trip value (at most 3 is wanted)".
    std::string in_words() const;
    /// "at most 3 is wanted".
    std::string limits_in_words() const;
};

struct WishList {
    std::vector<Dimension> dimensions;
    std::vector<Want> wants;
    /// @throws InputError naming the dimension or want that is out of range
    void validate() const;
};

struct WishOptions {
    double tolerance = 1e-9;        ///< violation, in scales, up to which a want is met
    std::size_t evaluations = 4000; ///< designs that are asked for at most, those of differences included
    std::size_t starts = 8;         ///< from which is searched: the first one, and others all over the ranges
    double difference = 3e-5;       ///< step of differences, in scales of the dimension
    std::function<bool()> interrupted;
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

enum class WishOutcome {
    met,         ///< all wants are
    unmet,       ///< no design was found that meets all; this is the closest to it
    unfinished,  ///< the limit of evaluations was reached before it could be told; this is the best of those
    interrupted, ///< the same, by the caller
    nowhere,     ///< no design was found that has all the values
};
/// Stable name for tables and files, such as "met".
std::string_view name_of(WishOutcome outcome);

struct FoundDimension {
    double value = 0;
    bool at_lowest = false, at_highest = false;
    bool binds = false; ///< a wider range would give a better design
    double weight = 0;  ///< by how much, for one scale of width; see FoundDesign
};

struct FoundWant {
    std::optional<double> value;
    double violation = 0; ///< in scales: 0 where it is within its limits
    bool met = false;
    bool binds = false; ///< a looser limit would give a better design
    double weight = 0;  ///< by how much, for one scale of it; see FoundDesign
};

/// What a design has of a want that has this value, none: no such value. Nothing is known of what binds.
FoundWant found_want(const Want& want, std::optional<double> value, double tolerance = WishOptions().tolerance);

/// "met", or "not met: at most 3 is wanted, 5 percent off".
std::string words_of(const Want& want, const FoundWant& found);

/// Weights say, to first order, by how much `distance` falls where all wants are met, and the largest violation
/// where they are not, when a limit is moved by one scale. What binds has a weight; where several wants say the same
/// they share it.
struct FoundDesign {
    WishOutcome outcome = WishOutcome::nowhere;
    std::string reason; ///< in one line; empty where all wants are met
    std::vector<FoundDimension> dimensions;
    std::vector<FoundWant> wants;
    double distance = 0;         ///< from the start, in scales: the root of the sum of squares
    double violation = 0;        ///< the largest one
    bool stationary = false;     ///< shown by its multipliers: no small change gives a better design
    std::size_t evaluations = 0; ///< designs that were asked for
    std::size_t missing = 0;     ///< of those, designs without all values
    std::string problem;         ///< of the last one
};

/// Finds the design that meets all wants and is closest to the start. Where none does, the one whose largest violation
/// is least; of those, one whose next largest is least, and so on, so that what could be met is.
///
/// It minimises the distance and, by an exact penalty, one elastic variable by which all limits give way (R. Fletcher,
/// "Practical Methods of Optimization", 1987, chapter 14), in scales throughout, by sequential quadratic programming
/// (D. Kraft, "A software package for sequential quadratic programming", DFVLR-FB 88-28, 1988, as NLopt has it). Next
/// to designs without values it goes on in smaller and smaller regions. The search is local, from several starts that
/// are the same each time: `unmet` is no proof that no design exists.
/// @throws InputError for lists and options out of range, and a callback's gradient of another size; what callbacks
///         throw
FoundDesign design_for(const WishList& wishes, const WishOptions& options = {});

} // namespace graze
