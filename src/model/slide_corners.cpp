#include "model/slide_corners.hpp"

#include "graze/symbolic/transform.hpp"
#include "model/model_completion.hpp"
#include "model/vanishing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

namespace {

/// The modes of the four sides: both functions negative; the first positive; the second positive; both.
using Sides = std::array<std::size_t, 4>;

/// Returns the slide along a surface whose second mode is this one.
std::optional<std::size_t> slide_towards(const Model& model, std::size_t surface, std::size_t right) {
    for (std::size_t i = 0; i < model.slides.size(); ++i)
        if (model.slides[i].surface == surface && model.slides[i].right == right)
            return i;
    return std::nullopt;
}

std::optional<SlideCorner> corner_at(const Model& model, std::size_t first, std::size_t second) {
    const Slide &one = model.slides[first], &other = model.slides[second];
    if (one.surface == other.surface || one.right != other.right)
        return std::nullopt;
    const auto one_below = slide_towards(model, one.surface, other.left),
               other_below = slide_towards(model, other.surface, one.left);
    if (!one_below || !other_below || model.slides[*one_below].left != model.slides[*other_below].left)
        return std::nullopt;
    return SlideCorner{.name = fmt::format("{}-{}", one.name, other.name),
                       .surfaces = {{{*one_below, first}, {*other_below, second}}}};
}

Sides sides_of(const Model& model, const SlideCorner& corner) {
    const Slide &below = model.slides[corner.surfaces[0].below], &above = model.slides[corner.surfaces[0].above];
    return {below.left, below.right, above.left, above.right};
}

/// Returns the rates of a mode with the values that controls have in it.
std::vector<Expression> rates_with_controls(const Model& model, std::size_t mode) {
    std::vector<Replacement> controls;
    for (const Slide& slide : model.slides)
        if (slide.convention == SlideConvention::utkin && !slide.control.empty() &&
            (mode == slide.left || mode == slide.right))
            controls.emplace_back(model.symbol(slide.control), model.number(mode == slide.left ? -1 : 1));
    return substitute(model.modes[mode].rates, controls);
}

/// Returns whether the rates are linear in the control of each of the corner's slides that has one.
bool are_linear_in_controls(Model& model, const SlideCorner& corner) {
    for (const CornerSurface& surface : corner.surfaces)
        for (const std::size_t i : {surface.below, surface.above}) {
            const Slide& slide = model.slides[i];
            if (slide.convention != SlideConvention::utkin || slide.control.empty())
                continue;
            const Expression control = model.symbol(slide.control);
            for (const Expression& rate : model.modes[slide.left].rates)
                if (contains_symbol(differentiate(model.expand(rate), control), control))
                    return false;
        }
    return true;
}

bool is_unique(Model& model, const SlideCorner& corner) {
    constexpr int samples = 24, fewest = 4;
    constexpr double round_off = 1e-12;
    if (!are_linear_in_controls(model, corner))
        return false;
    std::vector<Expression> rates;
    for (const std::size_t side : sides_of(model, corner)) {
        const std::vector<Expression> some = rates_with_controls(model, side);
        rates.insert(rates.end(), some.begin(), some.end());
    }
    const std::size_t n = model.states.size();
    if (rates.size() != 4 * n)
        return false; // one of the modes is made by a declaration itself, which `complete_slides` refuses
    try {
        const Function fields = model.function_of(rates);
        RandomInputs random(model);
        int defined = 0;
        for (int sample = 0; sample < samples; ++sample) {
            const std::vector<double> f = fields(random.drawn());
            if (!std::ranges::all_of(f, [](double one) { return std::isfinite(one); }))
                continue;
            ++defined;
            for (std::size_t i = 0; i < n; ++i) {
                const double none = f[i], first = f[n + i], second = f[2 * n + i], both = f[3 * n + i];
                const double size = std::abs(none) + std::abs(first) + std::abs(second) + std::abs(both);
                if (!(std::abs((both - first) - (second - none)) <= round_off * size))
                    return false;
            }
        }
        return defined >= fewest;
    } catch (const InputError&) {
        return false; // `validate` tells what is wrong
    }
}

} // namespace

std::vector<SlideCorner> corners_of(Model& model) {
    std::vector<SlideCorner> corners;
    for (std::size_t first = 0; first < model.slides.size(); ++first)
        for (std::size_t second = first + 1; second < model.slides.size(); ++second)
            if (auto corner = corner_at(model, first, second); corner && is_unique(model, *corner))
                corners.push_back(std::move(*corner));
    return corners;
}

} // namespace graze
