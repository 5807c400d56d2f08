#include "model/model_drawing.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_expressions.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>

namespace graze {

namespace {

/// Visits the texts of all expressions of a shape, each with its path below that of the shape.
void visit_texts(const DrawnShape& shape, const std::function<void(const char*, const std::string&)>& visit) {
    const char* const first = has_ends(shape.kind) ? "from" : shape.kind == ShapeKind::path ? "points" : "at";
    for (std::size_t i = 0; i < shape.points.size(); ++i)
        for (const std::string* text : {&shape.points[i].x, &shape.points[i].y})
            visit(has_ends(shape.kind) && i == 1 ? "to" : first, *text);
    if (shape.kind == ShapeKind::box) {
        visit("size", shape.size.x);
        visit("size", shape.size.y);
    }
    if (shape.kind == ShapeKind::circle)
        visit("radius", shape.radius);
}

bool are_limits(double low, double high) {
    return low < high && std::isfinite(high - low);
}

std::string path_of_shape(std::size_t index) {
    return fmt::format("drawing.shapes.{}", index + 1);
}

/// Checks step by step; each check throws at the first mistake.
class DrawingValidator {
public:
    DrawingValidator(const Model& model, const Places& places)
        : model_(model), drawing_(*model.drawing), places_(places), scope_(scope_of(model, *graph_)) {}

    void run() const {
        check_limits("drawing.x", drawing_.x);
        check_limits("drawing.y", drawing_.y);
        if (drawing_.shapes.empty())
            fail("drawing", "the drawing has no shapes", "add shapes = [{ kind = \"circle\", ... }], or leave it out");
        if (drawing_.shapes.size() > most_shapes)
            fail("drawing.shapes", fmt::format("the drawing has {} shapes", drawing_.shapes.size()),
                 fmt::format("draw at most {}", most_shapes));
        for (std::size_t i = 0; i < drawing_.shapes.size(); ++i)
            check_shape(drawing_.shapes[i], path_of_shape(i));
    }

private:
    [[noreturn]] void fail(std::string_view path, const std::string& problem, const std::string& remedy) const {
        throw InputError(places_.of(path), problem, remedy);
    }

    Expression parsed(const std::string& path, const std::string& text) const {
        try {
            return parse_expression(*graph_, text, scope_);
        } catch (const InputError& error) { // of a model built from C++: those of files have been read already
            fail(path, fmt::format("{}: {}", path, error.problem()), error.remedy());
        }
    }

    /// Checks limits that are constant. Values of others depend on parameters that may change later: see scene_limits.
    void check_limits(const std::string& path, const std::array<std::string, 2>& limits) const {
        std::vector<double> numbers;
        for (std::size_t i = 0; i < 2; ++i) {
            const std::string of_limit = fmt::format("{}.{}", path, i + 1);
            const std::vector<Expression> limit{parsed(of_limit, limits[i])}, symbols = symbols_of(limit);
            for (const Expression& symbol : symbols)
                if (!model_.find_parameter(symbol.name()))
                    throw InputError(places_.of_name(of_limit, symbol.name()),
                                     fmt::format("{} uses '{}', which is no parameter", path, symbol.name()),
                                     "write the limits of the scene in numbers and parameters: the scene stands still");
            if (!symbols.empty())
                continue;
            numbers.push_back(model_.values_of(limit).front());
            if (!std::isfinite(numbers.back()))
                fail(of_limit, fmt::format("{} is {}", path, numbers.back()), "give a finite number");
        }
        if (numbers.size() == 2 && !are_limits(numbers[0], numbers[1]))
            fail(path, fmt::format("{} goes from {} to {}", path, numbers[0], numbers[1]),
                 "give the lower limit first, then a greater one");
    }

    void check_shape(const DrawnShape& shape, const std::string& path) const {
        if (shape.kind == ShapeKind::path && (shape.points.size() < 2 || shape.points.size() > most_points_of_a_path))
            fail(path + ".points", fmt::format("{} is a path of {} points", path, shape.points.size()),
                 fmt::format("give 2 to {} points", most_points_of_a_path));
        if (const std::size_t needed = has_ends(shape.kind) ? 2 : 1;
            shape.kind != ShapeKind::path && shape.points.size() != needed)
            fail(path, fmt::format("{} is a {} with {} points", path, name_of(shape.kind), shape.points.size()),
                 fmt::format("give {}", needed));
        for (const std::size_t mode : shape.modes)
            if (mode >= model_.modes.size())
                fail(path + ".modes",
                     fmt::format("{} refers to mode {}, but there are {}", path, mode, model_.modes.size()),
                     fmt::format("use an index below {}", model_.modes.size()));
        visit_texts(shape,
                    [&](const char* part, const std::string& text) { parsed(fmt::format("{}.{}", path, part), text); });
    }

    const Model& model_;
    const ModelDrawing& drawing_;
    const Places& places_;
    std::shared_ptr<Graph> graph_ = Graph::create();
    Scope scope_;
};

} // namespace

void validate_drawing(const Model& model, const Places& places) {
    DrawingValidator(model, places).run();
}

std::vector<Expression> drawn_expressions(const Model& model) {
    std::vector<Expression> result;
    if (!model.drawing)
        return result;
    const std::shared_ptr<Graph> graph = Graph::create();
    const Scope scope = scope_of(model, *graph);
    const auto add = [&](const std::string& text) { result.push_back(parse_expression(*graph, text, scope)); };
    for (const auto* limits : {&model.drawing->x, &model.drawing->y})
        for (const std::string& limit : *limits)
            add(limit);
    for (const DrawnShape& shape : model.drawing->shapes)
        visit_texts(shape, [&](const char*, const std::string& text) { add(text); });
    return result;
}

std::optional<SceneLimits> scene_limits(const Model& model) {
    if (!model.drawing)
        return std::nullopt;
    const std::shared_ptr<Graph> graph = Graph::create();
    const Scope scope = scope_of(model, *graph);
    std::vector<Expression> limits;
    for (const auto* both : {&model.drawing->x, &model.drawing->y})
        for (const std::string& limit : *both)
            limits.push_back(parse_expression(*graph, limit, scope));
    const std::vector<double> values = model.values_of(limits);
    if (!are_limits(values[0], values[1]) || !are_limits(values[2], values[3]))
        return std::nullopt;
    return SceneLimits{{values[0], values[1]}, {values[2], values[3]}};
}

} // namespace graze
