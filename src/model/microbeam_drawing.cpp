#include "model/microbeam_drawing.hpp"

#include "graze/symbolic/expression.hpp"
#include "model/written_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

constexpr double enlarged = 5; ///< deflections, against the length of the beam
constexpr int pieces = 20;     ///< of the beam's shape

/// Indices of the modes of a microbeam in which its stop is clear and in contact, and its voltage on and off.
struct MicrobeamModes {
    std::vector<std::size_t> free, contact, on, off;
};

} // namespace

ModelDrawing microbeam_drawing(const MicrobeamOptions& options, const std::function<double(int, double)>& shape) {
    const std::shared_ptr<Graph> graph = Graph::create();
    const auto text_of = [](const Expression& expression) { return written_text(expression); };
    const auto number = [&](double value) { return text_of(graph->number(value)); };
    const auto deflection = [&](double place) {
        Expression sum = graph->number(0);
        for (int i = 1; i <= options.modes; ++i)
            if (const double there = enlarged * shape(i, place); there != 0) {
                const Expression term = there * graph->symbol(fmt::format("q{}", i));
                sum = sum.is_number(0) ? term : sum + term;
            }
        return text_of(sum);
    };
    const auto modes =
        options.steady ? MicrobeamModes{{0}, {1}, {0, 1}, {}} : MicrobeamModes{{0, 1}, {2, 3}, {0, 2}, {1, 3}};
    const double height = enlarged * options.gap, ground = -1.25 * height;
    const std::string electrode = text_of(enlarged * graph->symbol("g0")),
                      stop = text_of(enlarged * graph->symbol("d")), at = number(options.stop_position),
                      base = options.stop_distance > 0 ? electrode : number(ground);

    ModelDrawing drawing;
    drawing.text = fmt::format("a clamped beam between an electrode above, which is red while the voltage is on, and a "
                               "compliant stop; deflections are {} times too large",
                               enlarged);
    drawing.x = {number(-0.1), number(1.1)};
    drawing.y = {number(1.5 * ground), number(-1.5 * ground)};
    const auto add = [&](DrawnShape one) { drawing.shapes.push_back(std::move(one)); };
    const double clamp = height / 2;
    add({.kind = ShapeKind::wall, .points = {{"0", number(clamp)}, {"0", number(-clamp)}}});
    add({.kind = ShapeKind::wall, .points = {{"1", number(-clamp)}, {"1", number(clamp)}}});
    for (const bool on : {true, false})
        if (on || !modes.off.empty())
            add({.kind = ShapeKind::line,
                 .points = {{number(0.05), electrode}, {number(0.95), electrode}},
                 .colour = on ? ShapeColour::red : ShapeColour::grey,
                 .modes = on ? modes.on : modes.off});
    add({.kind = ShapeKind::spring,
         .points = {{at, base}, {at, stop}},
         .colour = ShapeColour::grey,
         .modes = modes.free});
    add({.kind = ShapeKind::spring,
         .points = {{at, base}, {at, deflection(options.stop_position)}},
         .colour = ShapeColour::green,
         .modes = modes.contact});
    DrawnShape beam{.kind = ShapeKind::path, .colour = ShapeColour::blue};
    for (int k = 0; k <= pieces; ++k) {
        const double place = static_cast<double>(k) / pieces;
        beam.points.push_back({number(place), deflection(place)});
    }
    add(std::move(beam));
    return drawing;
}

} // namespace graze
