#include "flow/table_steps.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/require.hpp"
#include "graze/symbolic/piece_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// A knot is passed by this many units of round-off of the argument, or of the narrower piece beside it.
constexpr double units_passed = 8;

/// Returns the width of the narrower of the two pieces that meet at a knot.
double spacing_at(const PieceTable& table, double knot) {
    const PieceTable::Piece below = table.piece_at(std::nextafter(knot, -std::numeric_limits<double>::infinity())),
                            above = table.piece_at(knot);
    return std::min(below.to - below.from, above.to - above.from);
}

} // namespace

TableSteps::TableSteps(const System& system, int order)
    : system_(system), finder_(order), inputs_(system.states() + system.parameters()), errors_(inputs_.size()),
      argument_(static_cast<std::size_t>(order) + 1), distance_(argument_.size()) {}

std::unique_ptr<TableSteps> TableSteps::of(const System& system, int order) {
    for (std::size_t mode = 0; mode < system.model().modes.size(); ++mode)
        if (!system.mode(mode).tables.empty())
            return std::make_unique<TableSteps>(system, order);
    return nullptr;
}

void TableSteps::set_parameters(std::span<const double> parameters) {
    require_size(parameters.size(), system_.parameters(), "independent parameters");
    std::ranges::copy(parameters, inputs_.begin() + static_cast<std::ptrdiff_t>(system_.states()));
}

double TableSteps::limit(std::size_t mode, std::span<const Series> series, double length) {
    const auto& compiled = system_.mode(mode);
    crosses_ = false;
    const std::size_t count = compiled.tables.size();
    if (count == 0 || !std::isfinite(length) || length == 0)
        return length;
    for (std::size_t i = 0; i < system_.states(); ++i) {
        inputs_[i] = series[i][0];
        errors_[i] = epsilon * std::abs(inputs_[i]);
    }
    bounds_.resize(count);
    work_.resize(2 * compiled.table_arguments.workspace());
    compiled.table_arguments.error_bounds(inputs_, errors_, bounds_, work_);
    const double sign = length < 0 ? -1 : 1;
    double reach = std::abs(length);
    for (std::size_t a = 0; a < count; ++a) {
        const Series& argument = series[series.size() - count + a];
        double power = 1, size = 0;
        for (std::size_t k = 0; k < argument_.size(); ++k, power *= sign)
            argument_[k] = power * argument[k];
        for (std::size_t k = argument_.size(); k-- > 0;)
            size = size * reach + std::abs(argument_[k]);
        const PieceTable& table = *compiled.tables[a];
        const PieceTable::Piece piece = table.piece_at(argument_[0]);
        for (const double end : {piece.from, piece.to}) {
            if (!std::isfinite(end) || !std::isfinite(size))
                continue;
            const double way = end == piece.from ? 1 : -1;
            for (std::size_t k = 0; k < argument_.size(); ++k)
                distance_[k] = way * (k == 0 ? argument_[0] - end : argument_[k]);
            // Beside a knot at zero, the argument's own size would vanish with the distance.
            const double scale = std::abs(argument_[0]) + std::abs(end) + spacing_at(table, end);
            const double margin = units_passed * (bounds_[a] + epsilon * scale);
            if (table.is_last(end) && distance_[0] < -0.5 * margin && falls_at_once())
                return std::numeric_limits<double>::quiet_NaN();
            reach = time_to_end(margin, reach, table.is_smooth());
        }
    }
    return sign * reach;
}

/// Whether a distance decreases at the beginning of the step.
bool TableSteps::falls_at_once() const {
    const auto changes = std::span(distance_).subspan(1);
    const auto first = std::ranges::find_if(changes, [](double c) { return c != 0; });
    return first != changes.end() && *first < 0;
}

double TableSteps::time_to_fall(double below, double reach) {
    const double first = distance_[0];
    distance_[0] -= below;
    Root found{};
    const bool falls = finder_.first_falling(distance_, reach, RootStart::as_is, found);
    distance_[0] = first;
    return falls ? found.at : reach;
}

/// Where slopes jump, a step ends just before the knot, since derivatives at its end are compared with the table's; the
/// next one, of the size of round-off, passes it.
double TableSteps::time_to_end(double margin, double reach, bool smooth) {
    if (smooth || distance_[0] > 2 * margin) {
        const double time = time_to_fall(smooth ? -margin : margin, reach);
        crosses_ = crosses_ && time == reach;
        return time;
    }
    const double before = time_to_fall(margin, reach), beyond = time_to_fall(-margin, reach);
    if (beyond == reach)
        return reach;
    // The motion may first leave the neighbourhood of the knot, and return to it.
    crosses_ = !(before < beyond && evaluate_polynomial(distance_, 0.5 * before) > 2 * margin);
    return crosses_ ? beyond : before;
}

} // namespace graze
