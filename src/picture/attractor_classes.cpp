#include "picture/attractor_classes.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <tuple>

namespace graze {

namespace {

/// Colours of the palette whose tints can be distinguished, in the order of classes.
constexpr std::array<std::size_t, 10> colours_of_periods{0, 3, 2, 4, 1, 8, 10, 6, 5, 9};
constexpr std::size_t colour_of_others = 13;

AttractorClass class_of_label(Label label) {
    const DrawnAs drawn = drawn_as(name_of(label));
    // A motion that has not settled looks the same whether it is known to be on its way or not.
    const Label shown = drawn == DrawnAs::uncertain ? Label::unsettled : label;
    const std::string name(name_of(shown));
    switch (label) {
    case Label::chaotic:
        return {name, 7};
    case Label::quasi_periodic:
        return {name, 11};
    case Label::equilibrium:
        return {name, 15};
    default:
        const FigureSeries look = series_of_label(name);
        return {name, look.colour, drawn, look.symbol, look.hatch};
    }
}

/// Periodic motions first, and of these the simple ones.
auto order_of(const AtlasMotion& motion) {
    return std::tuple(motion.label, motion.accumulates, motion.period, motion.contacts);
}

/// What some of the motions do.
struct Kind {
    const AtlasMotion* motion; ///< one of them
    std::string name;
    std::size_t count = 0;
};

} // namespace

AttractorClasses::AttractorClasses(const std::vector<AtlasMotion>& motions, const std::vector<AtlasMotion>& others) {
    std::vector<Kind> kinds;
    const auto add = [&](const AtlasMotion& motion, std::size_t count) {
        const std::string name = motion.attractor();
        auto found = std::ranges::find(kinds, name, &Kind::name);
        if (found == kinds.end())
            found = kinds.insert(found, {&motion, name});
        found->count += count;
    };
    for (const AtlasMotion& motion : motions)
        add(motion, 1);
    for (const AtlasMotion& motion : others)
        add(motion, 0);
    std::ranges::sort(kinds, {}, [](const Kind& kind) { return order_of(*kind.motion); });
    std::vector<const Kind*> frequent;
    for (const Kind& kind : kinds)
        if (kind.motion->label == Label::periodic)
            frequent.push_back(&kind);
    std::ranges::stable_sort(frequent, std::greater{}, [](const Kind* kind) { return kind->count; });
    if (frequent.size() > colours_of_periods.size())
        frequent.resize(colours_of_periods.size());
    // Classes are in the order of `kinds`; periodic ones come first, and behind them those that have no class.
    std::vector<const Kind*> rest;
    for (const Kind& kind : kinds)
        if (std::ranges::find(frequent, &kind) != frequent.end()) {
            indices_[kind.name] = classes_.size();
            classes_.push_back({kind.name, colours_of_periods[classes_.size()]});
        } else {
            rest.push_back(&kind);
        }
    for (const Kind* kind : rest) {
        const Label label = kind->motion->label;
        const AttractorClass one =
            label == Label::periodic ? AttractorClass{"other periods", colour_of_others} : class_of_label(label);
        const auto known = std::ranges::find(classes_, one.name, &AttractorClass::name);
        indices_[kind->name] = static_cast<std::size_t>(known - classes_.begin());
        if (known == classes_.end())
            classes_.push_back(one);
    }
}

} // namespace graze
